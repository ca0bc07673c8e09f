#pragma once
#include <algorithm>
#include <optional>

#include "station/session/stage.hpp"

namespace turnpoint::session {

// What both stages do alike with a stream.

inline Onset schedule(drive::Stream& stream, drive::Burst burst, std::int64_t earliest_ns) {
  burst.start_frame = std::max(stream.earliest_frame(), stream.frame_at(earliest_ns));
  stream.schedule(burst);
  return {burst.start_frame, stream.time_of(burst.start_frame)};
}

inline std::optional<ClockFit> fit_of(drive::Stream& stream) {
  const auto fit = stream.clock();
  return ClockFit{fit.ns_per_frame, fit.residual_ns};
}

/// Ramps everything down; when the last ramp is over.
inline std::int64_t ramp_down(drive::Stream& stream, const drive::Ramp& ramp) {
  stream.stop(0, ramp);
  return stream.time_of(stream.earliest_frame() + ramp.frames);
}

/// What the operating system granted, for the record.
std::string describe(const drive::Rights& rights);

}  // namespace turnpoint::session
