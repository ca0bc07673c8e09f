#pragma once
#include "station/rig/rig.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::rig {

/// Reads the [surface] table with its [surface.taper].
Surface read_surface(const text::Value& table, text::TableReader& file);

}  // namespace turnpoint::rig
