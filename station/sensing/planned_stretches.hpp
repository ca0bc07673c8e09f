#pragma once
#include <cstdint>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/sensing/tone_sums.hpp"

namespace turnpoint::sensing {

/// One tone of a Stretch. (Within a Stretch, no tone begins, ends or changes.)
struct PlannedTone {
  int index = 0;    ///< index in the burst's tone set
  int channel = 0;  ///< output channel on which it is played
  double frequency_Hz = 0;
  double amplitude = 0;     ///< amplitude as a fraction of full scale
  std::uint64_t phase = 0;  ///< phase at origin_frame, in 2^-64 cycles
  std::uint64_t increment = 0;
};

/// A stretch is a part of a burst, between ramps and changes, in which frequencies and amplitudes are
/// constant.
struct Stretch {
  std::int64_t origin_frame = 0;                ///< absolute frame at which the tones have their `phase`
  std::int64_t first_frame = 0, end_frame = 0;  ///< absolute frames: the first, and the one after the last
  std::vector<PlannedTone> tones;               ///< tones of amplitude 0 are left out
};

/// Returns the stretches of a burst as the synthesiser plays it. Changes that are sent while the burst plays
/// are not included.
std::vector<Stretch> planned_stretches(const drive::PreparedBurst& burst, int rate_Hz);

}  // namespace turnpoint::sensing
