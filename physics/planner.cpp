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

// Safety factor, because two models may differ more between the points at which they are compared, and the
// number of these points.
constexpr double between_points = 1.15, compared_per_radian = 3;
constexpr int fewest_points = 200;
constexpr double unknown = 2, unknown_dB = 120;
// An edge that friction defines lies between the last maximum and this fraction of it.
constexpr double faint = 0.02;
// Error of a solution of `modes` that is assumed before it is solved: without a resonance of a higher mode, what
// a resonance adds, and the most that it adds. The values are above the largest errors found on random
// surfaces. The field of a clamped plate's piston jumps at the corners of the drive edge.
struct Accuracy {
  double quiet, resonance, most;
};
// The errors of |v| with the usual and the coarser resolution, and of the level with the coarser one, which is
// relative to the motion of the drive edge.
struct Accuracies {
  Accuracy usual, coarser, coarser_level;
};
constexpr Accuracies membrane_accuracy{{2e-3, 5e-4, 1e-3}, {2e-3, 5e-3, 0.15}, {1e-3, 2e-3, 0.01}},
    plate_accuracy{{1e-3, 6e-4, 4e-3}, {8e-3, 5e-3, 0.25}, {5e-3, 0, 0}},
    tense_plate_accuracy{{5e-3, 6e-4, 4e-3}, {0.02, 5e-3, 0.25}, {0.012, 0, 0}},
    layered_plate_accuracy{{5e-3, 4e-3, 0.15}, {0.02, 8e-3, 0.25}, {0.012, 0, 0}},
    thick_plate_accuracy{{2e-3, 1e-4, 1e-3}, {0.02, 1e-3, 0.06}, {0.02, 1e-3, 0.06}};
constexpr double plate_piston_accuracy = 0.15;
// Plates under tension have boundary layers along their clamped sides. If these are thinner than the half-width
// at the cut-off divided by this, polynomials across the strip follow them badly.
constexpr double thin_layers = 8;
// shift of an edge relative to the cut-off half-width, divided by the error of `modes`; larger with a quality
// factor of the wave below 30, because the field is then less steep at its edges
constexpr double edge_share = 0.8, lossy_edge_share = 1.2, lossy_below = 30;

// The profile of one model, with the positions of its maximum and edge.
struct Probe {
  std::shared_ptr<const CentreLine> line;
  std::optional<double> peak, edge;
  double ln_peak = 0, ln_drive = 0;
};

Probe probe(const Edge& edge, std::shared_ptr<const CentreLine> line) {
  Probe p;
  p.line = std::move(line);
  p.peak = p.line->last_peak_m();
  p.ln_drive = p.line->value(0).ln_magnitude();
  p.ln_peak = p.peak ? p.line->value(*p.peak).ln_magnitude() : p.ln_drive;
  if (edge.kind == Edge::Kind::percent) p.edge = p.line->level_m(edge.level);
  if (edge.kind == Edge::Kind::peak || edge.kind == Edge::Kind::friction) p.edge = p.peak;
  return p;
}

// The differences between two models at the probe points. The members correspond to the bounds of a
// RungEstimate.
struct Difference {
  double amplitude = 0, level_dB = 0, position_m = 0;
};

Difference compare(const Surface& surface, const PlanRequest& request, double f, const Edge& edge,
                   const Probe& a, const Probe& b) {
  Difference d;
  double worst = 0, most = 0;
  const bool drive = request.normalise != Normalise::peak;
  const double phase = compared_per_radian * wavenumber_per_m(surface, f) * surface.length_m;
  const auto points = static_cast<std::size_t>(fewest_points + std::min(1e5, phase));
  std::vector<double> x(points + 1);
  for (std::size_t i = 0; i <= points; ++i)
    x[i] = surface.length_m * static_cast<double>(i) / static_cast<double>(points);
  // If v(0) is 1, the phase is known too, and the difference is that of complex numbers.
  const auto profile = [&x, drive](const Probe& one) {
    std::vector<std::complex<double>> v(x.size());
    std::vector<double> ln(x.size());
    const auto at_drive = one.line->value(0).mantissa;
    const auto turned = drive && at_drive != 0.0 ? at_drive / std::abs(at_drive) : 1.0;
    one.line->evaluate(x, turned, drive ? one.ln_drive : one.ln_peak, v, ln);
    for (std::size_t i = 0; i < v.size(); ++i)
      if (!drive || !(ln[i] < 300)) v[i] = std::exp(std::clamp(ln[i], -700.0, 300.0));
    return v;
  };
  const auto of_a = profile(a), of_b = profile(b);
  for (std::size_t i = 0; i <= points; ++i) {
    worst = std::max(worst, std::abs(of_a[i] - of_b[i]));
    most = std::max(most, std::abs(of_b[i]));
  }
  d.amplitude = between_points * worst / most;
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
  SideError sides;
  bool shallow_peak;  // true if slightly more loss would remove the last maximum
};

