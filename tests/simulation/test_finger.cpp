#include "tests/simulation/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::simulation;
namespace physics = turnpoint::physics;

namespace {

constexpr double kStep_s = 1.0 / 8000;

Finger smooth_finger() {
  Finger finger = quiet_setup().finger;
  finger.touches = {{}};
  return finger;
}

struct Stroker {
  explicit Stroker(const Finger& finger) : model(finger, kStep_s, 24, 1) {}
  const FingerState& step(double relative_friction = 1, bool lifted = false) {
    return model.step(24 * steps++, relative_friction, lifted);
  }
  FingerModel model;
  std::int64_t steps = 0;
};

}  // namespace

TEST_CASE("a stroke has minimum jerk", "[plant]") {
  CHECK(minimum_jerk(0) == 0);
  CHECK(minimum_jerk(1) == 1);
  CHECK(minimum_jerk(0.5) == 0.5);
  CHECK(minimum_jerk_speed(0.5) == 1.875);
  // the sixth differences of the position are zero, because it is a polynomial of degree 5
  double difference[8];
  for (int k = 0; k < 8; ++k) difference[k] = minimum_jerk(0.1 + 0.1 * k);
  for (int order = 0; order < 6; ++order)
    for (int k = 0; k + 1 < 8 - order; ++k) difference[k] = difference[k + 1] - difference[k];
  CHECK(std::abs(difference[0]) < 1e-13);
  // speed and acceleration are zero at both ends, so the position changes with the third power of time
  CHECK(minimum_jerk(1e-3) < 1.01e-8);
  CHECK(1 - minimum_jerk(1 - 1e-3) < 1.01e-8);
}

TEST_CASE("the finger strokes to and fro, with the speed that its positions imply", "[plant]") {
  Finger finger = smooth_finger();
  Stroker stroker(finger);
  double before = finger.from_m, lowest = 1, highest = 0, fastest = 0;
  for (int k = 0; k < 8 * 8000; ++k) {
    const double v = stroker.step().speed_m_s;
    const FingerState state = stroker.model.step(24 * stroker.steps++, 1, false);
    if (k > 0) REQUIRE(state.speed_m_s == Approx((state.finger_m - before) / (2 * kStep_s)).margin(1e-4));
    REQUIRE(std::abs(state.speed_m_s - v) < 1e-3);
    before = state.finger_m;
    lowest = std::min(lowest, state.finger_m);
    highest = std::max(highest, state.finger_m);
    fastest = std::max(fastest, std::abs(state.speed_m_s));
  }
  CHECK(lowest == 0.06);
  CHECK(highest == Approx(0.26).epsilon(1e-9));
  CHECK(fastest == Approx(1.875 * 0.2 / 2.5).epsilon(1e-4));
}

TEST_CASE("while the skin slides, lateral force is friction times normal force", "[plant]") {
  Stroker stroker(smooth_finger());
  int forward = 0, back = 0;
  for (int k = 0; k < 45000; ++k) {
    const auto& state = stroker.step();
    if (k < 800 || std::abs(state.speed_m_s) < 0.02) continue;
    if (state.speed_m_s > 0 && state.finger_m > 0.08) {
      REQUIRE(state.lateral_N == Approx(0.8 * 0.5).epsilon(1e-12));
      ++forward;
    } else if (state.speed_m_s < 0 && state.finger_m < 0.24) {
      REQUIRE(state.lateral_N == Approx(-0.8 * 0.5).epsilon(1e-12));
      ++back;
    } else {
      continue;
    }
    // the skin stays behind the finger by T / k (T: lateral force, k: contact stiffness)
    REQUIRE(state.contact_m == Approx(state.finger_m - state.lateral_N / 1000).epsilon(1e-12));
  }
  CHECK(forward > 8000);
  CHECK(back > 8000);
}

TEST_CASE("before the skin slides, it is a spring", "[plant]") {
  Finger finger = smooth_finger();
  finger.contact_N_per_m = 1500;
  Stroker stroker(finger);
  int sticking = 0;
  for (int k = 0; k < 8000; ++k) {
    const auto& state = stroker.step();
    const double spring_N = 1500 * (state.finger_m - finger.from_m);
    if (spring_N > 0.399) break;
    REQUIRE(state.lateral_N == Approx(spring_N).margin(1e-12));
    REQUIRE(state.contact_m == Approx(finger.from_m).margin(1e-12));
    sticking += spring_N > 0.01;
  }
  CHECK(sticking > 100);
}

