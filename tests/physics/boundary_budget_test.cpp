#include "physics/boundary_budget.hpp"

#include <cmath>
#include <random>

#include "physics/centre_line.hpp"
#include "physics/edge_feature.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

MapOptions edge(const char* text) {
  MapOptions options;
  options.edge = parse_edge(text);
  options.friction = FrictionContext{};
  return options;
}

double solved_m(const Surface& s, const char* text, double f) {
  return solve_edge_m(s, edge(text), f, Model::edge, Wave::exact).value();
}

// The plate of the simulated rig, with standard deviations for its parameters.
Surface plate() {
  Surface s = aluminium_plate();
  s.expansion_per_K = 23.6e-6;
  s.modulus_per_K = -5.3e-4;
  s.sd.density_kg_m3 = 15;
  s.sd.thickness_m = 0.045e-3;
  s.sd.modulus_Pa = 1e9;
  s.sd.half_width_m = 0.05e-3;
  s.sd.slope = 2e-4;
  s.sd.clamp_line_m = 0.2e-3;
  s.sd.temperature_K = 3;
  return s;
}

Surface membrane(TaperForm taper) {
  Surface s = seed_brass();
  s.quality_factor = 60;
  s.taper = std::move(taper);
  s.expansion_per_K = 20e-6;
  s.sd.density_kg_m3 = 0.01 * s.density_kg_m3;
  s.sd.tension_Pa = 0.02 * s.tension_Pa;
  s.sd.half_width_m = 0.1e-3;
  s.sd.slope = 1e-3;
  s.sd.decay_length_m = 1e-3;
  s.sd.clamp_line_m = 0.2e-3;
  s.sd.temperature_K = 3;
  return s;
}

// Returns the derivative of the edge's position with respect to a parameter, from solutions on two changed
// surfaces.
double solved_derivative(const Surface& s, Parameter p, const char* text, double f) {
  const double step = 0.1 * standard_deviation(s, p);
  return (solved_m(changed(s, p, step), text, f) - solved_m(changed(s, p, -step), text, f)) / (2 * step);
}

void check_derivatives(const Surface& s, const char* text, double f) {
  const double x = solved_m(s, text, f);
  double largest_m = 0;
  for (const Parameter p : parameters(s))
    largest_m = std::max(largest_m, std::abs(standard_deviation(s, p) * solved_derivative(s, p, text, f)));
  for (const Parameter p : parameters(s)) {
    const double sd = standard_deviation(s, p);
    if (!(sd > 0)) continue;
    CAPTURE(text, f, x, name(p));
    CHECK(sd * boundary_derivative(s, p, f, x) ==
          Approx(sd * solved_derivative(s, p, text, f)).margin(0.01 * largest_m));
  }
}

}  // namespace

TEST_CASE("a thin plate's boundary moves as its closed form says", "[physics]") {
  // The boundary is x = W0/d - C (E h^2 / rho)^(1/4) / (d sqrt f). W0 and d are half-width and slope of the
  // taper; E, rho and h are modulus, density and thickness; f is the frequency and C a constant.
  const Surface s = plate();
  for (const double f : {22.4e3, 30e3, 45e3}) {
    const double x = solved_m(s, "turning", f), w = 0.014 - 0.03 * x;
    const auto derivative = [&](Parameter p) { return boundary_derivative(s, p, f, x); };
    CHECK(derivative(Parameter::modulus) == Approx(-w / 0.03 / 4 / 69e9).epsilon(1e-5));
    CHECK(derivative(Parameter::density) == Approx(w / 0.03 / 4 / 2700).epsilon(1e-5));
    CHECK(derivative(Parameter::thickness) == Approx(-w / 0.03 / 2 / 2e-3).epsilon(1e-5));
    CHECK(derivative(Parameter::slope) == Approx(-x / 0.03).epsilon(1e-9));
    CHECK(0.2e-3 * derivative(Parameter::clamp_line) == Approx(6.667e-3).epsilon(1e-3));
    CHECK(derivative(Parameter::half_width) == derivative(Parameter::clamp_line));
    // a change of 10 K moves the boundary mostly by the change of the modulus
    CHECK(10 * derivative(Parameter::temperature) ==
          Approx(10 * (5.3e-4 / 4 - 1.25 * 23.6e-6) * w / 0.03 + 10 * 23.6e-6 * 0.014 / 0.03).epsilon(1e-4));
  }
}

