#include "physics/planner.hpp"

#include <cmath>
#include <limits>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/higher_modes.hpp"
#include "tests/physics/random_scenes.hpp"
#include "tests/physics/random_surfaces.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::Draw;
using turnpoint::physics_test::scenes;

namespace {

using turnpoint::physics_test::frequency_Hz;

Surface random_surface(Draw& draw) {
  Surface s = seed_brass();
  const double cut = cut_off_half_width_m(s, frequency_Hz);
  const double d = draw.spread(0.01, 0.5), ratio = draw.between(1.15, 8), w0 = ratio * cut, length = w0 / d;
  s.quality_factor = draw.next() % 4 == 0 ? std::numeric_limits<double>::infinity() : draw.spread(5, 2000);
  s.drive = draw.next() % 5 == 0 ? DriveShape::piston : DriveShape::cosine;
  switch (draw.next() % 3) {
    case 0:
      s.taper = LinearTaper{w0, d};
      s.length_m = length * draw.between(0.9, 1);
      break;
    case 1:
      s.taper = ExponentialTaper{w0, cut / d};
      s.length_m = cut / d * (std::log(ratio) + 1.8);
      break;
    default:
      s.taper = TabulatedTaper{{{0, w0},
                                {0.3 * length, w0 * draw.between(0.65, 0.8)},
                                {0.6 * length, w0 * draw.between(0.35, 0.5)},
                                {0.95 * length, 0.05 * w0}}};
      s.length_m = 0.95 * length;
  }
  return s;
}

struct TrueError {
  double amplitude = 0, boundary_m = 0, level_dB = 0;
};

// The true error of a model against the two-dimensional field, in the quantities for which a RungEstimate
// (the planner's estimate for one model) states bounds.
std::optional<TrueError> true_error(const Surface& s, Model model, const CentreLine& truth,
                                    Normalise normalise) {
  const auto line = make_centre_line(s, frequency_Hz, model);
  const auto peak = line->last_peak_m(), true_peak = truth.last_peak_m();
  if (!peak || !true_peak) return std::nullopt;
  const bool drive = normalise == Normalise::drive;
  const double unit = line->value(drive ? 0 : *peak).ln_magnitude();
  const double true_unit = truth.value(drive ? 0 : *true_peak).ln_magnitude();
  TrueError error;
  double most = 0;
  for (int i = 0; i <= 400; ++i) {
    const double x = s.length_m * i / 400;
    const double a = std::exp(line->value(x).ln_magnitude() - unit);
    const double b = std::exp(truth.value(x).ln_magnitude() - true_unit);
    error.amplitude = std::max(error.amplitude, std::abs(a - b));
    most = std::max(most, b);
  }
  error.amplitude /= most;
  const auto edge = line->level_m(0.5), true_edge = truth.level_m(0.5);
  if (edge && true_edge) error.boundary_m = std::abs(*edge - *true_edge);
  const double gain = line->value(*peak).ln_magnitude() - line->value(0).ln_magnitude();
  const double true_gain = truth.value(*true_peak).ln_magnitude() - truth.value(0).ln_magnitude();
  error.level_dB = 20 / std::log(10.0) * std::abs(gain - true_gain);
  return error;
}

PlanRequest request_for(Normalise normalise) {
  PlanRequest request;
  request.tones = {Tone{frequency_Hz, 1, 0}};
  request.points = 1000;
  request.edge = Edge::percent(0.5);
  request.normalise = normalise;
  return request;
}

}  // namespace

TEST_CASE("the true error of the model mode lies inside its bound on a thousand random scenes", "[physics]") {
  Draw draw(20260101);
  const int count = scenes(1000);
  int compared = 0;
  for (int i = 0; i < count; ++i) {
    const Surface s = random_surface(draw);
    const auto x0 = turning_point_m(s, frequency_Hz);
    if (!x0 || *x0 < 0.02 * s.length_m) continue;
    const auto truth = make_centre_line(s, frequency_Hz, Model::modes);
    const Normalise normalise = draw.next() % 2 == 0 ? Normalise::peak : Normalise::drive;
    const PlanRequest request = request_for(normalise);
    const RungEstimate bound = estimate(s, request, Model::mode);
    const auto error = true_error(s, Model::mode, *truth, normalise);
    if (!error) continue;
    ++compared;
    CAPTURE(s.taper.index(), s.quality_factor, s.drive == DriveShape::piston, s.length_m, *x0);
    CAPTURE(i, error->amplitude, bound.amplitude_bound, error->boundary_m, bound.boundary_bound_m,
            error->level_dB, bound.level_bound_dB);
    CHECK(error->amplitude <= bound.amplitude_bound);
    CHECK(error->boundary_m <= bound.boundary_bound_m);
    CHECK(error->level_dB <= bound.level_bound_dB);
  }
  CHECK(compared > 3 * count / 4);
}

