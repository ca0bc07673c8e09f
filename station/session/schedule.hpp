#pragma once
#include <algorithm>
#include <optional>

#include "station/session/stage.hpp"

namespace turnpoint::session {

// What both stages do alike with a stream.

/// The burst that was scheduled last, for what is asked of it later.
struct Sounding {
  std::uint32_t burst = 0;
  std::int64_t start_frame = 0, end_frame = 0;
  drive::Ramp ramp;
};

inline Onset schedule(drive::Stream& stream, drive::Burst burst, std::int64_t earliest_ns,
                      Sounding& sounding) {
  burst.start_frame = std::max<std::int64_t>(0, stream.frame_at(earliest_ns));
  const auto [number, start_frame] = stream.schedule_soon(burst);
  sounding = {number, start_frame, start_frame + burst.length_frames, burst.ramp};
  return {start_frame, stream.time_of(start_frame)};
}

inline std::optional<std::int64_t> glide_to(drive::Stream& stream, const Sounding& sounding,
                                            const drive::ToneSet& to, double seconds) {
  const auto frames = static_cast<std::int64_t>(seconds * stream.config().output.rate_Hz);
  const auto at = std::max(stream.earliest_frame(), sounding.start_frame);
  // Towards its end a burst ramps down: nothing new begins there, and after it nothing sounds.
  if (at + frames + sounding.ramp.frames >= sounding.end_frame) return std::nullopt;
  stream.change(sounding.burst, {at - sounding.start_frame, frames, to});
  return at;
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
