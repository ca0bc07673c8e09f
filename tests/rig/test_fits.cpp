#include <cmath>
#include <complex>
#include <random>
#include <string>

#include "station/core/usage_error.hpp"
#include "station/rig/fits.hpp"
#include "station/rig/physical.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::rig;

namespace {

// Returns the measured response of a resonator: its amplitude |u| at `count` frequencies, multiplied by a
// constant.
std::vector<ResponsePoint> resonator(double f0_Hz, double q, double from_Hz, double to_Hz, int count) {
  std::vector<ResponsePoint> sweep;
  for (int k = 0; k < count; ++k) {
    const double f = from_Hz + (to_Hz - from_Hz) * k / (count - 1);
    const std::complex<double> h = 1e-8 / std::complex<double>(1 - f * f / (f0_Hz * f0_Hz), f / (f0_Hz * q));
    sweep.push_back({f, std::abs(h), std::arg(h)});
  }
  return sweep;
}

}  // namespace

TEST_CASE("frequency and Q of a resonance come from its width", "[calibration]") {
  for (const double q : {20.0, 60.0, 300.0}) {
    const double f0 = 28000;
    const auto found = find_resonances(resonator(f0, q, f0 * (1 - 3 / q), f0 * (1 + 3 / q), 61));
    REQUIRE(found.size() == 1);
    CHECK(found[0].frequency_Hz == Approx(f0).epsilon(0.3 / q));
    CHECK(found[0].quality_factor == Approx(q).epsilon(0.05));
  }
  CHECK_FALSE(quality_of(find_resonances(resonator(28000, 500, 20000, 40000, 41)))
                  .has_value());  // the sweep is too coarse for this resonance
}

TEST_CASE("a hump at which the phase does not turn is not a resonance", "[calibration]") {
  auto sweep = resonator(28000, 20, 24000, 32000, 61);
  REQUIRE(find_resonances(sweep).size() == 1);
  for (auto& point : sweep) point.phase_rad = 0.1;
  CHECK(find_resonances(sweep).empty());
}

TEST_CASE("a response is smoothed without bias, and its band ends where equalisation would exceed 20 dB",
          "[calibration]") {
  auto sweep = resonator(30000, 30, 15000, 60000, 181);
  const ResponseFit clean = fit_response(sweep);
  CHECK(clean.residual_dB < 0.1);
  std::mt19937_64 random(3);
  std::normal_distribution<double> error(0, 0.02);
  for (auto& point : sweep) point.m_per_full_scale *= std::exp(error(random));
  const ResponseFit noisy = fit_response(sweep, 9);
  CHECK(noisy.residual_dB < 0.25);
  CHECK(noisy.residual_dB > 0.1);
  double best = 0, at_low = 0;
  for (const auto& point : clean.points) {
    best = std::max(best, point.m_per_full_scale);
    if (point.frequency_Hz == clean.low_Hz) at_low = point.m_per_full_scale;
  }
  CHECK(20 * std::log10(best / at_low) <= 20);
  CHECK(clean.low_Hz > 15000);
  CHECK(clean.high_Hz < 60000);
}

TEST_CASE("where measured friction rises with displacement, neighbouring points become one",
          "[calibration]") {
  const FrictionFit fit = fit_friction({{0, 1.0}, {2e-6, 0.5}, {1e-6, 0.7}, {1.5e-6, 0.74}, {3e-6, 0.2}});
  REQUIRE(fit.points.size() == 4);
  CHECK(fit.points[1].displacement_m == Approx(1.25e-6));
  CHECK(fit.points[1].relative_friction == Approx(0.72));
  CHECK(fit.residual == Approx(std::sqrt(2 * 0.02 * 0.02 / 5)));
}

TEST_CASE("friction that contradicts the curve is named and makes no fit", "[calibration]") {
  const auto said = [](const std::vector<FrictionPoint>& points) -> std::string {
    try {
      static_cast<void>(fit_friction(points));
      return "";
    } catch (const turnpoint::core::UsageError& error) {
      return error.what();
    }
  };
  CHECK(said({{0, 1.0}, {1e-6, 0.2}, {2e-6, 0.9}}).find("0.9 at 2 um") != std::string::npos);
  CHECK(said({{0, 0.5}, {1e-6, 0.2}}).find("0.5 at 0 um") != std::string::npos);
  CHECK(said({{0, 1.0}, {1e-6, 1.0}}).find("fewer than two") != std::string::npos);
  CHECK(said({{0.5e-6, 0.8}, {1e-6, 0.82}}).empty());
}

TEST_CASE("whatever friction was measured, the fit is refused or gives a curve for planning",
          "[calibration]") {
  constexpr int tables = 200;
  std::mt19937_64 random(11);
  const std::vector<double> hostile{0,      -0.0,      1,           1,     0.8,  0.8, 1.5,
                                    1e-300, 1e-12,     1e-13,       1e300, -1,   0.5, 1e-3,
                                    9e-4,   1 - 1e-16, 0.5 + 1e-10, 2e-6,  1e-6, 3e-6};
  const auto any = [&](double scale) {
    if (random() % 4 == 0) return hostile[random() % hostile.size()];
    return scale * std::uniform_real_distribution<double>(0, 1)(random);
  };
  int fitted = 0;
  for (int table = 0; table < tables; ++table) {
    std::vector<FrictionPoint> points{{0, 1}};
    const auto rows = random() % 8;
    for (std::size_t k = 0; k < rows; ++k)
      points.push_back(table % 2 == 0 ? FrictionPoint{any(4e-6), any(1.1)}
                                      : FrictionPoint{1e-6 * static_cast<double>(k),
                                                      1 / (1 + 0.5 * static_cast<double>(k)) + 0.1 * any(1)});
    turnpoint::rig::Rig rig;
    try {
      for (const auto& point : fit_friction(points).points)
        rig.friction.table.emplace_back(point.displacement_m, point.relative_friction);
    } catch (const turnpoint::core::UsageError&) {
      continue;
    }
    ++fitted;
    rig.friction.measured = true;
    const auto curve = turnpoint::rig::friction_of(rig);
    for (const double share : {0.0, 0.3, 1.0}) {
      const double friction = curve.relative_friction(share * curve.highest_displacement_m());
      CHECK((std::isfinite(friction) && friction > 0 && friction <= 1));
    }
  }
  CHECK(fitted > tables / 10);
}
