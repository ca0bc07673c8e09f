#include "station/scene/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

#include "physics/boundary_budget.hpp"
#include "physics/centre_line.hpp"
#include "physics/field.hpp"
#include "physics/planner.hpp"
#include "physics/plate_theory.hpp"
#include "physics/warning.hpp"
#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/scene/following.hpp"
#include "station/scene/measures.hpp"
#include "station/scene/tone_designer.hpp"
#include "station/scene/transducer.hpp"
#include "station/scene/under_finger.hpp"

namespace turnpoint::scene {

using core::phrase, core::plain;

using core::number;
using physics::Model;
using physics::Tone;

namespace {

/// An upper limit of the drive edge's displacement, far beyond what any transducer reaches.
constexpr double kMostDrive_m = 1e-3;

constexpr std::size_t kRemembered = 512, kSolutions = 128;
constexpr std::size_t kFollowing = 32;  // a plan that follows has 80 kB
constexpr double kLevelStep = 0.005;    // ratio of frequencies for which levels are equally uncertain, less 1

/// Everything of what a scene follows that affects its plan.
std::string key_of(const FollowTarget& target) {
  auto key =
      fmt::format(" follow {} {} {} {} {}", static_cast<int>(target.unit), static_cast<int>(target.control),
                  target.resting_friction.value_or(0), target.resting_gain, target.pattern.base);
  if (target.speeds_m_s) key += fmt::format(" at {} {}", target.speeds_m_s->first, target.speeds_m_s->second);
  for (int i = 0; i < target.pattern.part_count; ++i) {
    const auto& part = target.pattern.parts[static_cast<std::size_t>(i)];
    const auto& trigger = part.trigger;
    key +=
        fmt::format(" / {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", static_cast<int>(part.shape),
                    static_cast<int>(part.combine), part.from, part.to, part.begin_m, part.end_m,
                    part.cycles_per_m, part.cycles_per_s, part.phase_cycles, part.place_m, part.width_m,
                    part.table_first, part.table_count, static_cast<int>(trigger.event), trigger.threshold,
                    static_cast<int>(trigger.until), trigger.delay_s, trigger.lasts_s);
  }
  for (int i = 0; i < target.pattern.table_used; ++i)
    key += fmt::format(" {}", target.pattern.table[static_cast<std::size_t>(i)]);
  return key;
}

/// Returns a text that contains everything in a scene that affects its plan. It is the key of the cache.
std::string key_of(const Scene& scene) {
  const auto maybe = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "-";
  };
  auto key = fmt::format("{} {} {} {} {} {} {} {} {} {}", scene.name, maybe(scene.boundary_m),
                         physics::format(scene.edge), maybe(scene.displacement_m), maybe(scene.friction),
                         scene.rove_dB, scene.ramp_s, maybe(scene.tolerance.boundary_m),
                         maybe(scene.tolerance.level_dB), maybe(scene.tolerance.friction));
  if (scene.under_finger)
    key += fmt::format(" finger {} {}", scene.under_finger->displacement_m, scene.under_finger->finger_m);
  for (const auto& tone : scene.tones)
    key += fmt::format(" / {} {} {} {} {}", maybe(tone.boundary_m), maybe(tone.frequency_Hz),
                       physics::format(tone.edge), tone.displacement_m, tone.phase_rad);
  if (scene.zone)
    key += fmt::format(" zone {} {} {} {}", scene.zone->from_m, scene.zone->friction, scene.zone->tones,
                       maybe(scene.zone->design_friction));
  if (scene.follow) key += key_of(*scene.follow);
  return key;
}

/// How the surface moves for a set of tones, per metre of displacement at the drive edge. Roving (a random
/// change of strength in each trial) changes only this displacement, so one solution serves all strengths.
/// `fields` are computed with the chosen model, or with `mode` if the chosen model is coarser than `mode`,
/// because a coarser model is not good enough for checking the rig's limits.
struct Solution {
  physics::PlanChoice choice;
  /// the tones' frequencies by the chosen model, rounded to 1 / kGridPerHz
  std::vector<double> frequencies_Hz;
  std::vector<physics::ToneField> fields;
  double uncertainty_m = 0;
  std::vector<physics::Warning> warnings;
};

Model at_least_mode(Model chosen) { return chosen == Model::modes ? Model::modes : Model::mode; }

}  // namespace

