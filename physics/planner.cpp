#include "physics/planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/edge_feature.hpp"
#include "physics/gate.hpp"
#include "physics/map_bounds.hpp"
#include "physics/modal_field.hpp"
#include "physics/mode_bound.hpp"
#include "physics/modes_bound.hpp"

namespace turnpoint::physics {
namespace {

// Margins of the differences between `mode` and `modes`, because what the models leave out may differ more
// between the points at which they are compared; and of those from a coarser solution, which misses a part of
// what the models leave out: of |v|, and of the level and of edges, which are differences at one place.
constexpr double probe_margin = 1.9, field_margin = 1.25, point_margin = 2;
// The largest difference of |v| from a coarse solution for which these margins hold. Near a resonance of a
// clamped plate, a coarse solution may be as wrong as it is different.
constexpr double largest_difference = 0.4, largest_at_resonance = 0.1, resonant_above = 2;
// the least fall between a last maximum and the drive edge for which the maximum counts as certain; more if
// the solution may be wrong by a quarter of it
constexpr double certain_fall = 0.05;
// What the error of `modes` near a resonance is at most, divided by the bound from a coarser solution.
constexpr double resonant_share = 0.36;
// Only if the bound of `mode` that is known without solving for `modes` is at most this many times the
// tolerance, a coarse solution of `modes` is tried, which may show that `mode` suffices. On clamped plates
// that bound says too little.
constexpr double hopeless = 8;
constexpr double unknown = 2, unknown_dB = 120;
// An edge that friction defines lies between the last maximum and this fraction of it.
constexpr double faint = 0.02;
// shift of an edge relative to the cut-off half-width, divided by the error of `modes`; larger with a quality
// factor of the wave below 30, because the field is then less steep at its edges. On clamped thin plates the
// largest shift found was 0.28 of the error that is assumed. In coarse solutions it was 0.32 there, beyond
// what the difference from `mode` holds, 0.11 on thick plates, and 1.1 on other surfaces.
constexpr double edge_share = 0.8, plate_edge_share = 0.32, lossy_edge_share = 1.2, lossy_below = 30,
                 coarse_edge_share = 1.6, coarse_plate_edge_share = 0.6, coarse_thick_edge_share = 0.2;
// These shares were found for edges at half of the last maximum, which are mostly nearer to the turning point
// than this many Airy lengths. In a coarse solution, edges farther out move farther, as those of `mode` do
// (mode_bound.cpp), and so do the maximum and edges that are higher than this level.
constexpr double usual_away = 0.5, high_edge = 0.7, high_edge_growth = 2.5;

// Time of an evaluation on one 3 GHz core. The formulas are fitted to measurements by `turnpoint-bench
// physics`.
double cost_s(const Surface& surface, double f, Model model, int points) {
  const double kl = wavenumber_per_m(surface, f) * surface.length_m;
  const bool plate = Dispersion(surface).clamped_bending();
  const bool mindlin = surface.theory == PlateTheory::mindlin;
  if (surface.theory != PlateTheory::kirchhoff && model == Model::mode) return mindlin ? 1e-2 : 4e-2;
  if (mindlin && model == Model::modes) return 1e-2 * kl;
  switch (model) {
    case Model::edge:
      return 5e-8;
    case Model::mode:
      return plate ? 2e-4 + 5e-8 * points : 3.1e-6 + 0.2e-6 * kl + 2.5e-8 * points;
    case Model::modes:
      break;
  }
  return 1e-3 + (plate ? 1e-4 : 6e-5) * kl + 5e-8 * points;
}

// Error of a solution that is exact apart from rounding (see tests/physics/one_mode_test.cpp).
double rounding_error(const Surface& surface, double f) {
  const double steps = 8 * std::numeric_limits<double>::epsilon();
  return std::max(1e-12, steps * wavenumber_per_m(surface, f) * surface.length_m);
}

void merge(RungEstimate& all, const RungEstimate& one) {
  all.usable = all.usable && one.usable;
  all.boundary_bound_m = std::max(all.boundary_bound_m, one.boundary_bound_m);
  all.amplitude_bound = std::max(all.amplitude_bound, one.amplitude_bound);
  all.level_bound_dB = std::max(all.level_bound_dB, one.level_bound_dB);
  all.cost_s += one.cost_s;
  if (all.reason.empty()) all.reason = one.reason;
}

// The solution of `mode`, on which all bounds are based. It is computed once for each tone.
struct Reference {
  double f;
  Edge edge;
  std::shared_ptr<const CentreLine> mode;
  std::optional<double> peak_m, edge_m;  // the last maximum and the edge of `mode`
  double conditioning;
  ModeBound bound;
  bool shallow_peak;  // true if slightly more loss would remove the last maximum
};

Reference reference(const Surface& surface, const Edge& edge, double f) {
  std::shared_ptr<const CentreLine> mode = make_centre_line(surface, f, Model::mode);
  const auto peak = mode->last_peak_m();
  std::optional<double> at;
  if (edge.kind == Edge::Kind::percent) at = mode->level_m(edge.level);
  if (edge.kind == Edge::Kind::peak || edge.kind == Edge::Kind::friction) at = peak;
  const double conditioning = mode->drive_conditioning(wavenumber_per_m(surface, f));
  const auto farthest =
      edge.kind == Edge::Kind::friction ? mode->level_m(faint).value_or(surface.length_m) : at;
  const auto bound = mode_bound(surface, f, conditioning, peak, farthest);
  const bool uncertain_peak = peak && peak_is_shallow(surface, f, *peak);
  return {f, edge, std::move(mode), peak, at, conditioning, bound, uncertain_peak};
}

RungEstimate edge_estimate(const Surface& surface, const PlanRequest& request, const Reference& reference) {
  RungEstimate e;
  e.cost_s = cost_s(surface, reference.f, Model::edge, 0);
  e.usable = request.points == 0 && !request.tolerance.level_dB && !request.tolerance.amplitude;
  e.reason = e.usable ? "positions only, from the first mode, with loss included" : "has no profile";
  if (reference.edge.kind == Edge::Kind::turning || !e.usable) return e;
  const MapOptions options{
      reference.edge.kind == Edge::Kind::friction ? Edge::peak() : reference.edge, {}, {}, {}};
  const auto x = solve_edge_m(surface, options, reference.f, Model::edge, Wave::exact);
  e.boundary_bound_m = reference.bound.position_m() + (reference.shallow_peak ? surface.length_m : 0);
  if (x.has_value() != reference.edge_m.has_value()) e.boundary_bound_m += surface.length_m;
  return e;
}

// Returns the error of the boundaries that arises because another model has computed the frequencies of the
// tones; 0 if no other model has.
double placed_elsewhere_m(const PlanRequest& request, const Reference& reference) {
  const bool graded = reference.edge.kind != Edge::Kind::turning;
  return graded && request.placed_by.value_or(Model::modes) != Model::modes ? reference.bound.position_m()
                                                                            : 0;
}

bool is_thin_clamped(const Surface& surface) {
  return Dispersion(surface).clamped_bending() && surface.drive != DriveShape::piston &&
         surface.tension_Pa <= 0 && surface.theory == PlateTheory::kirchhoff;
}

// How much farther than an edge at half of the last maximum a coarse solution may move this one.
double edge_growth(const Reference& reference) {
  const Edge& edge = reference.edge;
  if (edge.kind == Edge::Kind::peak || (edge.kind == Edge::Kind::percent && edge.level > high_edge))
    return high_edge_growth;
  const auto grown = [](double away) { return 1 + away * away + 0.5 * std::pow(away, 4); };
  return grown(std::max(usual_away, reference.bound.away)) / grown(usual_away);
}

// Adds the error that comes from the sides, which the two-dimensional field has too.
void add_sides(RungEstimate& e, const PlanRequest& request, const Reference& reference) {
  const SideError& sides = reference.bound.sides;
  e.amplitude_bound +=
      request.normalise == Normalise::peak ? sides.shape : sides.drive(reference.conditioning);
  e.level_bound_dB += sides.level_dB(reference.conditioning);
  if (reference.edge.kind != Edge::Kind::turning) e.boundary_bound_m += sides.position_m;
}

// The error bounds of a solution of the two-dimensional field whose error is assumed, see assumed_error().
// `conditioning` says how much the field is larger than the motion of the drive edge.
RungEstimate assumed_estimate(const Surface& surface, const PlanRequest& request, const Reference& reference,
                              const ModeBound& first, Resolution resolution, double conditioning) {
  const AssumedError assumed = assumed_error(surface, reference.f, first, resolution);
  RungEstimate e;
  e.cost_s = cost_s(surface, reference.f, Model::modes, request.points);
  const bool drive = request.normalise != Normalise::peak;
  e.amplitude_bound = drive ? assumed.drive * conditioning : assumed.shape;
  e.level_bound_dB = 20 * std::log10(1 + assumed.drive * conditioning);
  const bool lossy = Dispersion(surface).wave_quality(reference.f, surface.quality_factor) < lossy_below;
  const bool thick = surface.theory == PlateTheory::mindlin, thin = !lossy && is_thin_clamped(surface);
  const bool coarse = resolution == Resolution::coarsest;
  const double share = coarse  ? thick  ? coarse_thick_edge_share
                                 : thin ? coarse_plate_edge_share
                                        : coarse_edge_share
                       : lossy ? lossy_edge_share
                       : thin  ? plate_edge_share
                               : edge_share;
  const double growth = coarse ? edge_growth(reference) : 1;
  e.boundary_bound_m = assumed.shape * share * growth * cut_off_half_width_m(surface, reference.f) +
                       placed_elsewhere_m(request, reference);
  e.reason = "two-dimensional field at its default resolution";
  add_sides(e, request, reference);
  return e;
}

// Estimates the error bounds of the model `modes` without solving it. How high the field is, the first mode
// tells, but not on a clamped plate on which its error exceeds the field; there nothing can be assumed.
RungEstimate modes_estimate(const Surface& surface, const PlanRequest& request, const Reference& reference) {
  RungEstimate e = assumed_estimate(surface, request, reference, reference.bound, Resolution::usual,
                                    reference.conditioning);
  if (reference.bound.shape > 1 && Dispersion(surface).clamped_bending() && modes_bound_applies(surface)) {
    if (request.normalise != Normalise::peak) e.amplitude_bound += unknown;
    e.level_bound_dB += unknown_dB;
  }
  return e;
}

// Computes the error bounds of the model `modes` by comparing it with another solution. A coarser one shows
// what a resonance of a higher mode adds, so that only the error without resonances is assumed beside it.
RungEstimate compared_modes_estimate(const Surface& surface, const PlanRequest& request,
                                     const Reference& reference, Comparison comparison,
                                     const CentreLine& modes, const CentreLine& compared) {
  const auto bound = modes_bound(surface, reference.f, reference.edge, comparison, modes, compared);
  RungEstimate found;
  found.cost_s = cost_s(surface, reference.f, Model::modes, request.points);
  found.reason = std::string("two-dimensional field, compared with a ") +
                 (comparison == Comparison::finer ? "finer" : "coarser") + " solution";
  found.amplitude_bound = !bound                                 ? unknown
                          : request.normalise == Normalise::peak ? bound->shape
                                                                 : bound->drive;
  found.level_bound_dB = bound ? bound->level_dB : unknown_dB;
  found.boundary_bound_m =
      (bound ? bound->position_m : surface.length_m) + placed_elsewhere_m(request, reference);
  add_sides(found, request, reference);
  if (comparison != Comparison::coarsest || !bound) return found;
  ModeBound without = reference.bound;
  without.resonance = 1;
  const double conditioning =
      std::max(reference.conditioning, modes.drive_conditioning(wavenumber_per_m(surface, reference.f)));
  const RungEstimate assumed =
      assumed_estimate(surface, request, reference, without, Resolution::usual, conditioning);
  const auto better = [](double& one, double other) { one = std::min(one, resonant_share * one + other); };
  better(found.amplitude_bound, assumed.amplitude_bound);
  if (bound->jump) return found;
  better(found.level_bound_dB, assumed.level_bound_dB);
  better(found.boundary_bound_m, assumed.boundary_bound_m);
  return found;
}

RungEstimate profile_estimate(const Surface& surface, const PlanRequest& request, const Reference& reference,
                              Model model) {
  RungEstimate e;
  e.cost_s = cost_s(surface, reference.f, model, request.points);
  e.reason = "first transverse mode with loss";
  const bool drive = request.normalise != Normalise::peak;
  if (model == Model::modes && surface.theory == PlateTheory::elastic)
    throw std::domain_error("model modes is not available for plate theory elastic");
  if (model == Model::modes && surface.theory != PlateTheory::kirchhoff &&
      surface.drive == DriveShape::piston)
    throw std::domain_error("model modes of a thick plate is not available for drive piston");
  if (model == Model::modes) {
    require_modal_line(surface, reference.f);
    return modes_estimate(surface, request, reference);
  }
  const ModeBound& bound = reference.bound;
  e.amplitude_bound = (drive ? bound.drive : bound.shape) +
                      rounding_error(surface, reference.f) * (drive ? reference.conditioning : 1);
  e.level_bound_dB = bound.level_dB;
  e.boundary_bound_m = reference.edge.kind == Edge::Kind::turning ? 0 : bound.position_m();
  // The two-dimensional field may have a last maximum although the model `mode` has none, or have it at
  // another place.
  if (!reference.peak_m || reference.shallow_peak) {
    if (reference.edge.kind != Edge::Kind::turning) e.boundary_bound_m += surface.length_m;
    e.amplitude_bound += unknown;
    e.level_bound_dB += unknown_dB;
  }
  return e;
}

// By what the differences between `mode` and a solution of `modes` are multiplied: those of |v|, and those of
// the level and of edges. A last maximum that slightly more loss would remove is certain if |v| of `modes`
// falls by `fall` between it and the drive edge.
struct Margins {
  double field, points, fall, largest;
};

// Computes the error bounds of the model `mode` by comparing it with a solution of `modes`, whose own error
// bounds are `own`: the error is at most the difference, times a margin, plus the error of that solution.
// What nothing is known of stays as it is: the level and edges of a field without a last maximum, and edges
// that friction defines.
RungEstimate compared_mode_estimate(const Surface& surface, const PlanRequest& request,
                                    const Reference& reference, const CentreLine& modes,
                                    const RungEstimate& own, const Margins& margins) {
  RungEstimate e = profile_estimate(surface, request, reference, Model::mode);
  const auto apart = line_difference(surface, reference.f, reference.edge, *reference.mode,
                                     reference.mode->value(0).ln_magnitude(), modes);
  if (!apart || (reference.shallow_peak && apart->fall < margins.fall)) return e;
  const double difference = request.normalise == Normalise::peak ? apart->shape : apart->drive;
  if (difference > margins.largest) return e;
  e.amplitude_bound = std::min(e.amplitude_bound, own.amplitude_bound + margins.field * difference);
  if (!reference.peak_m) return e;
  e.level_bound_dB = std::min(e.level_bound_dB, own.level_bound_dB + 8.686 * margins.points * apart->ln_gain);
  if (reference.edge.kind == Edge::Kind::percent || reference.edge.kind == Edge::Kind::peak)
    e.boundary_bound_m = std::min(e.boundary_bound_m, own.boundary_bound_m + margins.points * apart->edge_m);
  return e;
}

RungEstimate estimate_with(const Surface& surface, const PlanRequest& request,
                           const std::vector<Reference>& references, Model model) {
  RungEstimate all;
  all.model = model;
  for (const Reference& one : references) {
    try {
      merge(all, model == Model::edge ? edge_estimate(surface, request, one)
                                      : profile_estimate(surface, request, one, model));
    } catch (const std::domain_error& error) {  // the model does not apply to this surface or tone
      all.usable = false;
      all.reason = error.what();
    }
  }
  return all;
}

// The solutions of all tones by `modes` at the default resolution.
SolvedLines solve_modes(const Surface& surface, const std::vector<Reference>& references) {
  SolvedLines solved;
  for (const Reference& one : references) solved.push_back(make_centre_line(surface, one.f, Model::modes));
  return solved;
}

// The solutions of all tones by `modes` at another resolution.
SolvedLines solve_compared(const Surface& surface, const std::vector<Reference>& references,
                           Comparison comparison) {
  SolvedLines solved;
  for (const Reference& one : references) solved.push_back(make_compared_line(surface, one.f, comparison));
  return solved;
}

RungEstimate compared_modes(const Surface& surface, const PlanRequest& request,
                            const std::vector<Reference>& references, Comparison comparison,
                            const SolvedLines& modes, const SolvedLines& compared) {
  RungEstimate all;
  all.model = Model::modes;
  for (std::size_t i = 0; i < references.size(); ++i)
    merge(all, compared_modes_estimate(surface, request, references[i], comparison, *modes[i], *compared[i]));
  return all;
}

// The error bounds of `mode` by comparison with coarse solutions of `modes`.
RungEstimate coarsely_compared_mode(const Surface& surface, const PlanRequest& request,
                                    const std::vector<Reference>& references, const SolvedLines& coarse) {
  RungEstimate all;
  all.model = Model::mode;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const Reference& one = references[i];
    const double conditioning =
        std::max(one.conditioning, coarse[i]->drive_conditioning(wavenumber_per_m(surface, one.f)));
    const RungEstimate own =
        assumed_estimate(surface, request, one, one.bound, Resolution::coarsest, conditioning);
    const double shape = assumed_error(surface, one.f, one.bound, Resolution::coarsest).shape;
    const bool resonant = one.bound.resonance > resonant_above && Dispersion(surface).clamped_bending();
    const Margins margins{field_margin, point_margin, std::max(certain_fall, 4 * shape),
                          resonant ? largest_at_resonance : largest_difference};
    merge(all, compared_mode_estimate(surface, request, one, *coarse[i], own, margins));
  }
  all.reason = "first transverse mode with loss, compared with a coarse two-dimensional field";
  return all;
}

std::vector<Reference> references_for(const Surface& surface, const PlanRequest& request) {
  std::vector<Reference> list;
  for (std::size_t i = 0; i < request.tones.size(); ++i)
    list.push_back(reference(surface, request.edges.empty() ? request.edge : request.edges.at(i),
                             request.tones[i].frequency_Hz));
  return list;
}

// True if all bounds that a tolerance limits are at most `times` the tolerance.
bool inside(const RungEstimate& e, const Tolerance& tolerance, double times = 1) {
  return e.usable && (!tolerance.boundary_m || e.boundary_bound_m <= times * *tolerance.boundary_m) &&
         (!tolerance.amplitude || e.amplitude_bound <= times * *tolerance.amplitude) &&
         (!tolerance.level_dB || e.level_bound_dB <= times * *tolerance.level_dB);
}

void check(const Surface& surface, const PlanRequest& request) {
  if (request.tones.empty()) throw std::invalid_argument("a plan needs at least one tone");
  validate(surface);
  for (const Tone& tone : request.tones) validate(surface, tone.frequency_Hz);
  validate(request.edge);
  for (const Edge& edge : request.edges) validate(edge);
  if (!request.edges.empty() && request.edges.size() != request.tones.size())
    throw std::invalid_argument("a plan needs as many edges as tones, or none");
  require(request.points >= 0 && request.points <= 1'000'000, "points", request.points, "0 to 1 000 000");
  for (const auto& one :
       {request.tolerance.boundary_m, request.tolerance.amplitude, request.tolerance.level_dB})
    if (one) require_size("tolerance", *one);
}

std::string numbers(const RungEstimate& e, const Tolerance& tolerance) {
  std::ostringstream text;
  text.precision(3);
  const char* join = "";
  const auto add = [&](const char* what, double bound, double limit, const char* unit) {
    text << join << what << " bound " << bound << unit << (bound <= limit ? " within " : " beyond ") << limit
         << unit;
    join = ", ";
  };
  if (tolerance.boundary_m) add("boundary", e.boundary_bound_m * 1e3, *tolerance.boundary_m * 1e3, " mm");
  if (tolerance.amplitude) add("amplitude", e.amplitude_bound * 100, *tolerance.amplitude * 100, " %");
  if (tolerance.level_dB) add("level", e.level_bound_dB, *tolerance.level_dB, " dB");
  return text.str();
}

// True if a coarse solution of `modes` may show that `mode` suffices, whose bounds are known without one. It
// may not if there is no last maximum, or if what is assumed of the coarse solution is beyond the tolerance.
bool hopeful(const Surface& surface, const PlanRequest& request, const std::vector<Reference>& references,
             const RungEstimate& mode) {
  if (!Dispersion(surface).clamped_bending() && !inside(mode, request.tolerance, hopeless)) return false;
  return std::ranges::all_of(references, [&](const Reference& one) {
    return one.peak_m &&
           inside(assumed_estimate(surface, request, one, one.bound, Resolution::coarsest, one.conditioning),
                  request.tolerance);
  });
}

// Solves for `modes`, and compares it with coarser solutions, which may be known already, and then with finer
// ones, until its bounds are inside the tolerance. A finer solution may be too large to be solved; then the
// bounds found before it stay.
void compare_modes(const Surface& surface, const PlanRequest& request,
                   const std::vector<Reference>& references, SolvedLines coarse, SolvedLines& solved,
                   RungEstimate& modes) {
  solved = solve_modes(surface, references);
  try {
    for (const auto comparison : {Comparison::coarsest, Comparison::coarser, Comparison::finer}) {
      if (comparison != Comparison::coarsest || coarse.empty())
        coarse = solve_compared(surface, references, comparison);
      modes = compared_modes(surface, request, references, comparison, solved, coarse);
      if (inside(modes, request.tolerance)) return;
    }
  } catch (const std::domain_error&) {
  }
}

}  // namespace

