#include "station/scene/measures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "station/core/limits.hpp"
#include "station/core/number.hpp"

namespace turnpoint::scene {

using core::phrase, core::plain;

namespace {

constexpr double kWideEnd_m = 0.030;

/// The mean of the friction in the scene's zone, and its rms deviation from that mean. Friction is averaged
/// over the fingertip.
struct ZoneFriction {
  double mean = 1, rms = 0;
};

ZoneFriction zone_friction(const std::vector<double>& x_m, const std::vector<double>& amplitude_m,
                           double scale, const physics::FrictionMap& friction, double fingertip_m,
                           const Scene& scene) {
  std::vector<double> values;
  values.reserve(x_m.size());
  for (const double a : amplitude_m) values.push_back(friction.relative_friction(scale * a));
  const auto felt = physics::fingertip_average(x_m, values, fingertip_m);
  double sum = 0, squares = 0, n = 0;
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    if (x_m[i] < scene.zone->from_m || x_m[i] > *scene.boundary_m) continue;
    sum += felt[i], squares += felt[i] * felt[i], n += 1;
  }
  if (n == 0) throw Unreachable(phrase("problem.zone_empty"));
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

/// Returns the last position at which the profile falls below the fraction `share` of its last maximum
/// (linear interpolation). If there is none, returns the end of the profile.
double last_crossing(const std::vector<double>& x_m, const std::vector<double>& a, std::size_t peak,
                     double share) {
  const double level = share * a[peak];
  for (std::size_t i = a.size() - 1; i > peak; --i)
    if (a[i - 1] >= level && a[i] < level)
      return x_m[i] - (x_m[i] - x_m[i - 1]) * (level - a[i]) / (a[i - 1] - a[i]);
  return x_m.back();
}

std::size_t last_maximum(const std::vector<double>& a) {
  const double significant = 0.02 * *std::max_element(a.begin(), a.end());
  for (std::size_t i = a.size() - 2; i > 0; --i)
    if (a[i] >= a[i - 1] && a[i] > a[i + 1] && a[i] > significant) return i;
  return 0;
}

Cues cues_of(const physics::Surface& surface, const std::vector<physics::Tone>& tones,
             const std::vector<physics::ToneField>& fields, const std::vector<double>& amplitude,
             const std::vector<double>& x_m, const DrivePlan& plan) {
  Cues cues;
  double squares = 0;
  std::size_t strongest = 0;
  for (const auto& tone : tones) {
    if (tone.amplitude_m > tones[strongest].amplitude_m)
      strongest = static_cast<std::size_t>(&tone - tones.data());
    if (tone.frequency_Hz >= core::kAudible_Hz) continue;
    cues.pitch_Hz = cues.pitch_Hz == 0 ? tone.frequency_Hz : std::min(cues.pitch_Hz, tone.frequency_Hz);
    squares += tone.amplitude_m * tone.amplitude_m;
  }
  if (squares > 0) cues.loudness_dB = 10 * std::log10(squares / 1e-12);
  double n = 0;
  for (std::size_t i = 0; i < x_m.size() && x_m[i] <= kWideEnd_m; ++i, ++n)
    cues.wide_end_amplitude_m += amplitude[i];
  cues.wide_end_amplitude_m /= std::max(n, 1.0);
  const auto& profile = fields[strongest].v;
  // The first two zeros of the strongest tone's displacement are half a wavelength apart.
  std::vector<double> nodes;
  for (std::size_t i = 1; i < profile.size() && nodes.size() < 2; ++i) {
    const double from = profile[i - 1].real(), to = profile[i].real();
    if ((from < 0) != (to < 0)) nodes.push_back(x_m[i - 1] + (x_m[i] - x_m[i - 1]) * from / (from - to));
  }
  if (nodes.size() == 2) cues.stripe_pitch_m = nodes[1] - nodes[0];
  const auto peak = last_maximum(amplitude);
  cues.displacement_m = amplitude[peak];
  cues.edge_width_m = last_crossing(x_m, amplitude, peak, 0.1) - last_crossing(x_m, amplitude, peak, 0.9);
  const double boundary = std::clamp(plan.boundary_m.value_or(x_m[peak]), 0.0, surface.length_m);
  cues.strip_width_m = 2 * physics::half_width_m(surface, boundary);
  cues.friction = plan.lowest_friction;
  return cues;
}

}  // namespace

void measure(const physics::Surface& surface, const physics::FrictionMap& friction, const rig::Rig& rig,
             const std::vector<physics::Tone>& tones, const std::vector<physics::ToneField>& fields,
             DrivePlan& plan) {
  const auto x_m = physics::linspace_points(surface, profile_points);
  std::vector<double> amplitude, values;
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    double sum = 0, squares = 0;
    for (const auto& tone : fields) {
      sum += std::abs(tone.v[i]);
      squares += std::norm(tone.v[i]);
    }
    plan.peak_displacement_m = std::max(plan.peak_displacement_m, sum);
    amplitude.push_back(std::sqrt(squares));
    values.push_back(friction.relative_friction(amplitude.back()));
  }
  const auto felt = physics::fingertip_average(x_m, values, rig.friction.fingertip_m);
  plan.lowest_friction = *std::min_element(felt.begin(), felt.end());
  if (plan.scene.zone) {
    const auto zone = zone_friction(x_m, amplitude, 1, friction, rig.friction.fingertip_m, plan.scene);
    plan.zone_friction = zone.mean;
    plan.residual = zone.rms;
  }
  plan.cues = cues_of(surface, tones, fields, amplitude, x_m, plan);
}

double scale_to_friction(const std::vector<double>& x_m, const std::vector<double>& amplitude_m,
                         const physics::FrictionMap& friction, const rig::Rig& rig, const Scene& scene) {
  const auto mean_at = [&](double scale) {
    return zone_friction(x_m, amplitude_m, scale, friction, rig.friction.fingertip_m, scene).mean;
  };
  double low = 0, high = 1;
  while (mean_at(high) > scene.zone->friction) {
    if (high > 64)
      throw Unreachable(phrase("problem.zone_friction", {plain(core::number(scene.zone->friction, 4)),
                                                         plain(core::number(mean_at(high), 4))}));
    low = high, high *= 2;
  }
  // Find the scale by regula falsi (Illinois variant): the mean friction falls smoothly as the scale rises,
  // so a few steps are enough.
  double at_low = low == 0 ? 1 - scene.zone->friction : mean_at(low) - scene.zone->friction;
  double at_high = mean_at(high) - scene.zone->friction;
  for (int i = 0; i < 60 && high - low > 1e-10 * high; ++i) {
    const double middle = (low * at_high - high * at_low) / (at_high - at_low);
    const double at_middle = mean_at(middle) - scene.zone->friction;
    if (std::fabs(at_middle) < 1e-10) return middle;
    if (at_middle > 0) {
      low = middle, at_low = at_middle, at_high *= 0.5;
    } else {
      high = middle, at_high = at_middle, at_low *= 0.5;
    }
  }
  return 0.5 * (low + high);
}

double amplitude_tolerance(const physics::FrictionMap& friction, double tolerance) {
  double steepest = 0;
  const double highest = friction.highest_displacement_m();
  for (int i = 1; i <= 200; ++i) {
    const double a = highest * i / 200;
    const double step = 0.01;
    const double slope = (friction.relative_friction(a * (1 - step)) - friction.relative_friction(a)) / step;
    steepest = std::max(steepest, slope);
  }
  return steepest > 0 ? tolerance / steepest : 1.0;
}

}  // namespace turnpoint::scene