struct Planner::State : ToneDesigner {
  std::map<std::string, DrivePlan> plans;
  std::map<std::string, Solution> solutions;
  /// one planner per plate theory, used if the rig file leaves the choice of the theory open
  std::map<physics::PlateTheory, Planner> by_theory;
  std::map<std::optional<double>, physics::TheoryChoice> theories;  ///< by the tolerance of a boundary
  /// uncertainty of the level at a tone's last maximum, by the number of steps of the tone's frequency from 1
  /// Hz
  std::map<int, std::optional<double>> level_sd_dB;
  FingerFigures finger_figures;

  using ToneDesigner::ToneDesigner;

  physics::Tolerance tolerance_of(const Scene& scene) const;
  physics::PlanChoice choose(const Scene& scene, const std::vector<Tone>& tones,
                             std::optional<Model> placed_by) const;
  bool place_by_field(const std::vector<ToneTarget>& wanted, std::vector<double>& frequencies_Hz) const;
  Solution solve(const Scene& scene, const std::vector<ToneTarget>& wanted);
  const Solution& solution_for(const Scene& scene, const std::vector<ToneTarget>& wanted);
  void drive(DrivePlan& plan, const std::vector<Tone>& tones, const Solution& solution) const;
  double drive_under_finger_m(const Scene& scene, double frequency_Hz);
  void follow_finger(DrivePlan& plan);

 private:
  /// displacement under a finger divided by that of the drive edge, by frequency (Hz) and position of the
  /// finger (m)
  std::map<std::pair<double, double>, double> moved_under_finger_;
  /// by frequency (Hz) and model
  std::map<std::pair<double, Model>, ToneUnderFinger> under_finger_;
  std::map<double, std::optional<double>> resonances_Hz_;  ///< the nearest one to a frequency
};

physics::Tolerance Planner::State::tolerance_of(const Scene& scene) const {
  physics::Tolerance tolerance;
  tolerance.boundary_m = scene.tolerance.boundary_m;
  tolerance.level_dB = scene.tolerance.level_dB;
  if (scene.tolerance.friction)
    tolerance.amplitude = amplitude_tolerance(friction, *scene.tolerance.friction);
  return tolerance;
}

physics::PlanChoice Planner::State::choose(const Scene& scene, const std::vector<Tone>& tones,
                                           std::optional<Model> placed_by) const {
  physics::PlanRequest request;
  request.tones = tones;
  request.placed_by = placed_by;
  request.edge = scene.edge;
  for (const auto& tone : scene.tones) request.edges.push_back(tone.edge);
  request.normalise = physics::Normalise::none;
  request.tolerance = tolerance_of(scene);
  if (scene.zone || scene.tones.size() > 1) {
    request.points = 301;
    // The field is computed with this model or a better one, see at_least_mode().
    request.coarsest = Model::mode;
  }
  return physics::choose_model(surface, request);
}

/// For each tone that has a boundary: finds the frequency for which the tone's edge lies at this boundary
/// according to the model `modes`. Returns false if there is no such frequency.
bool Planner::State::place_by_field(const std::vector<ToneTarget>& wanted,
                                    std::vector<double>& frequencies_Hz) const {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!wanted[i].boundary_m) continue;
    auto options = edge_options(wanted[i].edge, wanted[i].displacement_m);
    options.model = Model::modes;
    const auto found =
        physics::solve_frequency_Hz(surface, options, *wanted[i].boundary_m, *wanted[i].frequency_Hz);
    if (!found) return false;
    frequencies_Hz[i] = *found;
  }
  return true;
}

/// Returns the uncertainty of the scene's boundary, which is the boundary of its furthest tone.
double boundary_uncertainty_m(const physics::Surface& surface, const Scene& scene,
                              const std::vector<ToneTarget>& wanted) {
  if (wanted.empty()) return 0;
  const auto& furthest = *std::max_element(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) {
    return *a.frequency_Hz < *b.frequency_Hz;
  });
  auto at = furthest.boundary_m ? furthest.boundary_m : scene.boundary_m;
  if (!at) at = physics::turning_point_m(surface, *furthest.frequency_Hz);
  return at ? physics::boundary_budget(surface, *furthest.frequency_Hz, *at).total_m : 0;
}

