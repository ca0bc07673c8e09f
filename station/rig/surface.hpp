#pragma once
#include "station/core/reader.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::rig {

/// Reads the [surface] table with its [surface.taper].
Surface read_surface(const core::Value& table, core::TableReader& file);

}  // namespace turnpoint::rig
