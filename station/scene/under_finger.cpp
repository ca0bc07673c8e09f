#include "station/scene/under_finger.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "physics/centre_line.hpp"
#include "physics/field.hpp"

namespace turnpoint::scene {

namespace {

constexpr int points = 301;

/// For each tone of a plan: the displacement of the free surface at evenly spaced points, and the load that a
/// finger puts on the surface at each of these points. `loads` has one more entry at its end, for the
/// finger's planned position.
struct Loaded {
  std::vector<double> x_m;
  std::vector<physics::ToneField> fields;  ///< one field for each tone; displacements in m
  std::vector<std::vector<physics::FingerLoad>> loads;
};

Loaded solve(const physics::Surface& surface, const physics::Finger& finger, physics::Model model,
             const DrivePlan& plan, double finger_m) {
  Loaded all;
  all.x_m = physics::linspace_points(surface, points);
  auto places = all.x_m;
  places.push_back(finger_m);
  std::vector<physics::Tone> tones;
  for (const auto& tone : plan.tones) {
    tones.push_back({tone.frequency_Hz, 1, 0});
    all.loads.push_back(physics::finger_load(surface, tone.frequency_Hz, places, finger));
  }
  all.fields = physics::evaluate_tones(surface, tones, all.x_m, model, physics::Normalise::none);
  for (std::size_t t = 0; t < tones.size(); ++t)
    for (auto& v : all.fields[t].v) v *= plan.tones[t].amplitude_m;
  return all;
}

/// Returns the friction under a finger at each position along the surface, averaged over the fingertip, if
/// all displacements are `times` the planned ones. For each tone, the finger reduces the displacement by the
/// same factor everywhere under its contact.
std::vector<double> felt(const Loaded& loaded, const physics::FrictionMap& friction, double fingertip_m,
                         const physics::Finger& finger, double times = 1) {
  std::vector<double> all;
  for (std::size_t at = 0; at < loaded.x_m.size(); ++at) {
    const double from_m = loaded.x_m[at] - fingertip_m, to_m = loaded.x_m[at] + fingertip_m;
    std::vector<double> x_m, values;
    std::size_t middle = 0;
    for (std::size_t i = 0; i < loaded.x_m.size(); ++i) {
      if (loaded.x_m[i] < from_m && i + 1 < at) continue;
      if (loaded.x_m[i] > to_m && i > at + 1) break;
      if (i == at) middle = x_m.size();
      double squares = 0;
      for (std::size_t t = 0; t < loaded.fields.size(); ++t)
        squares += std::norm(loaded.fields[t].v[i] * loaded.loads[t][at].share(finger));
      x_m.push_back(loaded.x_m[i]);
      values.push_back(friction.relative_friction(times * std::sqrt(squares)));
    }
    all.push_back(physics::fingertip_average(x_m, values, fingertip_m)[middle]);
  }
  return all;
}

/// Displacement under the finger: the root of the summed squares of the tones' mean displacements.
double displacement_under(const Loaded& loaded, const DrivePlan& plan, const physics::Finger& finger) {
  double squares = 0;
  for (std::size_t t = 0; t < plan.tones.size(); ++t) {
    const auto& load = loaded.loads[t].back();
    squares += std::norm(load.unloaded * load.share(finger) * plan.tones[t].amplitude_m);
  }
  return std::sqrt(squares);
}

struct Zone {
  double mean = 1, rms = 0;
};

std::optional<Zone> zone_of(const Scene& scene, const std::vector<double>& x_m,
                            const std::vector<double>& friction) {
  if (!scene.zone || !scene.boundary_m) return std::nullopt;
  double sum = 0, squares = 0, n = 0;
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    if (x_m[i] < scene.zone->from_m || x_m[i] > *scene.boundary_m) continue;
    sum += friction[i], squares += friction[i] * friction[i], n += 1;
  }
  if (n == 0) return std::nullopt;
  return Zone{sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * sum / n))};
}

double nearest(const std::vector<double>& x_m, const std::vector<double>& values, double at_m) {
  const auto above = std::lower_bound(x_m.begin(), x_m.end(), at_m);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(above - x_m.begin()), x_m.size() - 1);
  return i > 0 && at_m - x_m[i - 1] < x_m[i] - at_m ? values[i - 1] : values[i];
}

}  // namespace

physics::Finger finger_of(const rig::Rig& rig) {
  return {std::polar(rig.finger.impedance_Ns_per_m, rig.finger.phase_rad), 0.5 * rig.finger.contact_m};
}

std::vector<physics::Finger> fingers_of(const rig::Rig& rig) {
  std::vector<physics::Finger> all{finger_of(rig)};
  const auto& f = rig.finger;
  constexpr double most_phase = 0.5 * std::numbers::pi;
  for (const double impedance : {-f.impedance_sd_Ns_per_m, f.impedance_sd_Ns_per_m})
    for (const double phase : {-f.phase_sd_rad, f.phase_sd_rad})
      all.push_back({std::polar(std::max(0.0, f.impedance_Ns_per_m + impedance),
                                std::clamp(f.phase_rad + phase, -most_phase, most_phase)),
                     0.5 * f.contact_m});
  return all;
}