Solution Planner::State::solve(const Scene& scene, const std::vector<ToneTarget>& wanted) {
  Solution solution;
  std::vector<Tone> tones;
  for (const auto& tone : wanted) {
    tones.push_back({on_grid(*tone.frequency_Hz, kGridPerHz), 1, 0});
    solution.frequencies_Hz.push_back(*tone.frequency_Hz);
  }
  // Zones are designed with the first mode. Their boundary has the error of that model, whichever model is
  // later chosen for the field.
  const auto placed_by = scene.zone ? std::optional(Model::mode) : std::nullopt;
  solution.choice = choose(scene, tones, placed_by);
  if (solution.choice.model == Model::modes && !place_by_field(wanted, solution.frequencies_Hz))
    solution.choice = choose(scene, tones, Model::mode);
  for (std::size_t i = 0; i < tones.size(); ++i) {
    solution.frequencies_Hz[i] = on_grid(solution.frequencies_Hz[i], kGridPerHz);
    if (tones[i].frequency_Hz != solution.frequencies_Hz[i]) solution.choice.solved.clear();
    tones[i].frequency_Hz = solution.frequencies_Hz[i];
  }
  solution.fields = physics::evaluate_tones(surface, tones, physics::linspace_points(surface, profile_points),
                                            at_least_mode(solution.choice.model), physics::Normalise::none,
                                            solution.choice.solved);
  const auto by_mode =
      solution.choice.model == Model::modes ? physics::SolvedLines{} : solution.choice.solved;
  solution.choice.solved.clear();
  solution.uncertainty_m = boundary_uncertainty_m(surface, scene, wanted);
  solution.warnings = physics::tone_warnings(surface, tones, by_mode);
  return solution;
}

const Solution& Planner::State::solution_for(const Scene& scene, const std::vector<ToneTarget>& wanted) {
  auto key = fmt::format("{} {} {} {} {}", physics::format(scene.edge),
                         scene.tolerance.boundary_m.value_or(0), scene.tolerance.level_dB.value_or(0),
                         scene.tolerance.friction.value_or(0), scene.zone || scene.tones.size() > 1);
  for (const auto& tone : wanted)
    key += fmt::format(" {} {} {}", *tone.frequency_Hz, physics::format(tone.edge),
                       tone.boundary_m.value_or(-1));
  const auto found = solutions.find(key);
  if (found != solutions.end()) return found->second;
  if (solutions.size() >= kSolutions) solutions.clear();
  return solutions.emplace(key, solve(scene, wanted)).first->second;
}

void Planner::State::drive(DrivePlan& plan, const std::vector<Tone>& tones, const Solution& solution) const {
  for (std::size_t i = 0; i < tones.size(); ++i) {
    const auto& info = solution.fields[i].info;
    auto tone = on_transducer(rig, tones[i]);
    tone.turning_point_m = info.turning_point_m;
    tone.last_peak_m = info.last_peak_m;
    tone.gain = info.gain;
    tone.displacement_m = info.gain * tone.amplitude_m;
    if (tone.frequency_Hz >= core::kHighestShareOfRate * rig.output.rate_Hz)
      throw Unreachable(
          phrase("problem.too_high", {plain(number(tone.frequency_Hz)), plain(rig.output.rate_Hz),
                                      plain(number(core::kHighestShareOfRate * rig.output.rate_Hz))}));
    plan.tones.push_back(std::move(tone));
  }
  std::stable_sort(plan.tones.begin(), plan.tones.end(),
                   [](const auto& a, const auto& b) { return a.frequency_Hz > b.frequency_Hz; });
  std::map<int, double> channels;
  for (const auto& tone : plan.tones) channels[tone.channel] += tone.full_scale;
  for (const auto& [channel, sum] : channels) plan.peak_full_scale = std::max(plan.peak_full_scale, sum);
}

