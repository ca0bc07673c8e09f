#pragma once
#include "station/core/keys.hpp"

namespace turnpoint::rig {

/// All keys of a rig file.
const core::Keys& rig_keys();

}  // namespace turnpoint::rig
