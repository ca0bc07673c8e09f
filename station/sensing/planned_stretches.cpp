#include "station/sensing/planned_stretches.hpp"

#include <algorithm>

#include "station/drive/oscillator.hpp"

namespace turnpoint::sensing {

namespace {

// A tone while the burst plays. Its phase is counted from the frame of the last change.
struct Running {
  drive::Partial partial;
  int channel = 0;
};

Running running(const drive::PreparedTone& tone) {
  Running made;
  made.partial.phase = tone.phase;
  made.partial.increment = tone.increment;
  made.partial.amplitude = tone.amplitude;
  made.channel = tone.channel;
  return made;
}

// Applies a change as the synthesiser does: frequencies glide linearly, and the phase does not jump.
void change(std::vector<Running>& tones, const drive::PreparedChange& change, std::int64_t origin) {
  const auto since = static_cast<std::uint64_t>(change.at_frame - origin);
  const std::int64_t frames = std::max<std::int64_t>(1, change.frames);
  for (std::size_t i = tones.size(); i < static_cast<std::size_t>(change.count); ++i) {
    Running added = running(change.to[i]);
    added.partial.amplitude = 0;
    added.partial.phase += added.partial.increment * static_cast<std::uint64_t>(origin);
    tones.push_back(added);
  }
  for (std::size_t i = 0; i < tones.size(); ++i) {
    drive::Partial partial = drive::advanced(tones[i].partial, since);
    const auto& to = change.to[i];
    partial.curvature =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(to.increment - partial.increment) / frames);
    partial = drive::advanced(partial, static_cast<std::uint64_t>(frames));
    partial.increment = to.increment;
    partial.curvature = 0;
    partial.amplitude = to.amplitude;
    tones[i].partial = partial;
  }
}

Stretch stretch_of(const std::vector<Running>& tones, std::int64_t origin, std::int64_t first,
                   std::int64_t end, int rate_Hz) {
  Stretch stretch{origin, first, end, {}};
  for (std::size_t i = 0; i < tones.size(); ++i) {
    const auto& [partial, channel] = tones[i];
    if (partial.amplitude == 0) continue;
    stretch.tones.push_back({static_cast<int>(i), channel,
                             static_cast<double>(partial.increment) * 0x1p-64 * rate_Hz, partial.amplitude,
                             partial.phase, partial.increment});
  }
  return stretch;
}

}  // namespace

std::vector<Stretch> planned_stretches(const drive::PreparedBurst& burst, int rate_Hz) {
  std::vector<Running> tones;
  for (std::size_t i = 0; i < static_cast<std::size_t>(burst.tone_count); ++i)
    tones.push_back(running(burst.tones[i]));
  const std::int64_t start = burst.start_frame, risen = burst.ramp.frames,
                     falls = burst.length_frames - burst.ramp.frames;
  std::vector<Stretch> stretches;
  std::int64_t origin = 0;
  for (int c = 0; c <= burst.change_count; ++c) {
    const bool last = c == burst.change_count;
    const drive::PreparedChange* next = last ? nullptr : &burst.changes[static_cast<std::size_t>(c)];
    const std::int64_t first = std::max(origin, risen), end = last ? falls : std::min(next->at_frame, falls);
    if (first < end)
      stretches.push_back(stretch_of(tones, start + origin, start + first, start + end, rate_Hz));
    if (last) break;
    change(tones, *next, origin);
    origin = next->at_frame + std::max<std::int64_t>(1, next->frames);
  }
  return stretches;
}

}  // namespace turnpoint::sensing