TEST_CASE("on a wedge, the effect of higher modes on the drive edge is computed to a few percent",
          "[physics]") {
  for (const double quality_factor : {20.0, 200.0}) {
    for (const double slope : {0.05, 0.1, 0.2}) {
      for (const auto shape : {DriveShape::cosine, DriveShape::piston}) {
        Surface s = seed_brass();
        s.quality_factor = quality_factor;
        s.drive = shape;
        const double w0 = 5.2 * cut_off_half_width_m(s, frequency_Hz);
        s.taper = LinearTaper{w0, slope};
        s.length_m = 0.97 * w0 / slope;
        const auto truth = make_centre_line(s, frequency_Hz, Model::modes);
        const double gain = true_error(s, Model::mode, *truth, Normalise::peak)->level_dB / 8.686;
        const HigherModes higher = higher_modes(s, frequency_Hz, 0.7 * s.length_m);
        CAPTURE(quality_factor, slope, shape == DriveShape::piston, gain);
        CHECK(higher.gain == Approx(gain).epsilon(0.05).margin(2e-4));
      }
    }
  }
}

TEST_CASE("the error of the model mode lies inside its bound on random clamped plates", "[physics]") {
  Draw draw(20260103);
  int compared = 0;
  for (int i = 0; i < 150; ++i) {
    Surface s = aluminium_plate();
    if (draw.next() % 3 == 0) s.tension_Pa = draw.between(0, 1e8);
    s.quality_factor = draw.next() % 4 == 0 ? std::numeric_limits<double>::infinity() : draw.spread(10, 2000);
    s.drive = draw.next() % 5 == 0 ? DriveShape::piston : DriveShape::cosine;
    const double cut = cut_off_half_width_m(s, frequency_Hz), d = draw.spread(0.01, 0.3);
    const double ratio = draw.between(1.1, 3.5);
    s.taper = LinearTaper{ratio * cut, d};
    s.length_m = (ratio - draw.between(0.2, 0.8)) * cut / d;
    const auto truth = make_centre_line(s, frequency_Hz, Model::modes);
    for (const Normalise normalise : {Normalise::peak, Normalise::drive}) {
      const auto error = true_error(s, Model::mode, *truth, normalise);
      if (!error) continue;
      const RungEstimate bound = estimate(s, request_for(normalise), Model::mode);
      CAPTURE(i, d, ratio, s.quality_factor, s.tension_Pa);
      CHECK(error->amplitude <= bound.amplitude_bound);
      CHECK(error->boundary_m <= bound.boundary_bound_m);
      CHECK(error->level_dB <= bound.level_bound_dB);
      ++compared;
    }
  }
  CHECK(compared > 200);
}

TEST_CASE("at resonances of the second mode on lossless brass, the error lies inside the bound",
          "[physics]") {
  const Surface brass = seed_brass();
  double worst = 0;
  for (int i = 0; i <= 120; ++i) {
    const double f = i == 120 ? 45000 : 20000 + 25000.0 * i / 120;
    const auto truth = make_centre_line(brass, f, Model::modes),
               mode = make_centre_line(brass, f, Model::mode);
    const double unit = mode->value(*mode->last_peak_m()).ln_magnitude();
    const double true_unit = truth->value(*truth->last_peak_m()).ln_magnitude();
    double error = 0, most = 0;
    for (int j = 0; j <= 400; ++j) {
      const double x = brass.length_m * j / 400;
      const double b = std::exp(truth->value(x).ln_magnitude() - true_unit);
      error = std::max(error, std::abs(std::exp(mode->value(x).ln_magnitude() - unit) - b));
      most = std::max(most, b);
    }
    PlanRequest request = request_for(Normalise::peak);
    request.tones[0].frequency_Hz = f;
    CAPTURE(f, error / most);
    CHECK(error / most <= estimate(brass, request, Model::mode).amplitude_bound);
    worst = std::max(worst, error / most);
  }
  CHECK(worst > 0.4);  // negative control: some of the tested errors are large
}

