#include "station/scene/transducer.hpp"

#include <algorithm>
#include <utility>

#include "station/core/number.hpp"

namespace turnpoint::scene {

using core::phrase, core::plain;

namespace {

/// Returns the displacement at full scale (m) and the phase (rad) at a frequency inside the band.
std::pair<double, double> response_at(const rig::Transducer& transducer, double frequency_Hz) {
  if (transducer.m_per_full_scale) return {*transducer.m_per_full_scale, 0.0};
  const auto& points = transducer.response;
  const auto after = std::lower_bound(points.begin(), points.end(), frequency_Hz,
                                      [](const auto& point, double f) { return point.frequency_Hz < f; });
  if (after == points.begin()) return {after->m_per_full_scale, after->phase_rad};
  if (after == points.end()) return {points.back().m_per_full_scale, points.back().phase_rad};
  const auto before = after - 1;
  const double share = (frequency_Hz - before->frequency_Hz) / (after->frequency_Hz - before->frequency_Hz);
  return {before->m_per_full_scale + share * (after->m_per_full_scale - before->m_per_full_scale),
          before->phase_rad + share * (after->phase_rad - before->phase_rad)};
}

}  // namespace

PlannedTone on_transducer(const rig::Rig& rig, const physics::Tone& tone) {
  core::Phrase bands;
  for (const auto& transducer : rig.transducers) {
    if (tone.frequency_Hz >= transducer.low_Hz && tone.frequency_Hz <= transducer.high_Hz) {
      const auto [gain_m, phase_rad] = response_at(transducer, tone.frequency_Hz);
      return {tone, transducer.name, transducer.channel, tone.amplitude_m / gain_m,
              tone.phase_rad - phase_rad};
    }
    if (!bands.values.empty()) bands.values.push_back(plain(", "));
    bands.values.push_back(
        phrase("problem.named_band", {plain(transducer.name), plain(core::number(transducer.low_Hz / 1e3)),
                                      plain(core::number(transducer.high_Hz / 1e3))}));
  }
  throw Unreachable(phrase("problem.outside_bands", {plain(core::number(tone.frequency_Hz / 1e3)), bands}));
}

double lowest_frequency(const rig::Rig& rig, double preferred_Hz) {
  double lowest = rig.transducers.front().low_Hz;
  for (const auto& transducer : rig.transducers) lowest = std::min(lowest, transducer.low_Hz);
  return highest_frequency(rig, preferred_Hz) < preferred_Hz ? lowest : std::max(lowest, preferred_Hz);
}

double highest_frequency(const rig::Rig& rig, double limit_Hz) {
  double highest = 0;
  for (const auto& transducer : rig.transducers) highest = std::max(highest, transducer.high_Hz);
  return std::min(highest, limit_Hz);
}

}  // namespace turnpoint::scene