ToneUnderFinger tone_under_finger(const physics::Surface& surface, const rig::Rig& rig, physics::Model model,
                                  double frequency_Hz) {
  DrivePlan plan;
  PlannedTone tone;
  tone.frequency_Hz = frequency_Hz, tone.amplitude_m = 1;
  plan.tones.push_back(std::move(tone));
  const auto finger = finger_of(rig);
  const auto loaded = solve(surface, finger, model, plan, 0);
  ToneUnderFinger all{loaded.x_m, {}};
  for (std::size_t i = 0; i < loaded.x_m.size(); ++i)
    all.displacement.push_back(std::abs(loaded.fields[0].v[i]) * loaded.loads[0][i].share(finger));
  return all;
}

std::optional<FingerShift> finger_shift(const rig::Rig& rig, double frequency_Hz, const physics::Edge& edge) {
  if (edge.kind != physics::Edge::Kind::peak && edge.kind != physics::Edge::Kind::percent)
    return std::nullopt;
  const auto surface = surface_of(rig);
  std::optional<FingerShift> shift;
  for (const auto& finger : fingers_of(rig)) {
    const auto one_m = physics::finger_edge_shift_m(surface, frequency_Hz, edge, finger);
    if (!one_m) return std::nullopt;
    if (!shift) shift = FingerShift{*one_m, *one_m, *one_m};
    shift->least_m = std::min(shift->least_m, *one_m), shift->most_m = std::max(shift->most_m, *one_m);
  }
  return shift;
}

std::optional<physics::LevelBudget> level_of(const physics::Surface& surface, double frequency_Hz,
                                             double at_m, Parts parts) {
  try {
    auto level = parts == Parts::wanted ? physics::level_budget(surface, frequency_Hz, at_m)
                                        : physics::level_uncertainty(surface, frequency_Hz, at_m);
    if (level.total_dB > 0) return level;
  } catch (const std::invalid_argument&) {  // a surface that is so far from the planned one cannot exist
  }
  return std::nullopt;
}

UnderFinger finger_figures(const physics::Surface& surface, const physics::FrictionMap& friction,
                           const rig::Rig& rig, physics::Model field_model, const DrivePlan& plan) {
  UnderFinger under;
  const auto finger = finger_of(rig);
  const auto& wanted = plan.scene.under_finger;
  double place_m = plan.boundary_m.value_or(0.5 * surface.length_m);
  if (wanted) {
    place_m = wanted->finger_m;
  } else if (!plan.tones.empty()) {
    place_m = plan.tones.front().last_peak_m.value_or(place_m);
  }
  under.finger_m = std::clamp(place_m, 0.0, surface.length_m);
  const auto loaded = solve(surface, finger, field_model, plan, under.finger_m);
  const physics::Finger none{0, finger.contact_radius_m};
  under.free_m = displacement_under(loaded, plan, none);
  under.displacement_m = displacement_under(loaded, plan, finger);
  under.least_m = under.most_m = under.displacement_m;
  for (const auto& other : fingers_of(rig)) {
    const double one_m = displacement_under(loaded, plan, other);
    under.least_m = std::min(under.least_m, one_m), under.most_m = std::max(under.most_m, one_m);
  }
  const auto free = felt(loaded, friction, rig.friction.fingertip_m, none);
  const auto pressed = felt(loaded, friction, rig.friction.fingertip_m, finger);
  under.free_friction = nearest(loaded.x_m, free, under.finger_m);
  under.friction = nearest(loaded.x_m, pressed, under.finger_m);
  under.lowest_friction = *std::min_element(pressed.begin(), pressed.end());
  under.friction_low = under.friction_high = under.friction;
  if (!plan.tones.empty()) {
    const auto friction_at = [&](double level_dB) {
      const auto moved =
          felt(loaded, friction, rig.friction.fingertip_m, finger, std::pow(10.0, level_dB / 20));
      return nearest(loaded.x_m, moved, under.finger_m);
    };
    under.level = level_of(surface, plan.tones.front().frequency_Hz, under.finger_m, Parts::wanted);
    if (under.level) {
      under.friction_low = friction_at(under.level->high_dB);
      under.friction_high = friction_at(under.level->low_dB);
    }
  }
  under.profile_x_m = loaded.x_m, under.profile_friction = pressed;
  if (const auto zone = zone_of(plan.scene, loaded.x_m, pressed)) {
    under.zone_friction = zone->mean;
    under.residual = zone->rms;
  }
  const auto kind = plan.scene.edge.kind;
  if (!plan.tones.empty() && (kind == physics::Edge::Kind::peak || kind == physics::Edge::Kind::percent))
    under.boundary_shift_m =
        physics::finger_edge_shift_m(surface, plan.tones.front().frequency_Hz, plan.scene.edge, finger);
  return under;
}

std::optional<FingerShares> finger_shares(const rig::Rig& rig, const std::vector<double>& frequencies_Hz) {
  const auto surface = surface_of(rig);
  const auto finger = finger_of(rig);
  std::optional<FingerShares> shares;
  for (const double frequency_Hz : frequencies_Hz) {
    const auto peak_m = physics::make_centre_line(surface, frequency_Hz, physics::Model::mode)->last_peak_m();
    if (!peak_m) continue;
    const double share = physics::finger_load(surface, frequency_Hz, {*peak_m}, finger)[0].share(finger);
    if (!shares) shares = FingerShares{};
    if (const auto level = level_of(surface, frequency_Hz, *peak_m, Parts::left_out))
      shares->level_sd_dB = std::max(shares->level_sd_dB.value_or(0), level->total_dB);
    shares->least = std::min(shares->least, share), shares->most = std::max(shares->most, share);
  }
  return shares;
}

}  // namespace turnpoint::scene