TEST_CASE("the planner's model is inside the tolerance, and the next cheaper model mostly is not",
          "[physics]") {
  Draw draw(20260102);
  const int count = scenes(400);
  int planned = 0, needed = 0, met = 0;
  for (int i = 0; i < count; ++i) {
    const Surface s = random_surface(draw);
    const auto x0 = turning_point_m(s, frequency_Hz);
    if (!x0 || *x0 < 0.02 * s.length_m) continue;
    PlanRequest request = request_for(Normalise::peak);
    request.tolerance.amplitude = draw.spread(0.003, 1);
    const PlanChoice choice = choose_model(s, request);
    CHECK(choice.reason.find(std::string(name(choice.model))) == 0);
    if (!choice.inside) continue;
    ++planned;
    const auto truth = make_centre_line(s, frequency_Hz, Model::modes);
    const auto error = true_error(s, choice.model, *truth, Normalise::peak);
    met += !error || error->amplitude <= *request.tolerance.amplitude ? 1 : 0;
    // the smallest true error among the cheaper models that the planner rejected
    double best = std::numeric_limits<double>::infinity();
    for (const RungEstimate& rung : choice.considered) {
      if (rung.cost_s >= choice.bound.cost_s || !rung.usable) continue;
      const auto cheaper = true_error(s, rung.model, *truth, Normalise::peak);
      if (cheaper) best = std::min(best, cheaper->amplitude);
    }
    needed += best > *request.tolerance.amplitude ? 1 : 0;
  }
  CAPTURE(planned, met, needed);
  if (count > 400)
    WARN(planned << " planned, " << met << " inside the tolerance, " << needed << " needed the dearer rung");
  CHECK(planned > 5 * count / 8);
  CHECK(met == planned);
  CHECK(needed > planned / 2);
}

TEST_CASE("if only positions are needed, the planner chooses the closed form, also with loss", "[physics]") {
  Surface s = seed_brass();
  PlanRequest request;
  request.tones = {Tone{20e3, 1, 0}};
  request.edge = Edge::percent(0.5);
  request.tolerance.boundary_m = 0.5e-3;
  CHECK(choose_model(s, request).model == Model::edge);
  s.quality_factor = 8;
  const PlanChoice lossy = choose_model(s, request);
  CHECK(lossy.model == Model::edge);
  const double f = 20e3, truth = make_centre_line(s, f, Model::modes)->level_m(0.5).value();
  CHECK(std::abs(BoundaryMap(s, {request.edge, {}, {}, {}}).boundary_m(f).value() - truth) <
        lossy.bound.boundary_bound_m);
  request.tolerance.boundary_m = 1e-12;
  CHECK_FALSE(choose_model(s, request).inside);
}

TEST_CASE("where the two-dimensional field cannot be solved, the choice is mode, and is not inside",
          "[physics]") {
  Surface wide = seed_brass();
  const double cut = cut_off_half_width_m(wide, frequency_Hz);
  wide.taper = LinearTaper{80 * cut, 0.5};
  wide.length_m = 155 * cut;
  wide.quality_factor = 50;
  Surface piston = turnpoint::physics_test::tapered_plate(PlateTheory::mindlin);
  piston.drive = DriveShape::piston;
  for (const Surface& s : {wide, piston}) {
    for (const int tones : {1, 2}) {
      PlanRequest request = request_for(Normalise::drive);
      if (tones == 2) request.tones.push_back({1.01 * frequency_Hz, 1, 0});
      // what would be assumed of `modes` before it is solved meets most of these tolerances
      for (const double tolerance : {1.0, 0.3, 0.1, 0.03, 0.01, 3e-3}) {
        request.tolerance.amplitude = tolerance;
        const PlanChoice choice = choose_model(s, request);
        CHECK(choice.model == Model::mode);
        CHECK_NOTHROW(evaluate(s, request.tones, linspace_points(s, 3), choice.model, request.normalise));
      }
      request.tolerance.amplitude = 1e-4;
      const PlanChoice choice = choose_model(s, request);
      CHECK(choice.model == Model::mode);
      CHECK_FALSE(choice.inside);
      CHECK(choice.bound.model == Model::mode);
      CHECK(choice.bound.amplitude_bound > 1e-4);
      CHECK_FALSE(std::ranges::find(choice.considered, Model::modes, &RungEstimate::model)->usable);
      REQUIRE(choice.solved.size() == request.tones.size());
      const auto x = linspace_points(s, 20);
      const auto given = evaluate(s, request.tones, x, choice.model, request.normalise, choice.solved),
                 again = evaluate(s, request.tones, x, choice.model, request.normalise);
      CHECK(given.amplitude == again.amplitude);
    }
  }
}

