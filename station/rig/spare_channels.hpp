#pragma once
#include "station/core/reader.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::rig {

/// The highest channel that a stream can have.
inline constexpr int kLastChannel = 7;

/// Reads [marker], [noise], [capture] and [sync], which use channels that drive no transducer. Call after the
/// transducers and the output have been read.
void read_spare_channels(core::TableReader& file, Rig& rig);

}  // namespace turnpoint::rig