/// Returns the amplitude of the drive edge that gives the required displacement under the rig's finger.
double Planner::State::drive_under_finger_m(const Scene& scene, double frequency_Hz) {
  const double finger_m = scene.under_finger->finger_m;
  if (finger_m > surface.length_m)
    throw Unreachable(phrase("problem.finger_beyond",
                             {plain(number(1e3 * finger_m)), plain(number(1e3 * surface.length_m))}));
  auto found = moved_under_finger_.find({frequency_Hz, finger_m});
  if (found == moved_under_finger_.end()) {
    if (moved_under_finger_.size() >= kRemembered) moved_under_finger_.clear();
    const auto load = physics::finger_load(surface, frequency_Hz, {finger_m}, finger_of(rig)).front();
    found = moved_under_finger_.emplace(std::pair{frequency_Hz, finger_m}, std::abs(load.loaded)).first;
  }
  const double wanted_m = scene.under_finger->displacement_m * std::pow(10.0, scene.rove_dB / 20);
  if (!(found->second * kMostDrive_m > wanted_m))
    throw Unreachable(phrase("problem.finger_still", {plain(number(1e3 * finger_m))}));
  return wanted_m / found->second;
}

/// Prepares how the gain follows the finger, and takes the cues at the gains that are used.
void Planner::State::follow_finger(DrivePlan& plan) {
  const auto model = at_least_mode(plan.model);
  FingerField field;
  std::vector<Detuning> detunings;
  for (const auto& tone : plan.tones) {
    if (under_finger_.size() >= kRemembered) under_finger_.clear(), resonances_Hz_.clear();
    auto found = under_finger_.find({tone.frequency_Hz, model});
    if (found == under_finger_.end())
      found = under_finger_
                  .emplace(std::pair{tone.frequency_Hz, model},
                           tone_under_finger(surface, rig, model, tone.frequency_Hz))
                  .first;
    const auto& of_tone = found->second;
    field.x_m = of_tone.x_m;
    field.displacement_m.resize(field.x_m.size());
    field.finger_share.resize(field.x_m.size());  // for now displacement under the finger
    for (std::size_t i = 0; i < field.x_m.size(); ++i) {
      const double free_m = tone.amplitude_m * of_tone.displacement[i];
      field.displacement_m[i] = std::hypot(field.displacement_m[i], free_m);
      field.finger_share[i] = std::hypot(field.finger_share[i], of_tone.share[i] * free_m);
    }
    const auto [resonance, is_new] = resonances_Hz_.try_emplace(tone.frequency_Hz);
    if (is_new) resonance->second = physics::nearest_resonance_Hz(surface, tone.frequency_Hz);
    detunings.push_back({tone.frequency_Hz, resonance->second});
  }
  for (std::size_t i = 0; i < field.x_m.size(); ++i)
    field.finger_share[i] = field.displacement_m[i] > 0 ? field.finger_share[i] / field.displacement_m[i] : 1;
  plan.follow = follow_plan(rig, friction, plan, field, detunings);
  const auto gains = followed_gains(*plan.follow);
  if (plan.cues.pitch_Hz > 0 && gains.rms > 0) plan.cues.loudness_dB += 20 * std::log10(gains.rms);
  if (gains.rms == 0) plan.cues.pitch_Hz = plan.cues.loudness_dB = 0;
  plan.cues.wide_end_amplitude_m *= gains.rms;
  plan.cues.displacement_m *= gains.most;
  plan.cues.friction = gains.lowest_friction;
}

/// Says which error bounds of a model are beyond the tolerance of the scene: `friction` as the scene states
/// it, `tolerance` as the physics library takes it.
core::Phrase beyond_tolerance(const physics::RungEstimate& model, const physics::Tolerance& tolerance,
                              std::optional<double> friction) {
  core::Phrase all = plain("");
  const auto add = [&all](const char* key, double bound, std::optional<double> limit, double unit,
                          double as_stated = 0) {
    if (!limit || bound <= *limit) return;
    if (!all.values.empty()) all.values.push_back(plain("; "));
    all.values.push_back(phrase(
        key, {plain(number(bound / unit, 3)), plain(number(*limit / unit, 3)), plain(number(as_stated, 3))}));
  };
  add("problem.bound_boundary", model.boundary_bound_m, tolerance.boundary_m, 1e-3);
  add("problem.bound_amplitude", model.amplitude_bound, tolerance.amplitude, 1e-2, friction.value_or(0));
  add("problem.bound_level", model.level_bound_dB, tolerance.level_dB, 1);
  return all;
}

