#include "station/session/along_strip.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "station/sensing/finger_track.hpp"
#include "station/store/signal_code.hpp"

namespace turnpoint::session {

namespace {

/// A standard error from fewer strokes than this would be meaningless.
constexpr int kFewest = 3;

/// Returns the first frame of the last interval, and the frame after its end.
std::pair<std::int64_t, std::int64_t> last_interval(const core::TrialRow& row) {
  int last = 0;
  for (const auto& tone : row.tones) last = std::max(last, tone.interval_index);
  std::pair<std::int64_t, std::int64_t> range{INT64_MAX, 0};
  for (const auto& tone : row.tones)
    if (tone.interval_index == last)
      range = {std::min(range.first, tone.onset_frame),
               std::max(range.second, tone.onset_frame + tone.length_frames)};
  return range;
}

}  // namespace

void AlongStrip::add(const core::TrialRow& row, const core::SignalRow& finger, double frames_per_s) {
  if (!row.presented.boundary_mm || finger.channels.size() != 4 || finger.points < 2) return;
  const auto values = store::decode(finger);
  const auto [first, end] = last_interval(row);
  if (first >= end || row.finger.sensing == "wire" || row.finger.sensing == "lost") return;
  std::vector<sensing::FingerPoint> track;
  const double frames_per_point = frames_per_s / finger.rate_Hz;
  for (std::size_t k = 0; k < values[0].size(); ++k) {
    const double frame = static_cast<double>(finger.start_frame) + frames_per_point * static_cast<double>(k);
    if (frame < static_cast<double>(first) || frame >= static_cast<double>(end)) continue;
    track.push_back({static_cast<std::int64_t>(k), values[0][k], values[1][k], values[2][k], values[3][k],
                     values[0][k] > sensing::contact_N});
  }
  for (auto& point : track) point.position_mm -= *row.presented.boundary_mm;
  const auto strokes = sensing::find_strokes(track);
  for (auto& stroke : sensing::friction_profile(track, strokes, profile_.bins).strokes)
    profile_.strokes.push_back(std::move(stroke));
}

AlongStrip::Curve AlongStrip::curve(int direction) const {
  Curve curve;
  const auto mean = profile_.mean(direction);
  for (std::size_t bin = 0; bin < profile_.bins.count; ++bin) {
    const auto strokes = std::count_if(
        profile_.strokes.begin(), profile_.strokes.end(),
        [&](const auto& one) { return one.direction == direction && !std::isnan(one.friction[bin]); });
    if (strokes < kFewest) continue;
    curve.from_boundary_mm.push_back(profile_.bins.centre_mm(bin));
    curve.friction.push_back(mean.friction[bin]);
    curve.se.push_back(mean.se[bin]);
  }
  return curve;
}

}  // namespace turnpoint::session