RungEstimate estimate(const Surface& surface, const PlanRequest& request, Model model) {
  check(surface, request);
  const auto references = references_for(surface, request);
  if (model == Model::modes && modes_bound_applies(surface))
    return compared_modes(surface, request, references, Comparison::finer, solve_modes(surface, references),
                          solve_compared(surface, references, Comparison::finer));
  if (model != Model::mode || !modes_bound_applies(surface) || !Dispersion(surface).clamped_bending())
    return estimate_with(surface, request, references, model);
  const SolvedLines modes = solve_modes(surface, references),
                    coarse = solve_compared(surface, references, Comparison::coarsest);
  RungEstimate all;
  for (std::size_t i = 0; i < references.size(); ++i) {
    const RungEstimate own =
        compared_modes_estimate(surface, request, references[i], Comparison::coarsest, *modes[i], *coarse[i]);
    merge(all,
          compared_mode_estimate(surface, request, references[i], *modes[i], own,
                                 {probe_margin, probe_margin, std::max(certain_fall, 4 * own.amplitude_bound),
                                  std::numeric_limits<double>::infinity()}));
  }
  return all;
}

PlanChoice choose_model(const Surface& surface, const PlanRequest& request) {
  check(surface, request);
  PlanChoice choice;
  const auto references = references_for(surface, request);
  for (const Model model : all_models)
    if (model >= request.coarsest)
      choice.considered.push_back(estimate_with(surface, request, references, model));
  std::stable_sort(choice.considered.begin(), choice.considered.end(),
                   [](const RungEstimate& a, const RungEstimate& b) { return a.cost_s < b.cost_s; });
  auto& rungs = choice.considered;
  const auto rung = [&rungs](Model model) { return std::ranges::find(rungs, model, &RungEstimate::model); };
  const auto first_inside = [&] {
    return std::ranges::find_if(rungs, [&](const auto& e) { return inside(e, request.tolerance); });
  };
  auto chosen = first_inside();
  const auto modes = rung(Model::modes);
  const bool comparable = modes_bound_applies(surface) && modes->usable;
  SolvedLines coarse, by_modes;
  if (const auto mode = rung(Model::mode);
      comparable && mode < chosen && hopeful(surface, request, references, *mode)) {
    coarse = solve_compared(surface, references, Comparison::coarsest);
    *mode = coarsely_compared_mode(surface, request, references, coarse);
    chosen = first_inside();
  }
  if (comparable && chosen == rungs.end()) {
    compare_modes(surface, request, references, std::move(coarse), by_modes, *modes);
    if (inside(*modes, request.tolerance)) chosen = modes;
  }
  choice.inside = chosen != rungs.end();
  if (!choice.inside) {
    chosen = modes;
    if (const auto mode = rung(Model::mode); !chosen->usable && mode != rungs.end()) chosen = mode;
  }
  choice.model = chosen->model;
  if (choice.model == Model::modes)
    choice.solved = std::move(by_modes);
  else
    for (const Reference& one : references) choice.solved.push_back(one.mode);
  choice.bound = *chosen;
  std::ostringstream text;
  const auto bounds = numbers(*chosen, request.tolerance);
  text << name(choice.model) << ": " << (bounds.empty() ? "the scene has no tolerance" : bounds);
  for (auto below = chosen; below != rungs.begin();) {
    --below;
    if (!below->usable) continue;
    choice.cheaper = *below;
    if (!bounds.empty()) text << "; " << name(below->model) << ": " << numbers(*below, request.tolerance);
    break;
  }
  if (!choice.inside) text << "; no model meets the tolerance";
  choice.reason = text.str();
  return choice;
}

}  // namespace turnpoint::physics
