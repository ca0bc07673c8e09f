#pragma once
#include "station/core/keys.hpp"

namespace turnpoint::protocol {

/// All keys of a protocol file.
const core::Keys& protocol_keys();

}  // namespace turnpoint::protocol
