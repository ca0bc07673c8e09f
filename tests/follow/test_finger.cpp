#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "station/follow/finger.hpp"
#include "tests/follow/plant.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::follow;

namespace {

constexpr double kSpan_m = 0.3, kRatioPerN = 0.08;
constexpr int kChannels = 6;
constexpr std::array kDrive_Hz{20300.0, 33170.0};

Bridges wiring() {
  Bridges b;
  b.channels = kChannels;
  b.reference = 1, b.bridges = {2, 4, 5};
  b.rotation_rad = {0.3, -0.2, 0.1};
  b.tare = {0.01, -0.02, 0.005};
  // N = a + b, T = lateral, M = span b; ratios are kRatioPerN per newton
  b.matrix = {{{1 / kRatioPerN, 0, 0}, {1 / kRatioPerN, 0, kSpan_m / kRatioPerN}, {0, 1 / kRatioPerN, 0}}};
  return b;
}

/// What the converter captures of forces a, b and lateral, with drive tones as crosstalk and noise.
struct Signal {
  double crosstalk = 0, noise = 0, reference = 0.5;
  plant::Dice dice{5};

  std::vector<std::int32_t> frames(std::int64_t first, int count, auto forces) {
    std::vector<std::int32_t> out(static_cast<std::size_t>(count * kChannels));
    const auto b = wiring();
    for (int i = 0; i < count; ++i) {
      const double n = static_cast<double>(first + i), t = n / 192000, w = 2 * std::numbers::pi;
      const auto f = forces(t);
      const double drive = std::sin(w * 20300 * t) + std::sin(w * 33170 * t + 1);
      const auto put = [&](int c, double x) {
        out[static_cast<std::size_t>(i * kChannels + c)] =
            static_cast<std::int32_t>(std::lround((x + noise * dice.bell()) * 0x1p31));
      };
      put(1, reference * std::cos(w * 10525 * t + 0.4));
      for (std::size_t k = 0; k < 3; ++k)
        put(b.bridges[k],
            reference * (kRatioPerN * f[k] + b.tare[k]) * std::cos(w * 10525 * t + 0.4 + b.rotation_rad[k]) +
                crosstalk * drive);
    }
    return out;
  }
};

using Forces = std::array<double, 3>;

}  // namespace

TEST_CASE("forces come from the captured frames, half a window late and not disturbed by the drive",
          "[finger]") {
  BridgeWindow window(wiring(), {}, kDrive_Hz);
  Signal signal;
  signal.crosstalk = 0.1;
  // forces that change in a straight line: the sample is that of the window's centre
  const auto forces = [](double t) { return Forces{0.3 + 2 * t, 0.2 + t, -0.1 + 3 * t}; };
  for (int p = 0; p < 12; ++p) window.push(p * 96, signal.frames(p * 96, 96, forces).data(), 96);
  const auto sample = window.sample();
  CHECK(sample.fault == Fault::none);
  CHECK(sample.frame == 12 * 96 - 144);
  const auto f = forces((static_cast<double>(sample.frame) - 0.5) / 192000);
  // 0.1 of full scale at 20 and 33 kHz is 2.5 N of a bridge; what leaks in is below a millinewton
  CHECK(sample.normal_N == Approx(f[0] + f[1]).margin(1e-3));
  CHECK(sample.lateral_N == Approx(f[2]).margin(1e-3));
  CHECK(sample.moment_Nm == Approx(kSpan_m * f[1]).margin(0.3e-3));
}

TEST_CASE("blocks of any size give the same forces", "[finger]") {
  const auto forces = [](double t) { return Forces{0.3, 0.2 + 5 * t, 0.1}; };
  Signal signal;
  const auto all = signal.frames(0, 960, forces);
  BridgeWindow one(wiring(), {}, kDrive_Hz), many(wiring(), {}, kDrive_Hz);
  one.push(0, all.data(), 960);
  for (int at = 0, size = 1; at < 960; at += size, size = size % 37 + 1)
    many.push(at, all.data() + static_cast<std::ptrdiff_t>(at) * kChannels, std::min(size, 960 - at));
  CHECK(one.sample().moment_Nm == Approx(many.sample().moment_Nm).epsilon(1e-5));
  CHECK(one.sample().frame == many.sample().frame);
}