TEST_CASE("a boundary's derivatives are those of solving again on changed surfaces", "[physics]") {
  for (const double f : {24e3, 40e3})
    for (const char* text : {"turning", "peak", "p50", "p10", "friction=0.7"})
      check_derivatives(plate(), text, f);
  TabulatedTaper table{{{0, .03}, {.1, .021}, {.2, .011}, {.3, .004}}};
  for (const TaperForm& taper :
       {TaperForm(LinearTaper{0.03, 0.1}), TaperForm(ExponentialTaper{0.03, 0.1}), TaperForm(table)})
    for (const char* text : {"turning", "p50"}) check_derivatives(membrane(taper), text, 20e3);
  for (const PlateTheory theory : {PlateTheory::mindlin, PlateTheory::elastic}) {
    Surface thick = plate();
    thick.theory = theory;
    check_derivatives(thick, "p50", 30e3);
  }
}

TEST_CASE("the first-order uncertainty agrees with the scatter of random surfaces", "[physics]") {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  for (const Surface& nominal : {plate(), membrane(LinearTaper{0.03, 0.1})}) {
    const double f = 25e3, x = solved_m(nominal, "p50", f);
    constexpr int count = 800;  // standard error of the sampled standard deviation: 2.5 %
    double sum = 0, square = 0;
    for (int i = 0; i < count; ++i) {
      Surface s = nominal;
      for (const Parameter p : parameters(nominal))
        if (const double sd = standard_deviation(nominal, p); sd > 0) s = changed(s, p, sd * normal(random));
      const double moved = solved_m(s, "p50", f) - x;
      sum += moved;
      square += moved * moved;
    }
    const double sampled = std::sqrt((square - sum * sum / count) / (count - 1));
    const double stated = boundary_budget(nominal, f, x).total_m;
    CHECK(stated == Approx(sampled).epsilon(0.08));
    CHECK(std::abs(sum / count) < 0.15 * stated);  // nonlinearity shifts the mean only a little
    CHECK(BoundaryMap(nominal, edge("p50")).at_frequency(f).uncertainty_m == Approx(stated).epsilon(1e-3));
  }
}

TEST_CASE("the first-order uncertainty of thick plates agrees with the scatter of random surfaces",
          "[physics]") {
  // This samples the turning point, whose position takes only microseconds to compute. The tests above
  // compare the derivatives of the edge p50 (the boundary at 50 % of the amplitude).
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  for (const PlateTheory theory : {PlateTheory::mindlin, PlateTheory::elastic}) {
    Surface nominal = plate();
    nominal.theory = theory;
    const double f = 30e3, x = solved_m(nominal, "turning", f);
    constexpr int count = 800;
    double sum = 0, square = 0;
    for (int i = 0; i < count; ++i) {
      Surface s = nominal;
      for (const Parameter p : parameters(nominal))
        s = changed(s, p, standard_deviation(nominal, p) * normal(random));
      const double moved = solved_m(s, "turning", f) - x;
      sum += moved;
      square += moved * moved;
    }
    CHECK(boundary_budget(nominal, f, x).total_m ==
          Approx(std::sqrt((square - sum * sum / count) / (count - 1))).epsilon(0.08));
  }
}

