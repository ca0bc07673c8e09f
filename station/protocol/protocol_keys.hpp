#pragma once
#include "station/text/keys.hpp"

namespace turnpoint::protocol {

/// All keys of a protocol file.
const text::Keys& protocol_keys();

}  // namespace turnpoint::protocol
