#pragma once
#include <cstdint>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/sensing/tone_sums.hpp"

namespace turnpoint::sensing {

/// A tone of a burst while nothing changes.
struct PlannedTone {
  int index = 0;    ///< place in the burst's tone set
  int channel = 0;  ///< output channel
  double frequency_Hz = 0;
  double amplitude = 0;     ///< of full scale
  std::uint64_t phase = 0;  ///< in 2^-64 cycles, at the stretch's origin
  std::uint64_t increment = 0;
};

/// A part of a burst in which frequencies and amplitudes do not change: between the ramps and the changes.
struct Stretch {
  std::int64_t origin_frame = 0;                ///< absolute frame at which the phases are given
  std::int64_t first_frame = 0, end_frame = 0;  ///< absolute frames, the end excluded
  std::vector<PlannedTone> tones;               ///< without those of amplitude 0
};

/// The steady stretches of a burst, as the synthesiser plays it. Changes that are sent while it plays are not
/// known.
std::vector<Stretch> planned_stretches(const drive::PreparedBurst& burst, int rate_Hz);

}  // namespace turnpoint::sensing