TEST_CASE("friction follows the vibration through a low-pass filter", "[plant]") {
  Finger finger = smooth_finger();
  finger.land_s = 0;
  Stroker stroker(finger);
  for (int k = 0; k < 100; ++k) stroker.step(1);
  CHECK(stroker.step(1).relative_friction == Approx(1).epsilon(1e-9));
  const double low = 0.4, rest = 1;
  // the low-pass has its cut-off at 300 Hz: after n steps, exp(-2 pi 300 n / 8000) of the change is left
  for (int n = 1; n <= 40; ++n) {
    const auto& state = stroker.step(low);
    const double left = std::exp(-2 * pi * 300 * n / 8000);
    REQUIRE(state.relative_friction == Approx(low + (rest - low) * left).epsilon(1e-9));
    REQUIRE(state.friction == Approx(0.8 * state.relative_friction).epsilon(1e-12));
  }
}

TEST_CASE("friction drifts", "[plant]") {
  Finger finger = smooth_finger();
  finger.friction_drift_per_s = 0.05;
  Stroker stroker(finger);
  for (int k = 0; k < 16000; ++k) stroker.step();
  CHECK(stroker.step().friction == Approx(0.8 * std::exp(0.1)).epsilon(1e-9));
}

TEST_CASE("force and friction vary with the given standard deviations", "[plant]") {
  Finger finger = smooth_finger();
  finger.normal_noise = 0.15;
  finger.friction_noise = 0.08;
  Stroker stroker(finger);
  double n = 0, n2 = 0, m = 0, m2 = 0;
  constexpr int count = 8000 * 300;
  for (int k = 0; k < count; ++k) {
    const auto& state = stroker.step();
    n += state.normal_N;
    n2 += state.normal_N * state.normal_N;
    m += state.friction;
    m2 += state.friction * state.friction;
  }
  n /= count;
  m /= count;
  CHECK(n == Approx(0.5).epsilon(0.02));
  CHECK(m == Approx(0.8).epsilon(0.01));
  CHECK(std::sqrt(n2 / count - n * n) / n == Approx(0.15).epsilon(0.1));
  CHECK(std::sqrt(m2 / count - m * m) / m == Approx(0.08).epsilon(0.1));
}

TEST_CASE("pink noise has the same power in each octave", "[plant]") {
  PinkNoise noise(3, 5, 8000, 1, 1100);
  // Compares the power in the octaves that begin at 4, 32 and 256 Hz. It uses Fourier sums over blocks of 1 s
  // and not filters, because the noise itself is made by first-order low-pass filters.
  constexpr int blocks = 60;
  double power[9] = {};
  std::vector<double> x(8000);
  for (int block = 0; block < blocks; ++block) {
    for (double& sample : x) sample = noise.next();
    for (int octave = 2; octave < 9; octave += 3)
      for (int f = 1 << octave; f < 2 << octave; f += std::max(1, (1 << octave) / 16)) {
        std::complex<double> sum = 0;
        for (int k = 0; k < 8000; ++k)
          sum += x[static_cast<std::size_t>(k)] * std::polar(1.0, -2 * pi * f * k / 8000);
        power[octave] += std::norm(sum) * std::max(1, (1 << octave) / 16);
      }
  }
  CHECK(power[5] / power[2] == Approx(1).epsilon(0.25));
  CHECK(power[8] / power[5] == Approx(1).epsilon(0.25));
}

TEST_CASE("the finger touches when it is scheduled, and its force builds up smoothly", "[plant]") {
  Finger finger = smooth_finger();
  finger.touches = {{24 * 800, 24 * 4000}, {24 * 8000, kNever}};
  Stroker stroker(finger);
  std::vector<FingerState> states;
  for (int k = 0; k < 12000; ++k) states.push_back(stroker.step());
  CHECK(states[799].normal_N == 0);
  // half-way through the 50 ms in which the force rises
  CHECK(states[800 + 199].normal_N == Approx(0.25).epsilon(1e-9));
  CHECK(states[800 + 399].normal_N == Approx(0.5).epsilon(1e-9));
  CHECK(states[3999].normal_N == Approx(0.5).epsilon(1e-9));
  CHECK(states[4400].normal_N == 0);
  CHECK(states[4400].lateral_N == 0);
  CHECK(states[4400].contact_m == states[4400].finger_m);
  CHECK(states[7999].normal_N == 0);
  CHECK(states[8400].normal_N == Approx(0.5).epsilon(1e-9));
  CHECK(states[8400].finger_m == 0.06);  // each touch begins with a new stroke
}
