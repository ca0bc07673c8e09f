#include "station/session/burst.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "station/core/limits.hpp"
#include "station/protocol/resolve.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::session {

// The drive plays sines, while the surface model counts phase as for a cosine, so shift by a quarter turn.
audio::Tone driven(const scene::PlannedTone& tone) {
  return {tone.frequency_Hz, tone.full_scale, tone.output_phase_rad + std::numbers::pi / 2, tone.channel};
}

audio::ToneSet tones_of(const scene::DrivePlan& plan) {
  if (plan.tones.size() > static_cast<std::size_t>(audio::max_tones))
    throw std::length_error("a scene has more tones than the drive can play at once");
  audio::ToneSet set;
  for (const auto& tone : plan.tones) set.tones[static_cast<std::size_t>(set.count++)] = driven(tone);
  return set;
}

audio::Burst burst_of(const std::vector<scene::DrivePlan>& scenes, const std::vector<double>& starts_s,
                      const std::vector<double>& transitions_s, double length_s, int rate_Hz) {
  if (scenes.size() - 1 > static_cast<std::size_t>(audio::max_changes))
    throw std::length_error("an interval has more changes of scene than the drive supports");
  const auto frames = [rate_Hz](double s) { return static_cast<std::int64_t>(std::llround(s * rate_Hz)); };
  if (scenes.size() > 1 &&
      std::any_of(scenes.begin(), scenes.end(), [](const auto& scene) { return scene.follow != nullptr; }))
    throw std::length_error("a scene that follows the finger is the only one of its interval");
  audio::Burst burst;
  if (const auto& plan = scenes.front().follow)
    burst.following = {
        plan->map.most_gain(), plan->resting_gain, std::max<std::int64_t>(1, frames(plan->ramp_s)),
        std::max<std::int64_t>(1, frames(plan->steady_s)), std::max<std::int64_t>(1, frames(plan->resume_s))};
  burst.length_frames = frames(length_s);
  burst.ramp.frames = std::min(frames(scenes.front().scene.ramp_s), burst.length_frames / 2);
  burst.tones = tones_of(scenes.front());
  for (std::size_t i = 1; i < scenes.size(); ++i) {
    auto& change = burst.changes[static_cast<std::size_t>(burst.change_count++)];
    change.at_frame = frames(starts_s[i - 1]);
    change.frames = std::max<std::int64_t>(1, frames(transitions_s[i - 1]));
    change.to = tones_of(scenes[i]);
  }
  return burst;
}

void mark(audio::Burst& burst, const rig::Marker& marker, int rate_Hz, const MarkerCodes& codes) {
  using Kind = rig::Marker::Kind;
  auto& made = burst.marker;
  made.channel = marker.channel;
  made.amplitude = marker.amplitude;
  made.frequency_Hz = marker.frequency_Hz;
  if (marker.kind == Kind::code) {
    made.kind = audio::MarkerKind::code;
    made.frames = 2 * std::llround(marker.duration_s * rate_Hz / 2);
    made.codes.front() = static_cast<std::uint8_t>(codes.onset);
    for (std::size_t i = 1; i < made.codes.size(); ++i)
      made.codes[i] = static_cast<std::uint8_t>(i <= codes.changes ? codes.change : 0);
    return;
  }
  made.kind = marker.kind == Kind::tone ? audio::MarkerKind::tone : audio::MarkerKind::pulse;
  made.frames = std::clamp<std::int64_t>(std::llround(marker.duration_s * rate_Hz), 1, burst.length_frames);
}

void mask(audio::Burst& burst, const rig::MaskingNoise& noise, std::uint64_t seed) {
  burst.noise = {noise.channel, noise.rms, noise.low_Hz, noise.high_Hz, seed};
}

void signal(audio::Burst& burst, const rig::MaskingNoise& headphones, double at_s, int rate_Hz) {
  const auto frames = [rate_Hz](double s) { return static_cast<std::int64_t>(std::llround(s * rate_Hz)); };
  burst.signal = {headphones.channel, headphones.signal->amplitude, headphones.signal->frequency_Hz,
                  frames(at_s),       frames(core::kSignal_s),      {frames(0.1 * core::kSignal_s)}};
}

audio::Burst scene_burst(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                         const protocol::Factors& factors, double length_s) {
  scene::Planner planner(rig);
  const auto plan = planner.plan(protocol::resolve(protocol, scene, factors, 0));
  return burst_of({plan}, {}, {}, length_s, rig.output.rate_Hz);
}

}  // namespace turnpoint::session