TEST_CASE("what a choice has solved is the field whose error it bounds", "[physics]") {
  Draw draw(20311130);
  int solved = 0, by_modes = 0;
  for (int i = 0; i < 40; ++i) {
    const Surface s = i % 2 == 0 ? turnpoint::physics_test::random_membrane(draw)
                                 : turnpoint::physics_test::random_thin_plate(draw);
    PlanRequest request = request_for(Normalise::peak);
    request.tolerance.amplitude = draw.spread(1e-4, 0.3);
    const PlanChoice choice = choose_model(s, request);
    CHECK(choice.bound.model == choice.model);
    if (choice.solved.empty()) continue;
    const auto x = linspace_points(s, 50);
    const auto given = evaluate(s, request.tones, x, choice.model, request.normalise, choice.solved),
               again = evaluate(s, request.tones, x, choice.model, request.normalise);
    CHECK(given.amplitude == again.amplitude);
    ++solved, by_modes += choice.model == Model::modes;
  }
  CHECK(solved > 15);
  CHECK(by_modes > 5);
}

namespace {

// A clamped plate with straight sides, on which only the first mode propagates.
Surface usual_plate(Draw& draw, PlateTheory theory) {
  Surface s = aluminium_plate();
  s.theory = theory;
  s.poisson = draw.between(0.1, 0.45);
  s.thickness_m = draw.spread(0.5e-3, 6e-3);
  s.quality_factor = draw.next() % 4 == 0 ? std::numeric_limits<double>::infinity() : draw.spread(5, 500);
  const double cut = cut_off_half_width_m(s, frequency_Hz), d = draw.spread(0.01, 0.3);
  const double ratio = draw.between(1.15, 2.2);
  s.taper = LinearTaper{ratio * cut, d};
  s.length_m = (ratio - draw.between(0.1, 0.8)) * cut / d;
  return s;
}

struct Kind {
  const char* name;
  int scenes;
  Surface (*make)(Draw&);
};
const Kind kinds[] = {
    {"membrane", 40, turnpoint::physics_test::random_membrane},
    {"thin plate", 20, turnpoint::physics_test::random_thin_plate},
    {"thick plate", 4, turnpoint::physics_test::random_thick_plate},
    {"straight thin plate", 20, [](Draw& draw) { return usual_plate(draw, PlateTheory::kirchhoff); }},
    {"straight thick plate", 6, [](Draw& draw) { return usual_plate(draw, PlateTheory::mindlin); }}};

// The surfaces of a kind whose first mode turns on them, from the number TURNPOINT_FIRST_SCENE on.
template <class Work>
void for_scenes(const Kind& kind, std::uint64_t seed, Work work) {
  const int count = scenes(kind.scenes), first = turnpoint::physics_test::first_scene();
  for (int i = first; i < first + count; ++i) {
    Draw draw(seed + static_cast<std::uint64_t>(i));
    const Surface s = kind.make(draw);
    const auto x0 = turning_point_m(s, frequency_Hz);
    if (x0 && *x0 >= 0.02 * s.length_m) work(i, s, draw);
  }
}

}  // namespace

// With much loss `mode` may have no last maximum where the two-dimensional field has one, and so no edge.
TEST_CASE("without a last maximum, the bounds of mode say nothing of an edge, and mode is not presented",
          "[physics]") {
  int without = 0, only_modes = 0;
  for (const Kind& kind : kinds) {
    for_scenes(kind, 20261127, [&](int i, const Surface& s, Draw&) {
      if (s.theory != PlateTheory::kirchhoff || make_centre_line(s, frequency_Hz, Model::mode)->last_peak_m())
        return;
      ++without;
      only_modes += make_centre_line(s, frequency_Hz, Model::modes)->last_peak_m().has_value();
      PlanRequest request;
      request.tones = {Tone{frequency_Hz, 1, 0}};
      request.points = 100;
      request.edge = Edge::percent(0.5);
      request.tolerance.boundary_m = 1e-3;
      CAPTURE(kind.name, i, s.taper.index(), s.quality_factor);
      CHECK(estimate(s, request, Model::mode).boundary_bound_m >= s.length_m);
      CHECK(choose_model(s, request).model == Model::modes);
    });
  }
  CHECK(without >= 5);
  CHECK(only_modes > 0);
}

