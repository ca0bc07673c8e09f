#include <cmath>
#include <numbers>

#include "physics/dispersion.hpp"
#include "physics/edge.hpp"
#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/taper.hpp"
#include "physics/warning.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using std::numbers::pi;

TEST_CASE("the brass membrane of the 1998 paper has the published wave speed and cut-off", "[physics]") {
  const Surface s = seed_brass();
  CHECK(wave_speed_m_s(s) == Approx(794.556).epsilon(1e-6));
  CHECK(cut_off_frequency_Hz(s, 0.03) == Approx(6621.30).epsilon(1e-6));
  CHECK_FALSE(bending_modelled(s));
}

TEST_CASE(
    "the clamped cut-off solves its equation to rounding, and approaches those of a plate and of a membrane",
    "[physics]") {
  Surface s = aluminium_plate();
  const double stiffness = bending_stiffness_N_m(s).value();
  CHECK(wavenumber_per_m(s, cut_off_frequency_Hz(s, 0.009)) * 0.009 ==
        Approx(2.3650203724313520).epsilon(1e-13));
  for (const double tension : {1e3, 1e6, 1e8, 1e10}) {
    s.tension_Pa = tension;
    s.bending = Bending::on;
    for (const double w : {0.014, 0.009, 0.003}) {
      const double f = cut_off_frequency_Hz(s, w);
      const double k = wavenumber_per_m(s, f);
      const double k2 = std::sqrt(k * k + line_tension_N_per_m(s) / stiffness);
      CAPTURE(tension, w, k * w);
      // k sin(k W) + k2 tanh(k2 W) cos(k W), the left side of the cut-off equation, must be 0 relative to its
      // terms.
      CHECK(std::abs(k * std::sin(k * w) + k2 * std::tanh(k2 * w) * std::cos(k * w)) < 1e-12 * (k + k2));
      CHECK(cut_off_half_width_m(s, f) == Approx(w).epsilon(1e-12));
    }
  }
  // For small bending stiffness D and tension per width N, the effective half-width is smaller by the
  // boundary layer sqrt(D/N).
  s.tension_Pa = 1e12;
  const double layer = std::sqrt(stiffness / line_tension_N_per_m(s));
  const double k = wavenumber_per_m(s, cut_off_frequency_Hz(s, 0.014));
  CHECK(pi / (2 * k) == Approx(0.014 - layer).epsilon(1e-5));
  // Negative control: without the boundary layer the check above would fail.
  CHECK(std::abs(pi / (2 * k) - 0.014) > 0.5 * layer);
}

TEST_CASE("bending is modelled if it moves a cut-off, and can be switched on and off", "[physics]") {
  Surface s = seed_brass();
  s.modulus_Pa = 100e9;
  s.poisson = 0.34;
  CHECK_FALSE(bending_modelled(s));  // bending moves the cut-off by only 0.1 % at the narrow end
  s.tension_Pa = 100e6;
  CHECK(bending_modelled(s));
  s.bending = Bending::off;
  CHECK_FALSE(bending_modelled(s));
  const Tone tone{45e3, 1e-6, 0};
  bool warned = false;
  for (const Warning& one : tone_warnings(s, {&tone, 1})) warned = warned || one.code == "bending-off";
  CHECK(warned);
}

TEST_CASE("wavenumber and frequency convert into each other without loss of accuracy", "[physics]") {
  Surface s = aluminium_plate();
  for (const double f : {5e3, 22.4e3, 90e3}) {
    CHECK(frequency_for_wavenumber_Hz(s, wavenumber_per_m(s, f)) == Approx(f).epsilon(1e-14));
  }
}

TEST_CASE("a tabulated taper with points on a straight line equals the linear taper", "[physics]") {
  Surface line = seed_brass(), table = line;
  table.taper = TabulatedTaper{{{0, 0.03}, {0.07, 0.023}, {0.2, 0.01}, {0.3, 1e-9}}};
  const Taper a(line), b(table);
  for (double x = 0; x <= 0.3; x += 0.013) {
    CHECK(b.half_width_m(x) == Approx(a.half_width_m(x)).margin(1e-9));
    CHECK(b.slope(x) == Approx(-0.1).epsilon(1e-6));
  }
  CHECK(b.position_m(0.0151234).value() == Approx(0.148766).epsilon(1e-7));
}

TEST_CASE("impossible surfaces are refused, and the message names the quantity", "[physics]") {
  const auto refused = [](auto change, const char* word) {
    Surface s = seed_brass();
    change(s);
    try {
      validate(s);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).find(word) != std::string::npos;
    }
    return false;
  };
  CHECK(refused([](Surface& s) { s.length_m = 0.31; }, "length_m"));
  CHECK(refused([](Surface& s) { s.quality_factor = 0; }, "quality_factor"));
  CHECK(refused([](Surface& s) { s.quality_factor = std::nan(""); }, "quality_factor"));
  CHECK(refused([](Surface& s) { s.tension_Pa = 0; }, "modulus_Pa"));
  CHECK(refused([](Surface& s) { s.taper = TabulatedTaper{{{0, 0.03}, {0.1, 0.03}}}; }, "half_width_m"));
  CHECK(refused([](Surface& s) { s.taper = LinearTaper{0.03, -0.1}; }, "slope"));
  CHECK_NOTHROW(validate(seed_brass()));
}

TEST_CASE("the text that is written for an edge or a model is read back as the same one", "[physics]") {
  for (const char* text : {"turning", "peak", "p70", "p05", "friction=0.8"})
    CHECK(format(parse_edge(text)) == text);
  for (const char* text : {"", "p5", "p00", "p123", "friction=1", "friction=x", "middle"}) {
    CHECK_THROWS_AS(parse_edge(text), std::invalid_argument);
  }
  for (const Model model : all_models) CHECK(parse_model(name(model)) == model);
  CHECK_THROWS_AS(parse_model("fem"), std::invalid_argument);
}

TEST_CASE("a tension above the yield strength causes a warning", "[physics]") {
  Surface s = seed_brass();
  CHECK(surface_warnings(s).empty());
  s.yield_strength_Pa = find_material("brass")->yield_strength_Pa;
  REQUIRE(surface_warnings(s).size() == 1);
  CHECK(surface_warnings(s)[0].code == "yield");
}
