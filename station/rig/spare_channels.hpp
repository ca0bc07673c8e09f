#pragma once
#include "station/rig/rig.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::rig {

/// The highest channel that a stream can have.
inline constexpr int kLastChannel = 7;

/// Reads [marker], [noise], [capture] and [sync], which use channels that drive no transducer. Call after the
/// transducers and the output have been read.
void read_spare_channels(text::TableReader& file, Rig& rig);

}  // namespace turnpoint::rig
