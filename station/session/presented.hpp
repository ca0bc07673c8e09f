#pragma once
#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "station/session/stage.hpp"

namespace turnpoint::session {

// Functions that the real and the virtual stage share. They use an audio stream (audio::Stream).

/// The burst of one interval of the current trial. It is kept because the drive's reports give only the
/// burst's number, not the interval.
struct Presented {
  std::uint32_t burst = 0;
  std::int64_t start_frame = 0, end_frame = 0;
  audio::Ramp ramp;
};

/// Returns the interval to which a burst belongs; empty if the burst belongs to an earlier trial.
inline std::optional<int> interval_of(const std::vector<Presented>& presented, std::uint32_t burst) {
  for (std::size_t i = 0; i < presented.size(); ++i)
    if (presented[i].burst == burst) return static_cast<int>(i);
  return std::nullopt;
}

/// Schedules the intervals of a trial. Returns nothing if the stream does not know yet at which time it plays
/// which frame.
inline std::vector<Onset> schedule(audio::Stream& stream, std::span<const audio::PreparedBurst> intervals,
                                   std::int64_t earliest_ns, std::vector<Presented>& presented) {
  const auto earliest = stream.frame_at(earliest_ns);
  if (!earliest) return {};
  std::vector<audio::PreparedBurst> bursts(intervals.begin(), intervals.end());
  const auto later = std::max<std::int64_t>(0, *earliest) - bursts.front().start_frame;
  for (auto& burst : bursts) burst.start_frame += later;
  const auto scheduled = stream.schedule_together(bursts);
  presented.clear();
  std::vector<Onset> onsets;
  for (std::size_t i = 0; i < bursts.size(); ++i) {
    const auto start = scheduled[i].start_frame;
    presented.push_back({scheduled[i].burst, start, start + bursts[i].length_frames, bursts[i].ramp});
    if (const auto time_ns = stream.time_of(start)) onsets.push_back({start, *time_ns});
  }
  if (onsets.size() == bursts.size()) return onsets;
  stream.stop(0, audio::Ramp{});  // the stream's clock became unknown after some intervals had been scheduled
  return {};
}

/// Returns the bursts of the intervals, with the start frames at which they were scheduled.
inline std::vector<audio::PreparedBurst> scheduled(std::span<const audio::PreparedBurst> intervals,
                                                   const std::vector<Presented>& presented) {
  std::vector<audio::PreparedBurst> bursts(intervals.begin(), intervals.end());
  for (std::size_t i = 0; i < bursts.size(); ++i) bursts[i].start_frame = presented[i].start_frame;
  return bursts;
}

/// The numbers and frames of the intervals, as the loop that follows the finger needs them.
inline std::vector<FollowLoop::Burst> followed_of(const std::vector<Presented>& presented) {
  std::vector<FollowLoop::Burst> bursts;
  for (const auto& one : presented) bursts.push_back({one.burst, one.start_frame, one.end_frame});
  return bursts;
}

/// Makes the last interval glide to other tones. Returns the change that was sent; empty if it is too late
/// for one.
inline std::optional<audio::Change> glide_to(audio::Stream& stream, const std::vector<Presented>& presented,
                                             const audio::ToneSet& to, double seconds) {
  if (presented.empty()) return std::nullopt;
  const auto& sounding = presented.back();
  const auto frames = static_cast<std::int64_t>(seconds * stream.config().output.rate_Hz);
  const auto at = std::max(stream.earliest_frame(), sounding.start_frame);
  // A burst that has begun its final ramp can no longer change to other tones.
  if (at + frames + sounding.ramp.frames >= sounding.end_frame) return std::nullopt;
  const audio::Change change{at - sounding.start_frame, frames, to};
  stream.change(sounding.burst, change);
  return change;
}

inline std::optional<ClockFit> fit_of(audio::Stream& stream) {
  const auto fit = stream.clock();
  return fit.pairs > 0 ? std::optional(ClockFit{fit.ns_per_frame, fit.residual_ns}) : std::nullopt;
}

/// Ramps all bursts down. Returns the time at which the last ramp ends, or a later time if that is not known
/// exactly.
inline std::int64_t ramp_down(audio::Stream& stream, const std::vector<Presented>& presented,
                              std::int64_t now_ns) {
  const auto ramp = presented.empty() ? audio::Ramp{} : presented.back().ramp;
  stream.stop(0, ramp);
  if (const auto silent_ns = stream.time_of(stream.earliest_frame() + ramp.frames)) return *silent_ns;
  const auto& output = stream.config().output;
  const auto frames = std::int64_t{output.periods + 2} * output.period_frames + ramp.frames;
  return now_ns + frames * 1'000'000'000 / output.rate_Hz;
}

/// Describes, for the record of the session, which rights the operating system granted.
std::string describe(const system::Rights& rights);

}  // namespace turnpoint::session