TEST_CASE("faults of the captured signal are named", "[finger]") {
  const auto forces = [](double) { return Forces{0.3, 0.2, 0.1}; };
  Signal signal;
  signal.noise = 1e-5;
  BridgeWindow window(wiring(), {}, kDrive_Hz);
  window.push(0, signal.frames(0, 200, forces).data(), 200);
  CHECK(window.sample().fault == Fault::force);  // not full yet
  window.push(200, signal.frames(200, 200, forces).data(), 200);
  CHECK(window.sample().fault == Fault::none);
  SECTION("frames that are missing") {
    window.push(500, signal.frames(500, 96, forces).data(), 96);
    CHECK(window.sample().fault == Fault::force);
    window.push(596, signal.frames(596, 192, forces).data(), 192);
    CHECK(window.sample().fault == Fault::none);
  }
  SECTION("no reference") {
    signal.reference = 0.48;
    window.push(400, signal.frames(400, 288, forces).data(), 288);
    CHECK(window.sample().fault == Fault::reference);
  }
  SECTION("an open bridge") {
    window.push(400, signal.frames(400, 288, [](double) { return Forces{9, 0.2, 0.1}; }).data(), 288);
    CHECK(window.sample().fault == Fault::force);
  }
  SECTION("a converter that no longer moves") {
    auto frames = signal.frames(400, 96, forces);
    for (int i = 60; i < 96; ++i) frames[static_cast<std::size_t>(i * kChannels + 4)] = 1234567;
    window.push(400, frames.data(), 96);
    CHECK(window.sample().fault == Fault::force);
  }
  SECTION("a converter that stood still, anywhere in the window") {
    auto frames = signal.frames(400, 500, forces);
    for (int i = 0; i < 60; ++i) frames[static_cast<std::size_t>(i * kChannels + 4)] = 1234567;
    for (int at = 0; at < 400; at += 4) {
      window.push(400 + at, frames.data() + static_cast<std::ptrdiff_t>(at) * kChannels, 4);
      // from the 33rd equal sample until the last of them has left the window of 288 frames
      const bool dead = at + 4 >= 33 && at + 4 < 60 + 288;
      CHECK((window.sample().fault == Fault::force) == dead);
    }
  }
  SECTION("a driver that gives the same block again") {
    for (const int block : {96, 16}) {
      const int at = block == 96 ? 400 : 1200;
      window.push(at - 300, signal.frames(at - 300, 300, forces).data(), 300);
      const auto frames = signal.frames(at, block, forces);
      for (int k = 0; k < 6; ++k) window.push(at + k * block, frames.data(), block);
      CHECK(window.sample().fault == Fault::force);
    }
  }
  SECTION("a wire that is off: the bridge's phase has changed") {
    auto turned = wiring();
    turned.rotation_rad[1] += 0.2;
    turned.full_scale[1] = 0.05;
    BridgeWindow other(turned, {}, kDrive_Hz);
    other.push(0, signal.frames(0, 288, forces).data(), 288);
    CHECK(other.sample().fault == Fault::none);
    turned.rotation_rad[1] += 1.2;
    other = BridgeWindow(turned, {}, kDrive_Hz);
    other.push(0, signal.frames(0, 288, [](double) { return Forces{0.3, 0.5, 0.1}; }).data(), 288);
    CHECK(other.sample().fault == Fault::force);
  }
}

TEST_CASE("a window that cannot work is refused", "[finger]") {
  auto b = wiring();
  Timing timing;
  timing.window_frames = 16;
  CHECK_THROWS_AS(BridgeWindow(b, timing, {}), std::invalid_argument);
  b = wiring(), b.bridges[2] = 6;
  CHECK_THROWS_AS(BridgeWindow(b, {}, {}), std::invalid_argument);
  b = wiring(), b.carrier_Hz = 2000;
  CHECK_THROWS_AS(BridgeWindow(b, {}, {}), std::invalid_argument);
  // 10.525 kHz and a window of 1.5 ms: 2.67 kHz are needed
  CHECK_THROWS_AS(BridgeWindow(wiring(), {}, std::array{30000.0, 13000.0}), std::invalid_argument);
  CHECK_NOTHROW(BridgeWindow(wiring(), {}, std::array{30000.0, 13200.0}));
}

TEST_CASE("window and period are as long at every rate", "[finger]") {
  for (const int rate : {44100, 48000, 96000, 192000, 384000}) {
    const auto timing = timing_of(rate);
    CHECK(timing.rate_Hz == rate);
    CHECK(timing.window_frames / static_cast<double>(rate) == Approx(1.5e-3).epsilon(0.02));
    CHECK(timing.period_frames % 8 == 0);
    CHECK(timing.period_frames / static_cast<double>(rate) == Approx(0.5e-3).epsilon(0.1));
  }
  CHECK(timing_of(192000).window_frames == Timing{}.window_frames);
  CHECK(timing_of(192000).period_frames == Timing{}.period_frames);
  CHECK_THROWS_AS(timing_of(8000), std::invalid_argument);
}