Planner::Planner(const rig::Rig& rig) : state_(std::make_unique<State>(rig)) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;
Planner::Planner(const Planner& other) : state_(std::make_unique<State>(*other.state_)) {}
const physics::Surface& Planner::surface() const { return state_->surface; }
const physics::FrictionMap& Planner::friction() const { return state_->friction; }

/// Returns a planner for this rig with the given plate theory.
Planner& Planner::by_theory(physics::PlateTheory theory) {
  auto found = state_->by_theory.find(theory);
  if (found == state_->by_theory.end()) {
    rig::Rig rig = state_->rig;
    rig.surface.plate_theory = theory == physics::PlateTheory::kirchhoff ? rig::PlateTheory::kirchhoff
                               : theory == physics::PlateTheory::mindlin ? rig::PlateTheory::mindlin
                                                                         : rig::PlateTheory::elastic;
    found = state_->by_theory.emplace(theory, Planner(rig)).first;
  }
  return found->second;
}

DrivePlan Planner::plan(const Scene& scene) {
  if (state_->rig.surface.plate_theory == rig::PlateTheory::automatic) {
    const auto& rig = state_->rig;
    auto found = state_->theories.find(scene.tolerance.boundary_m);
    if (found == state_->theories.end()) {
      const std::array band{lowest_frequency(rig, core::kAudible_Hz),
                            highest_frequency(rig, core::kHighestShareOfRate * rig.output.rate_Hz)};
      const auto choice = physics::choose_theory(surface(), band, scene.tolerance.boundary_m);
      found = state_->theories.emplace(scene.tolerance.boundary_m, choice).first;
    }
    const auto& choice = found->second;
    DrivePlan plan = by_theory(choice.theory).plan(scene);
    plan.reason += "; " + choice.reason;
    return plan;
  }
  auto& plans = state_->plans;
  const auto key = key_of(scene);
  if (const auto found = plans.find(key); found != plans.end()) return found->second;
  // With roving, each trial has another strength, so almost every scene is new. Clear the cache when it is
  // full, because it would otherwise grow during the session.
  if (plans.size() >= (scene.follow ? kFollowing : kRemembered)) plans.clear();
  // These errors of the physics library mean that the rig cannot present the scene: the surface does not have
  // this edge, or the zone lies beyond the strip.
  try {
    return plans.emplace(key, make(scene)).first->second;
  } catch (const physics::Refused& refused) {
    throw Unreachable(rig::phrase_of(refused));
  } catch (const std::domain_error& error) {  // a model does not apply
    throw Unreachable(plain(error.what()));
  } catch (const std::invalid_argument& error) {  // a number of the scene has no meaning on this surface
    throw Unreachable(plain(error.what()));
  }
}

DrivePlan Planner::make(const Scene& scene) {
  DrivePlan plan;
  plan.scene = scene;
  const auto wanted = state_->tones_for(scene, plan);
  const Solution& solution = state_->solution_for(scene, wanted);
  const auto& choice = solution.choice;
  plan.model = choice.model;
  plan.inside_tolerance = choice.inside;
  const auto missed_by = [&](const char* key, const physics::RungEstimate& model) {
    return phrase(key, {plain(std::string(physics::name(model.model))),
                        beyond_tolerance(model, state_->tolerance_of(scene), scene.tolerance.friction)});
  };
  if (!choice.inside) plan.beyond_tolerance = missed_by("problem.bound_beyond", choice.bound);
  if (choice.cheaper) plan.cheaper = missed_by("problem.cheaper_beyond", *choice.cheaper);
  plan.error_bound_m = choice.bound.boundary_bound_m;
  plan.level_bound_dB = choice.bound.level_bound_dB;
  plan.amplitude_bound = choice.bound.amplitude_bound;
  plan.reason = choice.reason;
  plan.uncertainty_m = solution.uncertainty_m;
  if (scene.boundary_m && !plan.boundary_m) plan.boundary_m = scene.boundary_m;
  std::vector<Tone> tones;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto& info = solution.fields[i].info;
    const double frequency_Hz = solution.frequencies_Hz[i];
    // If the two-dimensional field has no last maximum, scale the drive by the last maximum of the first
    // mode.
    const double drive_m =
        scene.under_finger ? state_->drive_under_finger_m(scene, frequency_Hz)
        : info.last_peak_m ? wanted[i].displacement_m / info.gain
                           : physics::drive_amplitude_m(surface(), frequency_Hz, wanted[i].displacement_m);
    tones.push_back({frequency_Hz, drive_m, wanted[i].phase_rad});
  }
  physics::assign_phases(tones);
  for (auto& tone : tones) {
    tone.amplitude_m = on_grid(tone.amplitude_m, kGridPerMetre);
    tone.phase_rad = on_grid(tone.phase_rad, kGridPerRadian);
  }
  plan.crest_factor = physics::crest_factor(tones);
  plan.audible_products = physics::audible_products(tones);
  plan.warnings = physics::surface_warnings(state_->surface);
  plan.warnings.insert(plan.warnings.end(), solution.warnings.begin(), solution.warnings.end());
  state_->drive(plan, tones, solution);
  plan.theory = surface().theory;
  if (!plan.tones.empty()) plan.shear_shift_m = physics::shear_shift_m(surface(), plan.tones[0].frequency_Hz);
  auto fields = solution.fields;
  for (std::size_t i = 0; i < fields.size(); ++i)
    for (auto& v : fields[i].v) v *= tones[i].amplitude_m;
  measure(state_->surface, state_->friction, state_->rig, tones, fields, plan);
  refuse_beyond_limits(state_->rig, plan);
  if (scene.follow) state_->follow_finger(plan);
  return plan;
}