Reference reference(const Surface& surface, const Edge& edge, double f) {
  Probe mode = probe(edge, make_centre_line(surface, f, Model::mode));
  const double conditioning = mode.line->drive_conditioning(wavenumber_per_m(surface, f));
  const auto farthest =
      edge.kind == Edge::Kind::friction ? mode.line->level_m(faint).value_or(surface.length_m) : mode.edge;
  const auto bound = mode_bound(surface, f, conditioning, mode.peak, farthest);
  const bool uncertain_peak = mode.peak && peak_is_shallow(surface, f, *mode.peak);
  return {f, edge, std::move(mode), conditioning, bound, side_error(surface, f), uncertain_peak};
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

enum class Detail { usual, coarser };

Accuracies accuracies(const Surface& surface, double f) {
  const Dispersion dispersion(surface);
  if (!dispersion.clamped_bending()) return membrane_accuracy;
  if (surface.theory != PlateTheory::kirchhoff) return thick_plate_accuracy;
  if (!(surface.tension_Pa > 0)) return plate_accuracy;
  const double layers =
      dispersion.cut_off_half_width_m(f) * std::sqrt(dispersion.tension_N_per_m / dispersion.stiffness_N_m);
  return layers > thin_layers ? layered_plate_accuracy : tense_plate_accuracy;
}

double at_resonance(const Accuracy& accuracy, double resonance) {
  return accuracy.quiet + std::min(accuracy.most, accuracy.resonance * (resonance - 1));
}

// Adds the error of curved, simply supported sides, which the two-dimensional field has too.
void add_sides(RungEstimate& e, const PlanRequest& request, const Reference& reference) {
  const SideError& sides = reference.sides;
  e.amplitude_bound +=
      request.normalise == Normalise::peak ? sides.shape : sides.drive(reference.conditioning);
  e.level_bound_dB += sides.level_dB(reference.conditioning);
  if (reference.edge.kind != Edge::Kind::turning) e.boundary_bound_m += sides.position_m;
}

// Estimates the error bounds of a solution of `modes` before it is solved. They depend on how much the field
// is larger than the motion of the drive edge. The first mode tells this, but not on a clamped plate on which
// its error exceeds the field; there nothing can be assumed.
RungEstimate modes_estimate(const Surface& surface, const PlanRequest& request, const Reference& reference,
                            Detail detail = Detail::usual) {
  RungEstimate e;
  e.cost_s = cost_s(surface, reference.f, Model::modes, request.points);
  const Accuracies assumed = accuracies(surface, reference.f);
  const bool coarser = detail == Detail::coarser, plate = Dispersion(surface).clamped_bending();
  double accuracy = at_resonance(coarser ? assumed.coarser : assumed.usual, reference.bound.resonance);
  double level = at_resonance(coarser ? assumed.coarser_level : assumed.usual, reference.bound.resonance);
  if (plate && surface.drive == DriveShape::piston) accuracy = level = plate_piston_accuracy;
  const bool drive = request.normalise != Normalise::peak;
  e.amplitude_bound = accuracy * (drive ? reference.conditioning : 1);
  e.level_bound_dB = 20 * std::log10(1 + level * reference.conditioning);
  if (reference.bound.shape > 1 && plate && modes_bound_applies(surface)) {
    if (drive) e.amplitude_bound += unknown;
    e.level_bound_dB += unknown_dB;
  }
  const bool lossy = Dispersion(surface).wave_quality(reference.f, surface.quality_factor) < lossy_below;
  const double share = lossy ? lossy_edge_share : edge_share;
  e.boundary_bound_m =
      accuracy * share * cut_off_half_width_m(surface, reference.f) + placed_elsewhere_m(request, reference);
  e.reason = coarser ? "two-dimensional field at a coarser resolution"
                     : "two-dimensional field at its default resolution";
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

// Computes the error bounds of the model `mode` from a solution of `modes`. The error is at most the difference
// between the two plus the error of `modes`.
RungEstimate compared_mode_estimate(const Surface& surface, const PlanRequest& request,
                                    const Reference& reference, Detail detail,
                                    std::shared_ptr<const CentreLine> modes) {
  RungEstimate e = profile_estimate(surface, request, reference, Model::mode);
  const RungEstimate rest = modes_estimate(surface, request, reference, detail);
  const Difference d = compare(surface, request, reference.f, reference.edge, reference.mode,
                               probe(reference.edge, std::move(modes)));
  e.reason = "first transverse mode with loss, compared with a two-dimensional field";
  e.amplitude_bound = std::min(e.amplitude_bound, rest.amplitude_bound + d.amplitude);
  e.level_bound_dB = std::min(e.level_bound_dB, rest.level_bound_dB + d.level_dB);
  // An edge that friction defines may be anywhere between the last maximum and the tip. Where `mode` says
  // nothing of the field, nothing is assumed of `modes` either.
  if (reference.edge.kind != Edge::Kind::friction && reference.bound.shape <= 1)
    e.boundary_bound_m = std::min(e.boundary_bound_m, rest.boundary_bound_m + d.position_m);
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
  for (const Reference& one : references)
    merge(all, compared_mode_estimate(surface, request, one, Detail::usual,
                                      make_centre_line(surface, one.f, Model::modes)));
  return all;
}

namespace {

// True if both solutions have the same last maximum. Where it is shallow, a small error makes another one the
// last.
bool same_peak(const Surface& surface, const Reference& reference, const CentreLine& line) {
  constexpr double most_rad = 0.8;
  const auto peak = line.last_peak_m(), &expected = reference.mode.peak;
  return peak && expected && !reference.shallow_peak &&
         std::abs(*peak - *expected) * wavenumber_per_m(surface, reference.f) < most_rad;
}

// Tries a coarser solution of `modes`, if nothing cheaper than `modes` is inside the tolerance, but the error
// of this solution is. It takes half of the time. The error of `mode` is known closely once it is solved, so
// that `mode` may turn out to suffice. Returns the rung that is taken, or nothing. Sets the rung's bounds, and
// `solved` to the coarser solutions if they are the field.
std::optional<Model> try_coarser(const Surface& surface, const PlanRequest& request,
                                 const std::vector<Reference>& references, std::vector<RungEstimate>& rungs,
                                 SolvedLines& solved) {
  RungEstimate coarser, mode;
  coarser.model = Model::modes;
  mode.model = Model::mode;
  for (const Reference& one : references)
    merge(coarser, modes_estimate(surface, request, one, Detail::coarser));
  if (!inside(coarser, request.tolerance)) return std::nullopt;
  SolvedLines lines;
  try {
    for (const Reference& one : references) {
      lines.push_back(make_coarser_line(surface, one.f));
      if (!same_peak(surface, one, *lines.back())) return std::nullopt;
      merge(mode, compared_mode_estimate(surface, request, one, Detail::coarser, lines.back()));
    }
  } catch (const std::domain_error&) {  // the two-dimensional field would take too long
    return std::nullopt;
  }
  const auto put = [&rungs](const RungEstimate& rung) {
    const auto place = std::ranges::find(rungs, rung.model, &RungEstimate::model);
    if (place == rungs.end()) return false;
    *place = rung;
    return true;
  };
  if (put(mode) && inside(mode, request.tolerance)) return Model::mode;
  if (request.points == 0) return std::nullopt;  // the caller solves for more than the profile
  put(coarser);
  solved = std::move(lines);
  return Model::modes;
}

}  // namespace

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
  if ((chosen == rungs.end() || chosen->model == Model::modes) && modes_bound_applies(surface))
    if (const auto taken = try_coarser(surface, request, references, rungs, by_modes))
      chosen = std::ranges::find(rungs, *taken, &RungEstimate::model);
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
