#pragma once
#include "station/text/keys.hpp"

namespace turnpoint::rig {

/// All keys of a rig file.
const text::Keys& rig_keys();

}  // namespace turnpoint::rig