void refuse_beyond_limits(const rig::Rig& rig, const DrivePlan& plan) {
  if (plan.peak_displacement_m > rig.limits.displacement_m)
    throw Unreachable(phrase("problem.moves_too_far", {plain(number(plan.peak_displacement_m * 1e6, 4)),
                                                       plain(number(rig.limits.displacement_m * 1e6, 4))}));
  if (plan.peak_full_scale > 1)
    throw Unreachable(phrase("problem.drive_too_strong", {plain(number(plan.peak_full_scale, 4))}));
}

Planner::Profile Planner::profile(const DrivePlan& plan, int points) {
  if (state_->rig.surface.plate_theory == rig::PlateTheory::automatic)
    return by_theory(plan.theory).profile(plan, points);
  const std::vector<Tone> tones(plan.tones.begin(), plan.tones.end());
  Profile profile;
  profile.x_m = physics::linspace_points(state_->surface, points);
  profile.displacement_m =
      physics::amplitude_profile(state_->surface, tones, profile.x_m, at_least_mode(plan.model));
  for (const double a : profile.displacement_m)
    profile.friction.push_back(state_->friction.relative_friction(a));
  profile.friction =
      physics::fingertip_average(profile.x_m, profile.friction, state_->rig.friction.fingertip_m);
  return profile;
}

std::optional<double> Planner::nearest_resonance_Hz(const DrivePlan& plan, double frequency_Hz) {
  if (state_->rig.surface.plate_theory == rig::PlateTheory::automatic)
    return by_theory(plan.theory).nearest_resonance_Hz(plan, frequency_Hz);
  return physics::nearest_resonance_Hz(state_->surface, frequency_Hz);
}

void Planner::add_level_uncertainty(DrivePlan& plan) {
  if (state_->rig.surface.plate_theory == rig::PlateTheory::automatic)
    return by_theory(plan.theory).add_level_uncertainty(plan);
  for (auto& tone : plan.tones) {
    const int step = static_cast<int>(std::lround(std::log(tone.frequency_Hz) / std::log1p(kLevelStep)));
    const auto [found, is_new] = state_->level_sd_dB.try_emplace(step);
    if (is_new) {
      const double frequency_Hz = std::exp(step * std::log1p(kLevelStep));
      const auto at_m = physics::tone_info(surface(), frequency_Hz).last_peak_m;
      const auto level = at_m ? level_of(surface(), frequency_Hz, *at_m, Parts::left_out) : std::nullopt;
      if (level) found->second = level->total_dB;
    }
    tone.level_sd_dB = found->second;
  }
}

UnderFinger Planner::under_finger(const DrivePlan& plan) {
  if (state_->rig.surface.plate_theory == rig::PlateTheory::automatic)
    return by_theory(plan.theory).under_finger(plan);
  return state_->finger_figures.of(state_->surface, state_->friction, state_->rig, at_least_mode(plan.model),
                                   plan);
}

}  // namespace turnpoint::scene