TEST_CASE("the last maximum and edges from 90 to 1 % of it lie inside the bounds of mode", "[physics]") {
  for (const Kind& kind : kinds) {
    int compared = 0, shallow = 0, closer = 0;
    double worst = 0;
    for_scenes(kind, 20300000, [&](int i, const Surface& s, Draw&) {
      const auto truth = make_centre_line(s, frequency_Hz, Model::modes),
                 mode = make_centre_line(s, frequency_Hz, Model::mode);
      for (const Edge& edge :
           {Edge::peak(), Edge::percent(0.9), Edge::percent(0.5), Edge::percent(0.1), Edge::percent(0.01)}) {
        const auto at = [&](const CentreLine& line) {
          const auto x = edge.kind == Edge::Kind::peak ? line.last_peak_m() : line.level_m(edge.level);
          return x && *x < s.length_m * (1 - 1e-9) ? x : std::nullopt;
        };
        const auto one = at(*mode), other = at(*truth);
        if (!one || !other) continue;
        PlanRequest request;
        request.tones = {Tone{frequency_Hz, 1, 0}};
        request.points = 100;
        request.edge = edge;
        const double error = std::abs(*one - *other), own = 2e-5 * cut_off_half_width_m(s, frequency_Hz);
        // the bound that is known before any comparison, and that of a comparison, which a tolerance just
        // below the first asks for
        for (const bool compare : {false, true}) {
          const auto considered = choose_model(s, request).considered;
          const auto bound =
              std::ranges::find(considered, Model::mode, &RungEstimate::model)->boundary_bound_m;
          CAPTURE(kind.name, i, format(edge), error, compare, bound, s.taper.index(), s.quality_factor);
          CHECK(error <= bound + own);
          ++compared, shallow += bound >= s.length_m;
          worst = std::max(worst, (error - own) / bound);
          if (compare) closer += bound < 0.9 * *request.tolerance.boundary_m;
          request.tolerance.boundary_m = 0.9 * bound;
          request.coarsest = Model::mode;
        }
      }
    });
    if (scenes(kind.scenes) > kind.scenes)
      WARN(kind.name << ": " << compared << " edges, " << shallow << " without a bound, " << closer
                     << " with a closer one by comparison; largest error / bound " << worst);
    CHECK(compared > kind.scenes);
    CHECK(closer > 0);
  }
}

TEST_CASE("the bounds of mode that a choice states hold, and mode is taken on most plates where it suffices",
          "[physics]") {
  for (const Kind& kind : kinds) {
    int compared = 0, suffices = 0, taken = 0;
    double worst = 0;
    std::vector<double> ratios;
    for_scenes(kind, 20310000, [&](int i, const Surface& s, Draw& draw) {
      const Normalise normalise = draw.next() % 2 == 0 ? Normalise::peak : Normalise::drive;
      PlanRequest request = request_for(normalise);
      request.tolerance.level_dB = draw.spread(0.02, 1);
      const auto choice = choose_model(s, request);
      const auto truth = make_centre_line(s, frequency_Hz, Model::modes);
      const auto error = true_error(s, Model::mode, *truth, normalise);
      if (!error) return;
      const auto& bound = *std::ranges::find(choice.considered, Model::mode, &RungEstimate::model);
      ++compared;
      suffices += error->level_dB <= *request.tolerance.level_dB;
      taken += choice.model == Model::mode;
      // the errors of `modes` itself are far below these slacks
      const double amplitude = std::max(0.0, error->amplitude - 1e-4),
                   level_dB = std::max(0.0, error->level_dB - 1e-3);
      ratios.push_back(bound.level_bound_dB / error->level_dB);
      worst = std::max({worst, amplitude / bound.amplitude_bound, level_dB / bound.level_bound_dB});
      CAPTURE(kind.name, i, amplitude, bound.amplitude_bound, level_dB, bound.level_bound_dB, choice.reason);
      CHECK(amplitude <= bound.amplitude_bound);
      CHECK(level_dB <= bound.level_bound_dB);
    });
    if (scenes(kind.scenes) > kind.scenes)
      WARN(kind.name << ": " << compared << " compared; largest error / bound " << worst
                     << ", median of bound / error of the level " << turnpoint::physics_test::median(ratios)
                     << "; mode suffices in " << suffices << " and is taken in " << taken);
    CHECK(compared > kind.scenes / 2);
    CHECK(taken <= suffices);  // a bound holds, so no scene is given a model that does not suffice
  }
}