namespace {

/// Errors of the place (m) that is predicted `ahead_s` from the sample, for a finger that moves as `place`.
struct Errors {
  double mean = 0, sd = 0;  ///< in the direction of movement
};
Errors errors(auto place, double normal_N, double noise_N, double from_s, double to_s, double ahead_s) {
  EstimatorSettings settings;
  settings.first_m = 0, settings.last_m = 0.2;
  settings.skin_m_per_N = 0;
  FingerEstimator estimator(settings);
  plant::Dice dice(11);
  // noise of the cells at 16 kHz, and the window's weights over 24 of these steps
  std::vector<double> weight(24), a(24), b(24);
  double sum = 0, square = 0, mean = 0, count = 0, squares = 0;
  for (std::size_t i = 0; i < 24; ++i) {
    const double w = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / 24);
    weight[i] = w * w * w * w, sum += weight[i];
  }
  for (double& w : weight) w /= sum, square += w * w;
  for (int k = 0; k * 0.5e-3 < to_s; ++k) {
    for (int i = 0; i < 8; ++i) {
      a.erase(a.begin()), b.erase(b.begin());
      a.push_back(noise_N / std::sqrt(square) * dice.bell()),
          b.push_back(noise_N / std::sqrt(square) * dice.bell());
    }
    const double t = k * 0.5e-3;
    FingerSample sample;
    sample.frame = static_cast<std::int64_t>(k) * 96;
    const double share = place(t) / kSpan_m;
    double na = normal_N * (1 - share), nb = normal_N * share;
    for (std::size_t i = 0; i < 24; ++i) na += weight[i] * a[i], nb += weight[i] * b[i];
    sample.normal_N = na + nb, sample.moment_Nm = kSpan_m * nb;
    estimator.push(sample);
    if (t < from_s) continue;
    const double truth = place(t + ahead_s), way = place(t + 1e-4) > place(t) ? 1 : -1;
    const double error =
        way * (estimator.place_at(static_cast<double>(sample.frame) + ahead_s * 192000) - truth);
    mean += error, squares += error * error, count += 1;
  }
  mean /= count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

constexpr double kAhead_s = 2.6e-3;  // window, buffer, a period, cells and film

}  // namespace

TEST_CASE("the place has no lag at constant speed and little noise", "[finger]") {
  const auto steady = [](double t) { return 0.02 + 0.1 * t; };
  for (const double normal : {0.2, 0.5, 1.0}) {
    const auto e = errors(steady, normal, 0.4e-3, 0.2, 1.5, kAhead_s);
    const auto now = errors(steady, normal, 0.4e-3, 0.2, 1.5, 0);
    UNSCOPED_INFO(normal << " N: lag " << -1e3 * e.mean << " mm, noise " << 1e3 * now.sd << " mm, predicted "
                         << 1e3 * e.sd << " mm");
    CHECK(std::abs(e.mean) < 0.1e-3);
    CHECK(now.sd < 0.3e-3);
    CHECK(e.sd < 0.3e-3);
  }
}

TEST_CASE("an acceleration of 2 m/s2 lags less than 0.2 mm", "[finger]") {
  // from -0.2 to 0.2 m/s: 10 cm to and fro
  for (const double sign : {1.0, -1.0}) {
    const auto turning = [sign](double t) { return 0.1 + sign * (-0.25 * t + t * t); };
    const auto e = errors(turning, 0.5, 0, 0.15, 0.25, kAhead_s);
    const auto noisy = errors(turning, 0.5, 0.4e-3, 0.15, 0.25, kAhead_s);
    CAPTURE(e.mean, e.sd, noisy.mean);
    CHECK(std::abs(e.mean) < 0.2e-3);
    CHECK(std::abs(e.mean) + e.sd < 0.2e-3);
    CHECK(std::abs(noisy.mean) < 0.2e-3);
    // a light finger is filtered more: the page says 0.27 mm at 0.2 N
    const auto light = errors(turning, 0.2, 0, 0.15, 0.25, kAhead_s);
    UNSCOPED_INFO("lag at 0.5 N " << 1e3 * e.mean << " mm, at 0.2 N " << 1e3 * light.mean << " mm");
    CHECK(std::abs(light.mean) < 0.3e-3);
  }
}

TEST_CASE("a finger that is lifted, too light, beyond the strip or elsewhere is named", "[finger]") {
  EstimatorSettings settings;
  settings.first_m = 0, settings.last_m = 0.2;
  FingerEstimator estimator(settings);
  std::int64_t frame = 0;
  const auto push = [&](double normal, double place, int times = 1, Fault fault = Fault::none) {
    for (int i = 0; i < times; ++i) estimator.push({frame += 96, normal, 0, normal * place, fault});
    return estimator.finger().fault;
  };
  CHECK(push(0.01, 0.1) == Fault::lifted);
  CHECK(push(0.5, 0.1, 5) == Fault::none);
  CHECK(push(0.06, 0.1) == Fault::position);
  CHECK(push(0.02, 0.1) == Fault::lifted);
  CHECK(push(0.04, 0.1) == Fault::lifted);  // contact needs more force than its end
  CHECK(push(0.5, 0.1, 5) == Fault::none);
  CHECK(push(0.5, 0.15) == Fault::position);  // 5 cm in half a millisecond
  CHECK(push(0.5, 0.1) == Fault::none);
  CHECK(push(0.5, 0.15, 20) == Fault::none);  // it stays there, so it is there
  CHECK(estimator.finger().place_m == Approx(0.15).margin(1e-3));
  CHECK(push(0.5, 0.21, 20) == Fault::position);
  CHECK(push(0.5, 0.1, 20) == Fault::none);
  CHECK(push(0.5, 0.1, 1, Fault::reference) == Fault::reference);
  CHECK(push(0.5, NAN) == Fault::force);
  CHECK(push(0.5, 0.1) == Fault::none);
}
