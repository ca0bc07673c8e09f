#include "station/scene/under_finger.hpp"

#include <fmt/format.h>

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

bool shifts(const physics::Edge& edge) {
  return edge.kind == physics::Edge::Kind::peak || edge.kind == physics::Edge::Kind::percent;
}

}  // namespace

/// `fields` are for drive amplitudes of 1 m. `loads` has, for each tone, the load that a finger puts on the
/// surface at each of the points `x_m`, and one more at the finger's planned position.
struct FingerSolution {
  std::vector<double> x_m;
  std::vector<physics::ToneField> fields;
  std::vector<std::vector<physics::FingerLoad>> loads;
  std::optional<physics::LevelBudget> level;
  std::optional<double> boundary_shift_m;
};

namespace {

FingerSolution solve(const physics::Surface& surface, const physics::Finger& finger, physics::Model model,
                     const DrivePlan& plan, double finger_m) {
  FingerSolution all;
  all.x_m = physics::linspace_points(surface, points);
  auto places = all.x_m;
  places.push_back(finger_m);
  const auto needed = static_cast<std::ptrdiff_t>(places.size());
  std::vector<physics::Tone> tones;
  for (const auto& tone : plan.tones) {
    tones.push_back({tone.frequency_Hz, 1, 0});
    const bool shifted = tones.size() == 1 && shifts(plan.scene.edge);
    auto with_sweep = places;
    if (shifted)
      for (const double x : physics::finger_sweep_m(surface)) with_sweep.push_back(x);
    auto loads = physics::finger_load(surface, tone.frequency_Hz, with_sweep, finger);
    if (shifted)
      all.boundary_shift_m =
          physics::finger_edge_shift_m({loads.begin() + needed, loads.end()}, plan.scene.edge, finger);
    loads.erase(loads.begin() + needed, loads.end());
    all.loads.push_back(std::move(loads));
  }
  all.fields = physics::evaluate_tones(surface, tones, all.x_m, model, physics::Normalise::none);
  if (!tones.empty()) all.level = level_of(surface, tones.front().frequency_Hz, finger_m, Parts::wanted);
  return all;
}

/// A solution, and the drive amplitudes of its tones.
struct Loaded {
  const FingerSolution& solution;
  std::vector<double> drive_m;
};

/// Returns the friction under a finger at one of the points along the surface, averaged over the fingertip,
/// if all displacements are `times` the planned ones. For each tone, the finger reduces the displacement by
/// the same factor everywhere under its contact.
double felt(const Loaded& loaded, const physics::FrictionMap& friction, double fingertip_m,
            const physics::Finger& finger, std::size_t at, double times = 1) {
  const auto& all_m = loaded.solution.x_m;
  const double from_m = all_m[at] - fingertip_m, to_m = all_m[at] + fingertip_m;
  std::vector<double> shares, x_m, values;
  for (std::size_t t = 0; t < loaded.drive_m.size(); ++t)
    shares.push_back(loaded.solution.loads[t][at].share(finger) * loaded.drive_m[t]);
  std::size_t middle = 0;
  for (std::size_t i = 0; i < all_m.size(); ++i) {
    if (all_m[i] < from_m && i + 1 < at) continue;
    if (all_m[i] > to_m && i > at + 1) break;
    if (i == at) middle = x_m.size();
    double squares = 0;
    for (std::size_t t = 0; t < shares.size(); ++t)
      squares += std::norm(loaded.solution.fields[t].v[i] * shares[t]);
    x_m.push_back(all_m[i]);
    values.push_back(friction.relative_friction(times * std::sqrt(squares)));
  }
  return physics::fingertip_average(x_m, values, fingertip_m)[middle];
}

/// Displacement under the finger: the root of the summed squares of the tones' mean displacements.
double displacement_under(const Loaded& loaded, const physics::Finger& finger) {
  double squares = 0;
  for (std::size_t t = 0; t < loaded.drive_m.size(); ++t)
    squares += std::norm(loaded.solution.loads[t].back().under(finger) * loaded.drive_m[t]);
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

/// Returns the point that is nearest to a position; of two equally near, the upper one.
std::size_t nearest(const std::vector<double>& x_m, double at_m) {
  const auto above = std::lower_bound(x_m.begin(), x_m.end(), at_m);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(above - x_m.begin()), x_m.size() - 1);
  return i > 0 && at_m - x_m[i - 1] < x_m[i] - at_m ? i - 1 : i;
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
  ToneUnderFinger all{loaded.x_m, {}, {}};
  for (std::size_t i = 0; i < loaded.x_m.size(); ++i) {
    all.displacement.push_back(std::abs(loaded.fields[0].v[i]));
    all.share.push_back(loaded.loads[0][i].share(finger));
  }
  return all;
}

std::optional<FingerShift> finger_shift(const rig::Rig& rig, double frequency_Hz, const physics::Edge& edge) {
  if (!shifts(edge)) return std::nullopt;
  const auto surface = surface_of(rig);
  const auto sweep =
      physics::finger_load(surface, frequency_Hz, physics::finger_sweep_m(surface), finger_of(rig));
  std::optional<FingerShift> shift;
  for (const auto& finger : fingers_of(rig)) {
    const auto one_m = physics::finger_edge_shift_m(sweep, edge, finger);
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

UnderFinger FingerFigures::of(const physics::Surface& surface, const physics::FrictionMap& friction,
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
  auto key =
      fmt::format("{} {} {}", physics::name(field_model), physics::format(plan.scene.edge), under.finger_m);
  for (const auto& tone : plan.tones) key += fmt::format(" {}", tone.frequency_Hz);
  auto& known = known_[key];
  if (!known)
    known = std::make_shared<const FingerSolution>(solve(surface, finger, field_model, plan, under.finger_m));
  const auto solution = known;
  constexpr std::size_t most = 16;
  if (known_.size() > most) known_.clear();
  Loaded loaded{*solution, {}};
  for (const auto& tone : plan.tones) loaded.drive_m.push_back(tone.amplitude_m);
  const physics::Finger none{0, finger.contact_radius_m};
  under.free_m = displacement_under(loaded, none);
  under.displacement_m = displacement_under(loaded, finger);
  under.least_m = under.most_m = under.displacement_m;
  for (const auto& other : fingers_of(rig)) {
    const double one_m = displacement_under(loaded, other);
    under.least_m = std::min(under.least_m, one_m), under.most_m = std::max(under.most_m, one_m);
  }
  const double fingertip_m = rig.friction.fingertip_m;
  std::vector<double> pressed;
  for (std::size_t at = 0; at < solution->x_m.size(); ++at)
    pressed.push_back(felt(loaded, friction, fingertip_m, finger, at));
  const std::size_t here = nearest(solution->x_m, under.finger_m);
  under.free_friction = felt(loaded, friction, fingertip_m, none, here);
  under.friction = pressed[here];
  under.lowest_friction = *std::min_element(pressed.begin(), pressed.end());
  under.friction_low = under.friction_high = under.friction;
  under.level = solution->level;
  if (under.level) {
    const auto friction_at = [&](double level_dB) {
      return felt(loaded, friction, fingertip_m, finger, here, std::pow(10.0, level_dB / 20));
    };
    under.friction_low = friction_at(under.level->high_dB);
    under.friction_high = friction_at(under.level->low_dB);
  }
  if (const auto zone = zone_of(plan.scene, solution->x_m, pressed)) {
    under.zone_friction = zone->mean;
    under.residual = zone->rms;
  }
  under.profile_x_m = solution->x_m, under.profile_friction = std::move(pressed);
  under.boundary_shift_m = solution->boundary_shift_m;
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