TEST_CASE("the uncertainty of a level agrees with the scatter of random surfaces", "[physics]") {
  std::mt19937_64 random(13);
  std::normal_distribution<double> normal;
  Surface thick = plate(), lossy = plate();
  thick.theory = PlateTheory::mindlin;
  thick.thickness_m = 3e-3;
  lossy.sd = {};
  lossy.sd.quality_factor = 0.2 * lossy.quality_factor;
  Surface fitted = plate();
  fitted.sd.thickness_m = 0.15e-3;
  fitted.sd.modulus_Pa = 7e9;
  fitted.correlations = {{Parameter::modulus, Parameter::thickness, -0.98}};
  int inside = 0, all = 0;
  double most = 0;
  for (const Surface& nominal : {plate(), thick, membrane(LinearTaper{0.03, 0.1}), lossy, fitted}) {
    const bool pair = !nominal.correlations.empty();
    const int inside_before = inside, all_before = all;
    for (const double f : {24e3, 30e3, 38e3}) {
      const auto level_dB = [&](const Surface& s, double x) {
        const auto line = make_centre_line(s, f, Model::mode);
        return 8.685889638 * (line->value(x).ln_magnitude() - line->value(0).ln_magnitude());
      };
      const double x = make_centre_line(nominal, f, Model::mode)->last_peak_m().value();
      const LevelBudget budget = level_budget(nominal, f, x);
      constexpr int count = 400;
      double sum = 0, square = 0;
      for (int i = 0; i < count; ++i) {
        Surface s = nominal;
        double thickness = 0;
        for (const Parameter p : parameters(nominal)) {
          double z = normal(random);
          if (p == Parameter::thickness) thickness = z;
          if (p == Parameter::modulus && pair) z = -0.98 * thickness + std::sqrt(1 - 0.98 * 0.98) * z;
          if (p == Parameter::quality_factor)
            s.quality_factor *= std::exp(z * standard_deviation(nominal, p) / nominal.quality_factor);
          else
            s = changed(s, p, standard_deviation(nominal, p) * z);
        }
        const double moved = level_dB(s, x) - level_dB(nominal, x);
        sum += moved;
        square += moved * moved;
        inside += budget.low_dB <= moved && moved <= budget.high_dB;
        ++all;
      }
      const double sampled = std::sqrt((square - sum * sum / count) / (count - 1));
      CAPTURE(f, x, sampled, budget.total_dB);
      most = std::max(most, std::abs(budget.total_dB / sampled - 1));
      CHECK(budget.total_dB == Approx(sampled).epsilon(0.15));
      for (const auto& part : budget.parts) CHECK(part.level_dB <= budget.parts.front().level_dB);
    }
    CHECK(inside - inside_before > 0.91 * (all - all_before));
  }
  WARN("standard deviations of levels differ by " << 100 * most << " % at most; " << 100.0 * inside / all
                                                  << " % lie inside the intervals");
  CHECK(inside > 0.93 * all);
  CHECK(inside < 0.97 * all);
  // a thick plate's level that hardly varies: the thin plate in its place is left
  Surface steady = thick;
  steady.sd = {};
  steady.sd.thickness_m = 0.005e-3;
  const double x = make_centre_line(steady, 30e3, Model::mode)->last_peak_m().value();
  const auto at = [&](double thicker_m) {
    const auto line = make_centre_line(changed(steady, Parameter::thickness, thicker_m), 30e3, Model::mode);
    return 8.685889638 * (line->value(x).ln_magnitude() - line->value(0).ln_magnitude());
  };
  double mean = 0, square = 0;
  constexpr int draws = 200;
  for (int i = 0; i < draws; ++i) {
    const double moved = at(steady.sd.thickness_m * normal(random)) - at(0);
    mean += moved / draws, square += moved * moved / draws;
  }
  CHECK(level_budget(steady, 30e3, x).total_dB < 1);
  CHECK(level_budget(steady, 30e3, x).total_dB == Approx(std::sqrt(square - mean * mean)).epsilon(0.2));
  Surface known = plate();
  known.sd = {};
  CHECK(level_budget(known, 30e3, 0.1).total_dB == 0);
  CHECK(level_budget(known, 30e3, 0.1).parts.empty());
}

TEST_CASE("the quality factor moves a boundary by less than a twentieth of what the other parameters do",
          "[physics]") {
  Surface thick = plate();
  thick.theory = PlateTheory::mindlin;
  for (const Surface& s : {plate(), thick, membrane(LinearTaper{0.03, 0.1})})
    for (const char* text : {"peak", "p50", "p10", "friction=0.7"}) {
      const double x = solved_m(s, text, 30e3);
      CAPTURE(text, s.quality_factor, x);
      for (const double by : {-0.25, 0.25})
        CHECK(std::abs(solved_m(changed(s, Parameter::quality_factor, by * s.quality_factor), text, 30e3) -
                       x) < 0.05 * boundary_budget(s, 30e3, x).total_m);
    }
}

TEST_CASE("a budget lists first the parameter whose measurement helps most", "[physics]") {
  Surface s = plate();
  const BoundaryBudget budget = boundary_budget(s, 30e3, solved_m(s, "p50", 30e3));
  REQUIRE(budget.contributions.size() == 7);
  CHECK(budget.contributions.front().parameter == Parameter::clamp_line);
  double variance = 0;
  for (const Contribution& c : budget.contributions) variance += c.moved_m * c.moved_m;
  CHECK(budget.total_m == Approx(std::sqrt(variance)));
  // The uncertainty that would be left after measuring the clamp line is the total for a surface whose clamp
  // line is known.
  s.sd.clamp_line_m = 0;
  CHECK(boundary_budget(s, 30e3, solved_m(s, "p50", 30e3)).total_m ==
        Approx(budget.contributions.front().left_m));
  s.sd = {};
  CHECK(boundary_budget(s, 30e3, 0.15).contributions.empty());
  CHECK(boundary_budget(s, 30e3, 0.15).total_m == 0);
}
