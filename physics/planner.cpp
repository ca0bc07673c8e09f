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
#include "physics/mode_bound.hpp"
#include "physics/modes_bound.hpp"

namespace turnpoint::physics {
namespace {

// safety factor, because models may differ more between the probe points than at them
constexpr double probe_margin = 1.9;
constexpr int probes = 160;
constexpr double unknown = 2, unknown_dB = 120;
// An edge that friction defines lies between the last maximum and this fraction of it.
constexpr double faint = 0.02;
// Error of `modes` that is assumed before it is solved, if no higher mode resonates. The values are above the
// largest errors found on random surfaces. Plates under tension have thin boundary layers along their clamped
// sides. The field of a clamped plate's piston jumps at the corners of the drive edge.
constexpr double membrane_accuracy = 2e-3, plate_accuracy = 2.5e-3, tense_plate_accuracy = 5e-3,
                 thick_plate_accuracy = 4e-3, plate_piston_accuracy = 0.15;
// how much the square of the largest slope of the sides adds to that on a membrane, relative to it
constexpr double steep_share = 0.25;
// how much a resonance of a higher mode adds to the assumed error of `modes`
constexpr double membrane_resonance = 5e-4, plate_resonance = 6e-3, thick_plate_resonance = 6e-4;
// shift of an edge relative to the cut-off half-width, divided by the error of `modes`; larger with a quality
// factor of the wave below 30, because the field is then less steep at its edges. On clamped thin plates the
// largest shift found was 0.28 of the error that is assumed.
constexpr double edge_share = 0.8, plate_edge_share = 0.32, lossy_edge_share = 1.2, lossy_below = 30;

// The profile of one model: logarithms of |v| at the probe points, and the positions of its maximum and edge.
struct Probe {
  std::shared_ptr<const CentreLine> line;
  std::vector<double> ln;
  std::optional<double> peak, edge;
  double ln_peak = 0, ln_drive = 0;
};

std::vector<double> probe_points(const Surface& surface) {
  std::vector<double> x;
  for (int i = 0; i <= probes; ++i) x.push_back(surface.length_m * i / probes);
  return x;
}

Probe probe(const Surface& surface, const Edge& edge, double f, Model model) {
  Probe p;
  p.line = make_centre_line(surface, f, model);
  std::vector<std::complex<double>> v(probes + 1);
  p.ln.resize(probes + 1);
  p.peak = p.line->last_peak_m();
  p.ln_drive = p.line->value(0).ln_magnitude();
  p.ln_peak = p.peak ? p.line->value(*p.peak).ln_magnitude() : p.ln_drive;
  p.line->evaluate(probe_points(surface), 1.0, p.ln_peak, v, p.ln);
  for (double& one : p.ln) one = std::max(one, -700.0);
  if (edge.kind == Edge::Kind::percent) p.edge = p.line->level_m(edge.level);
  if (edge.kind == Edge::Kind::peak || edge.kind == Edge::Kind::friction) p.edge = p.peak;
  return p;
}

// The differences between two models at the probe points. The members correspond to the bounds of a
// RungEstimate.
struct Difference {
  double amplitude = 0, level_dB = 0, position_m = 0;
};

Difference compare(const Surface& surface, const PlanRequest& request, const Edge& edge, const Probe& a,
                   const Probe& b) {
  Difference d;
  double worst = 0, most = 0;
  const bool drive = request.normalise != Normalise::peak;
  const double shift_a = drive ? a.ln_peak - a.ln_drive : 0, shift_b = drive ? b.ln_peak - b.ln_drive : 0;
  for (std::size_t i = 0; i < a.ln.size(); ++i) {
    const double va = std::exp(std::min(300.0, a.ln[i] + shift_a)),
                 vb = std::exp(std::min(300.0, b.ln[i] + shift_b));
    worst = std::max(worst, std::abs(va - vb));
    most = std::max(most, vb);
  }
  d.amplitude = probe_margin * worst / most;
  d.level_dB = 8.686 * std::abs((a.ln_peak - a.ln_drive) - (b.ln_peak - b.ln_drive));
  // one profile has a last maximum and the other has none: they are normalised differently and cannot be
  // compared
  if (a.peak.has_value() != b.peak.has_value()) {
    d.amplitude += unknown;
    d.level_dB += unknown_dB;
  }
  if (edge.kind == Edge::Kind::turning) return d;
  if (a.edge.has_value() != b.edge.has_value()) d.position_m = surface.length_m;
  if (a.edge && b.edge) d.position_m = 1.05 * std::abs(*a.edge - *b.edge);
  return d;
}

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
  Probe mode;
  double conditioning;
  ModeBound bound;
  bool shallow_peak;  // true if slightly more loss would remove the last maximum
};

Reference reference(const Surface& surface, const Edge& edge, double f) {
  Probe mode = probe(surface, edge, f, Model::mode);
  const double conditioning = mode.line->drive_conditioning(wavenumber_per_m(surface, f));
  const auto farthest =
      edge.kind == Edge::Kind::friction ? mode.line->level_m(faint).value_or(surface.length_m) : mode.edge;
  const auto bound = mode_bound(surface, f, conditioning, mode.peak, farthest);
  const bool uncertain_peak = mode.peak && peak_is_shallow(surface, f, *mode.peak);
  return {f, edge, std::move(mode), conditioning, bound, uncertain_peak};
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
  if (x.has_value() != reference.mode.edge.has_value()) e.boundary_bound_m += surface.length_m;
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

// The error of |v| that is assumed of `modes` before it is solved, if the drive edge moves by one.
double modes_accuracy(const Surface& surface, const ModeBound& bound) {
  const double resonance = bound.resonance - 1;
  if (!Dispersion(surface).clamped_bending())
    return membrane_accuracy * (1 + steep_share * bound.steepest * bound.steepest) +
           membrane_resonance * resonance;
  const bool thick = surface.theory != PlateTheory::kirchhoff;
  const double quiet = surface.drive == DriveShape::piston ? plate_piston_accuracy
                       : surface.tension_Pa > 0            ? tense_plate_accuracy
                       : thick                             ? thick_plate_accuracy
                                                           : plate_accuracy;
  return quiet + (thick ? thick_plate_resonance : plate_resonance) * resonance;
}

// Adds the error that comes from the sides, which the two-dimensional field has too.
void add_sides(RungEstimate& e, const PlanRequest& request, const Reference& reference) {
  const SideError& sides = reference.bound.sides;
  e.amplitude_bound +=
      request.normalise == Normalise::peak ? sides.shape : sides.drive(reference.conditioning);
  e.level_bound_dB += sides.level_dB(reference.conditioning);
  if (reference.edge.kind != Edge::Kind::turning) e.boundary_bound_m += sides.position_m;
}

// Estimates the error bounds of the model `modes` without solving it. They depend on how much the field is
// larger than the motion of the drive edge. The first mode tells this, but not on a clamped plate on which
// its error exceeds the field; there nothing can be assumed.
RungEstimate modes_estimate(const Surface& surface, const PlanRequest& request, const Reference& reference) {
  RungEstimate e;
  e.cost_s = cost_s(surface, reference.f, Model::modes, request.points);
  const double accuracy = modes_accuracy(surface, reference.bound);
  const bool drive = request.normalise != Normalise::peak;
  e.amplitude_bound = accuracy * (drive ? reference.conditioning : 1);
  e.level_bound_dB = 20 * std::log10(1 + accuracy * reference.conditioning);
  if (reference.bound.shape > 1 && Dispersion(surface).clamped_bending() && modes_bound_applies(surface)) {
    if (drive) e.amplitude_bound += unknown;
    e.level_bound_dB += unknown_dB;
  }
  const bool lossy = Dispersion(surface).wave_quality(reference.f, surface.quality_factor) < lossy_below;
  const double share = lossy ? lossy_edge_share : is_thin_clamped(surface) ? plate_edge_share : edge_share;
  e.boundary_bound_m =
      accuracy * share * cut_off_half_width_m(surface, reference.f) + placed_elsewhere_m(request, reference);
  e.reason = "two-dimensional field at its default resolution";
  add_sides(e, request, reference);
  return e;
}

// Computes the error bounds of the model `modes` by solving a second time.
RungEstimate compared_modes_estimate(const Surface& surface, const PlanRequest& request,
                                     const Reference& reference, Comparison comparison,
                                     const CentreLine& modes) {
  RungEstimate e = modes_estimate(surface, request, reference);
  const auto bound = modes_bound(surface, reference.f, reference.edge, comparison, &modes);
  e.reason = std::string("two-dimensional field, compared with a ") +
             (comparison == Comparison::finer ? "finer" : "coarser") + " solution";
  e.amplitude_bound = !bound ? unknown : request.normalise == Normalise::peak ? bound->shape : bound->drive;
  e.level_bound_dB = bound ? bound->level_dB : unknown_dB;
  e.boundary_bound_m =
      (bound ? bound->position_m : surface.length_m) + placed_elsewhere_m(request, reference);
  add_sides(e, request, reference);
  return e;
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
  if (model == Model::modes) return modes_estimate(surface, request, reference);
  const ModeBound& bound = reference.bound;
  e.amplitude_bound = (drive ? bound.drive : bound.shape) +
                      rounding_error(surface, reference.f) * (drive ? reference.conditioning : 1);
  e.level_bound_dB = bound.level_dB;
  e.boundary_bound_m = reference.edge.kind == Edge::Kind::turning ? 0 : bound.position_m();
  // The two-dimensional field may have a last maximum although the model `mode` has none, or have it at
  // another place.
  if (reference.shallow_peak) e.boundary_bound_m += surface.length_m;
  if (!reference.mode.peak || reference.shallow_peak) {
    e.amplitude_bound += unknown;
    e.level_bound_dB += unknown_dB;
  }
  return e;
}

// Computes the error bounds of the model `mode` by solving for `modes`. The error of |v| is at most the
// difference between the two plus the error of `modes`.
RungEstimate compared_mode_estimate(const Surface& surface, const PlanRequest& request,
                                    const Reference& reference) {
  RungEstimate e = profile_estimate(surface, request, reference, Model::mode);
  const RungEstimate modes = modes_estimate(surface, request, reference);
  const Difference d = compare(surface, request, reference.edge, reference.mode,
                               probe(surface, reference.edge, reference.f, Model::modes));
  e.amplitude_bound = std::min(e.amplitude_bound, modes.amplitude_bound + d.amplitude);
  e.level_bound_dB = std::min(e.level_bound_dB, modes.level_bound_dB + probe_margin * d.level_dB);
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

// `solved` holds the solutions of `modes`, or nothing at first.
RungEstimate compared_modes(const Surface& surface, const PlanRequest& request,
                            const std::vector<Reference>& references, Comparison comparison,
                            SolvedLines& solved) {
  RungEstimate all;
  all.model = Model::modes;
  for (std::size_t i = solved.size(); i < references.size(); ++i)
    solved.push_back(make_centre_line(surface, references[i].f, Model::modes));
  for (std::size_t i = 0; i < references.size(); ++i)
    merge(all, compared_modes_estimate(surface, request, references[i], comparison, *solved[i]));
  return all;
}

std::vector<Reference> references_for(const Surface& surface, const PlanRequest& request) {
  std::vector<Reference> list;
  for (std::size_t i = 0; i < request.tones.size(); ++i)
    list.push_back(reference(surface, request.edges.empty() ? request.edge : request.edges.at(i),
                             request.tones[i].frequency_Hz));
  return list;
}

bool inside(const RungEstimate& e, const Tolerance& tolerance) {
  return e.usable && (!tolerance.boundary_m || e.boundary_bound_m <= *tolerance.boundary_m) &&
         (!tolerance.amplitude || e.amplitude_bound <= *tolerance.amplitude) &&
         (!tolerance.level_dB || e.level_bound_dB <= *tolerance.level_dB);
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

}  // namespace

RungEstimate estimate(const Surface& surface, const PlanRequest& request, Model model) {
  check(surface, request);
  const auto references = references_for(surface, request);
  if (model == Model::modes && modes_bound_applies(surface)) {
    SolvedLines solved;
    return compared_modes(surface, request, references, Comparison::finer, solved);
  }
  if (model != Model::mode || !modes_bound_applies(surface) || !Dispersion(surface).clamped_bending())
    return estimate_with(surface, request, references, model);
  RungEstimate all;
  for (const Reference& one : references) merge(all, compared_mode_estimate(surface, request, one));
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
  SolvedLines by_modes;
  auto chosen = std::find_if(rungs.begin(), rungs.end(),
                             [&](const RungEstimate& e) { return inside(e, request.tolerance); });
  if (chosen == rungs.end() && modes_bound_applies(surface)) {
    chosen = std::find_if(rungs.begin(), rungs.end(), [](const auto& e) { return e.model == Model::modes; });
    for (const auto comparison : {Comparison::coarser, Comparison::finer}) {
      *chosen = compared_modes(surface, request, references, comparison, by_modes);
      if (inside(*chosen, request.tolerance)) break;
    }
    if (!inside(*chosen, request.tolerance)) chosen = rungs.end();
  }
  choice.inside = chosen != rungs.end();
  if (!choice.inside) {
    chosen = std::find_if(rungs.begin(), rungs.end(), [&](const RungEstimate& e) {
      return e.model == (surface.theory == PlateTheory::elastic ? Model::mode : Model::modes);
    });
  }
  choice.model = chosen->model;
  if (choice.model == Model::modes)
    choice.solved = std::move(by_modes);
  else
    for (const Reference& one : references) choice.solved.push_back(one.mode.line);
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
