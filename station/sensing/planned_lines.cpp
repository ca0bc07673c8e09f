#include "station/sensing/planned_lines.hpp"

#include <algorithm>

#include "station/sensing/aligned_blocks.hpp"

namespace turnpoint::sensing {

PlannedTones::PlannedTones(const audio::PreparedBurst& burst)
    : tones_(burst.tones.begin(), burst.tones.begin() + burst.tone_count), start_frame_(burst.start_frame) {}

// Applies a change as the synthesiser does: frequencies glide linearly, and the phase does not jump.
Glide PlannedTones::change(const audio::PreparedChange& change) {
  const auto since = static_cast<std::uint64_t>(change.at_frame - origin_);
  const std::int64_t frames = std::max<std::int64_t>(1, change.frames);
  for (std::size_t i = tones_.size(); i < static_cast<std::size_t>(change.count); ++i) {
    tones_.push_back(audio::advanced(change.to[i], static_cast<std::uint64_t>(origin_)));
    tones_.back().amplitude = 0;
  }
  Glide glide{++changes_, start_frame_ + change.at_frame, frames, {}};
  for (std::size_t i = 0; i < tones_.size(); ++i) {
    const auto& to = change.to[i];
    const auto partial = audio::gliding(audio::advanced(tones_[i], since), to, frames);
    if (partial.amplitude != 0 || to.amplitude != 0) glide.tones.push_back({static_cast<int>(i), partial});
    tones_[i] = audio::after_glide(partial, to, frames);
  }
  origin_ = change.at_frame + frames;
  return glide;
}

Stretch PlannedTones::stretch(std::int64_t first_frame, std::int64_t end_frame) const {
  Stretch stretch{changes_, origin_frame(), first_frame, end_frame, {}};
  for (std::size_t i = 0; i < tones_.size(); ++i)
    if (tones_[i].amplitude != 0) stretch.tones.push_back({static_cast<int>(i), tones_[i]});
  return stretch;
}

std::vector<Stretch> planned_stretches(const audio::PreparedBurst& burst) {
  PlannedTones tones(burst);
  const std::int64_t start = burst.start_frame, risen = start + burst.ramp.frames,
                     falls = start + burst.length_frames - burst.ramp.frames;
  std::vector<Stretch> stretches;
  for (int c = 0; c <= burst.change_count; ++c) {
    const bool last = c == burst.change_count;
    const audio::PreparedChange* next = last ? nullptr : &burst.changes[static_cast<std::size_t>(c)];
    const std::int64_t first = std::max(tones.origin_frame(), risen),
                       end = last ? falls : std::min(start + next->at_frame, falls);
    if (first < end) stretches.push_back(tones.stretch(first, end));
    if (!last) tones.change(*next);
  }
  return stretches;
}

std::vector<PlannedLine> planned_lines(const Stretch& stretch, const std::vector<PickUp>& pick_ups,
                                       int rate_Hz) {
  std::vector<PlannedLine> lines;
  for (const auto& [index, tone] : stretch.tones) {
    auto same = std::find_if(lines.begin(), lines.end(), [&](const PlannedLine& line) {
      return line.tones.front().partial.increment == tone.increment;
    });
    if (same == lines.end()) {
      PlannedLine line;
      line.frequency_Hz = static_cast<double>(tone.increment) * 0x1p-64 * rate_Hz;
      line.gain = high_pass_gain(line.frequency_Hz, rate_Hz, high_pass_step(rate_Hz));
      line.expected.resize(pick_ups.size());
      line.seen.resize(pick_ups.size(), 1);
      same = lines.insert(lines.end(), line);
    }
    same->tones.push_back({index, tone});
    const double turn =
        2 * M_PI * 0x1p-64 * static_cast<double>(tone.phase - same->tones.front().partial.phase);
    for (std::size_t p = 0; p < pick_ups.size(); ++p)
      if (const auto h = response(pick_ups[p], tone.channel, same->frequency_Hz))
        same->expected[p] += *h * std::polar(tone.amplitude, turn);
      else
        same->seen[p] = 0;
  }
  for (PlannedLine& line : lines) {
    double planned = 0;
    for (const PlayedTone& tone : line.tones) planned += tone.partial.amplitude;
    for (std::size_t p = 0; p < pick_ups.size(); ++p)
      line.seen[p] *= std::abs(line.expected[p]) / (planned * best_response(pick_ups[p]));
  }
  return lines;
}

std::size_t main_pick_up(const std::vector<PlannedLine>& lines, std::size_t pick_ups) {
  std::size_t best = 0;
  double most = -1;
  for (std::size_t p = 0; p < pick_ups; ++p) {
    double seen = 0;
    for (const PlannedLine& line : lines) seen += line.seen[p] * line.seen[p];
    if (!(seen > most)) continue;
    most = seen;
    best = p;
  }
  return best;
}

double planned_power(const std::vector<PlannedLine>& lines, std::size_t pick_up) {
  double power = 0;
  for (const PlannedLine& line : lines) power += std::norm(line.expected[pick_up] * line.gain) / 2;
  return power;
}

}  // namespace turnpoint::sensing
