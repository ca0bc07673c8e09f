#include "station/sensing/carrier.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "station/core/usage_error.hpp"
#include "tests/sensing/bridge_signal.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;

namespace {

constexpr double newton = BridgeSignal::N_per_ratio;
constexpr std::size_t second = 192000;

std::vector<double> forces_N(const std::vector<BridgePoint>& points) {
  std::vector<double> all;
  for (const auto& point : points) all.push_back(newton * point.ratio[0]);
  return all;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double sd(const std::vector<double>& values) {
  double square = 0;
  for (const double value : values) square += std::pow(value - mean(values), 2);
  return std::sqrt(square / static_cast<double>(values.size() - 1));
}

std::vector<double> measured_N(const BridgeSignal& signal, std::size_t frames, std::int64_t first = 0,
                               BridgeOptions options = bridge_options()) {
  return forces_N(complete(demodulated(options, first, signal.frames(first, frames))));
}

/// Returns the delay (in frames) of the demodulated force for a force of one frequency. The first captured
/// frame really is `first`, but the demodulator is told `said`.
double delay_frames(std::int64_t first, std::int64_t said, Band band, double frequency_Hz) {
  BridgeSignal signal;
  const double omega = 2 * std::numbers::pi * frequency_Hz;
  signal.force_N = [&](double t) { return 1 + 0.5 * std::sin(omega * t); };
  auto options = bridge_options();
  options.band = band;
  const double rate = points_per_second(band);
  std::complex<double> sum = 0;
  const auto points = complete(demodulated(options, said, signal.frames(first, second / 4)));
  // whole periods only, so that the constant force does not matter
  const auto whole =
      static_cast<std::size_t>(rate / frequency_Hz * std::floor(points.size() * frequency_Hz / rate));
  for (std::size_t i = 0; i < whole; ++i)
    sum += points[i].ratio[0] *
           std::exp(std::complex<double>(0, -omega * static_cast<double>(points[i].index) / rate));
  return -std::arg(sum * std::complex<double>(0, 1)) / omega * 192000;
}

}  // namespace

TEST_CASE("a force of 0 to 2 N is measured without a constant error", "[sensing]") {
  for (const double force : {0.0, 0.05, 0.5, 1.0, 2.0}) {
    BridgeSignal signal;
    signal.force_N = [&](double) { return force; };
    signal.noise_V_rtHz = 4e-9;
    CHECK(std::abs(mean(measured_N(signal, second / 4)) - force) < 1e-3 * force + 0.5e-3);
  }
  // ignoring the bridge's phase of 0.09 rad makes the force too small by 0.4 %
  BridgeSignal signal;
  signal.force_N = [](double) { return 2; };
  signal.bridge_phase_rad = 0.09;
  CHECK(std::abs(mean(measured_N(signal, second / 8)) - 2) > 2.5e-3);
  const auto with = complete(demodulated(bridge_options(), 0, signal.frames(0, second / 8)));
  signal.force_N = [](double) { return 0.3; };
  const auto without = complete(demodulated(bridge_options(), 0, signal.frames(0, second / 8)));
  auto options = bridge_options();
  for (std::size_t i = 0; i < bridge_count; ++i)
    options.rotation_rad[i] = std::atan2(with.back().quadrature[i] - without.back().quadrature[i],
                                         with.back().ratio[i] - without.back().ratio[i]);
  CHECK(options.rotation_rad[2] == Approx(0.09).epsilon(1e-3));
  signal.force_N = [](double) { return 2; };
  CHECK(std::abs(mean(measured_N(signal, second / 8, 0, options)) - 2) < 1e-5);
}

TEST_CASE("noise of the force is that of bridge and amplifier in its band", "[sensing]") {
  BridgeSignal signal;
  signal.noise_V_rtHz = 4e-9;
  const auto closed_N = [&](double bandwidth_Hz) {
    return 4e-9 * std::sqrt(2 * bandwidth_Hz) / (BridgeSignal::excitation_V * BridgeSignal::volt_per_volt_N);
  };
  CHECK(sd(measured_N(signal, 3 * second)) == Approx(closed_N(480)).epsilon(0.1));
  auto wide = bridge_options();
  wide.band = Band::wide;
  const double wide_sd = sd(measured_N(signal, second, 0, wide));
  CHECK(wide_sd == Approx(closed_N(1410)).epsilon(0.1));
  CHECK(wide_sd > 1.3 * closed_N(480));  // negative control: the comparison would detect a wrong band
}

TEST_CASE("drive tones at the bridge do not look like a force", "[sensing]") {
  BridgeSignal signal;
  signal.force_N = [](double) { return 1; };
  signal.cubic_per_V2 = 1e-4;
  const double off = mean(measured_N(signal, second / 4));
  const auto with_tones = [&](double volt) {
    signal.tone_V = volt;
    signal.tones_Hz = {23e3, 26.1e3, 31.3e3, 38.9e3};
    const auto on = measured_N(signal, second / 4);
    return std::max(std::abs(mean(on) - off), sd(on));
  };
  CHECK(with_tones(1e-3) < 0.1e-3);
  CHECK(with_tones(3e-3) > 0.15e-3);  // negative control: three times the crosstalk is detected
}

TEST_CASE("no delay is left in the force", "[sensing]") {
  for (const std::int64_t first : {0, 12345}) {
    CHECK(std::abs(delay_frames(first, first, Band::force, 100)) < 0.1);
    CHECK(std::abs(delay_frames(first, first, Band::wide, 500)) < 0.1);
  }
  CHECK(delay_frames(0, 1, Band::force, 100) == Approx(1).margin(0.1));
}

TEST_CASE("a step is within one per cent after 5 ms, and 0.1 per cent after 10 ms", "[sensing]") {
  BridgeSignal signal;
  signal.force_N = [](double t) { return t < 0.1 ? 0 : 1; };
  const auto points = complete(demodulated(bridge_options(), 0, signal.frames(0, second / 4)));
  double largest = 0;
  for (const auto& point : points) {
    const double late_s = static_cast<double>(point.index) / 1000 - 0.1, force = newton * point.ratio[0];
    const double error = std::abs(force - (late_s < 0 ? 0 : 1));
    largest = std::max(largest, force);
    if (std::abs(late_s) > 5.5e-3) CHECK(error < 0.01);
    if (std::abs(late_s) > 10.5e-3) CHECK(error < 0.001);
  }
  CHECK(largest > 1.03);  // the step response overshoots; a filter without overshoot could not be this short
}

TEST_CASE("drift of the excitation cancels, drift of one amplifier does not", "[sensing]") {
  BridgeSignal signal;
  signal.force_N = [](double) { return 1.5; };
  signal.gain = [](double t) { return 1 + 0.004 * t; };
  const auto force = measured_N(signal, second / 4);
  CHECK(std::abs(force.back() - force.front()) < 2e-6);
  signal.gain = [](double) { return 1; };
  signal.force_N = [](double t) { return 1.5 * (1 + 0.004 * t); };
  const auto drifting = measured_N(signal, second / 4);
  CHECK(drifting.back() - drifting.front() > 1e-3);
}

TEST_CASE("the result does not depend on the size of the blocks", "[sensing]") {
  BridgeSignal signal;
  signal.force_N = [](double t) { return std::sin(300 * t); };
  signal.noise_V_rtHz = 4e-9;
  const auto samples = signal.frames(777, second / 5);
  const auto whole = demodulated(bridge_options(), 777, samples);
  BridgeDemodulator demodulator(bridge_options());
  std::vector<BridgePoint> points;
  std::size_t at = 0;
  for (std::size_t size = 1; at < samples.size(); size = size * 7 % 1021) {
    const std::size_t count = std::min(4 * size, samples.size() - at);
    demodulator.push({std::span(samples).subspan(at, count), 4, static_cast<std::int64_t>(777 + at / 4)},
                     [&](const BridgePoint& point) { points.push_back(point); });
    at += count;
  }
  REQUIRE(points.size() == whole.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(points[i].index == whole[i].index);
    CHECK((points[i].ratio == whole[i].ratio || std::isnan(whole[i].ratio[0])));
  }
}

TEST_CASE("missing frames make only those points NaN that depend on them", "[sensing]") {
  BridgeSignal signal;
  signal.force_N = [](double t) { return std::sin(200 * t); };
  const auto samples = signal.frames(0, second / 4);
  const auto whole = demodulated(bridge_options(), 0, samples);
  BridgeDemodulator demodulator(bridge_options());
  std::vector<BridgePoint> points;
  const auto take = [&](const BridgePoint& point) { points.push_back(point); };
  demodulator.push({std::span(samples).first(4 * 20000), 4, 0}, take);
  demodulator.push({std::span(samples).first(4 * 15000), 4, 0}, take);  // already received, so ignored
  demodulator.push({std::span(samples).subspan(4 * 20100), 4, 20100}, take);
  REQUIRE(points.size() == whole.size());
  std::size_t lost = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(points[i].index == whole[i].index);
    const bool now = std::isnan(points[i].ratio[0]), before = std::isnan(whole[i].ratio[0]);
    lost += now && !before ? 1 : 0;
    if (!now) CHECK(points[i].ratio == whole[i].ratio);
    if (now && !before) CHECK(std::abs(192.0 * static_cast<double>(points[i].index) - 20050) < 3200);
  }
  CHECK(lost > 25);
  CHECK(lost < 35);
  CHECK_THROWS_AS(demodulator.push({samples, 2, 5}, take), std::logic_error);
  CHECK_THROWS_AS(demodulator.push({samples, 4, 5, 96000}, take), std::logic_error);
}

TEST_CASE("a wire that is off is a fault with a name", "[sensing]") {
  BridgeSignal signal;
  signal.force_N = [](double) { return 1; };
  const auto worst = [&] {
    const auto points = demodulated(bridge_options(), 0, signal.frames(0, second / 8));
    return points.back();
  };
  CHECK(worst().fault == WireFault::none);
  signal.quadrature_V_V = 0.04 * 2e-3;
  CHECK(worst().fault == WireFault::none);
  signal.quadrature_V_V = 0.06 * 2e-3;
  CHECK(worst().fault == WireFault::quadrature);
  signal.quadrature_V_V = 0;
  signal.gain = [](double) { return 0.975; };
  CHECK(worst().fault == WireFault::none);
  signal.gain = [](double) { return 0.965; };
  CHECK(worst().fault == WireFault::reference);
  CHECK(std::isnan(worst().ratio[1]));
  signal.gain = [](double) { return 1; };
  signal.force_N = [](double) { return 16; };
  CHECK(worst().fault == WireFault::overload);
}

TEST_CASE("a bridge whose samples stop to change is a fault from then on, and one that only reads 0 is none",
          "[sensing]") {
  const auto [band, stuck] =
      GENERATE(std::pair{Band::force, 0}, std::pair{Band::force, -12345}, std::pair{Band::wide, 0});
  BridgeSignal signal;
  signal.force_N = [](double) { return 0; };
  signal.noise_V_rtHz = 4e-9;
  auto options = bridge_options();
  options.band = band;
  auto samples = signal.frames(0, second / 4);
  for (const auto& point : complete(demodulated(options, 0, samples))) CHECK(point.fault == WireFault::none);
  constexpr std::int64_t dead = 24000;
  for (std::size_t n = dead; n < second / 4; ++n) samples[4 * n + 3] = stuck;
  for (const auto& point : complete(demodulated(options, 0, samples))) {
    const std::int64_t frame = point.index * 192000 / points_per_second(band);
    if (frame >= dead) {
      CHECK(point.fault == WireFault::silent);
      CHECK(point.bridge == 2);
    }
    if (frame < dead - 3400) CHECK(point.fault == WireFault::none);
  }
}

TEST_CASE("a carrier that repeats within a few frames is no bridge that repeats a block",
          "[sensing][carrier]") {
  BridgeOptions options;
  options.carrier_Hz = 32000;  // a period of 6 frames, here without any noise
  BridgeDemodulator demodulator(options);
  CaptureBlock block;
  block.rate_Hz = options.rate_Hz, block.channels = options.channels;
  std::vector<std::int32_t> samples;
  for (int n = 0; n < 40'000; ++n)
    for (int channel = 0; channel < options.channels; ++channel) {
      const double amplitude = channel == options.reference ? options.reference_amplitude : 0.01;
      const double wave = std::sin(2 * std::numbers::pi * (n % 6) / 6 + 0.3);
      samples.push_back(static_cast<std::int32_t>(std::lround(0x1p31 * amplitude * wave)));
    }
  block.samples = samples;
  int points = 0;
  demodulator.push(block, [&](const BridgePoint& point) {
    if (++points > 20) CHECK(point.fault == WireFault::none);
  });
  CHECK(points > 40);
}

TEST_CASE(
    "a bridge that repeats a block of samples is a fault, and one with half the noise of the others is none",
    "[sensing]") {
  // The frames at which the bridge gets stuck, and the length of the block that it repeats.
  const auto [stuck, length] = GENERATE(table<std::int64_t, std::int64_t>(
      {{24000, 64}, {24000, 256}, {30011, 441}, {24000, 1024}, {24000, 4096}, {0, 0}}));
  BridgeSignal signal;
  signal.force_N = [](double) { return 0.0; };
  signal.noise_V_rtHz = 4e-9;
  auto samples = signal.frames(0, second / 2);
  for (std::size_t n = 0; length == 0 && n < second / 2; ++n) samples[4 * n + 3] /= 2;
  for (std::size_t n = static_cast<std::size_t>(stuck + length); length > 0 && n < second / 2; ++n)
    samples[4 * n + 3] = samples[4 * (n - static_cast<std::size_t>(length)) + 3];
  // It is known at the latest after the old row of samples, a new one, and its repetition.
  const auto known = stuck + 2 * 4480 + 2 * length;
  CAPTURE(length);
  for (const auto& point : complete(demodulated(bridge_options(), 0, samples))) {
    const std::int64_t frame = point.index * 192000 / points_per_second(Band::force);
    if (length == 0 || frame < stuck - 3400) CHECK(point.fault == WireFault::none);
    if (length == 0 || frame < known) continue;
    CHECK(point.fault == WireFault::silent);
    CHECK(point.bridge == 2);
  }
}

TEST_CASE("a bridge whose converter is at its limits is a fault", "[sensing]") {
  const auto levels =
      GENERATE(std::pair{0x7fffff00, 0x7fffff00}, std::pair{-0x7fffff00 - 256, -0x7fffff00 - 256},
               std::pair{0x7fffff00, -0x7fffff00 - 256});
  BridgeSignal signal;
  signal.noise_V_rtHz = 4e-9;
  auto samples = signal.frames(0, second / 4);
  // The last one: the carrier, so strong that the converter only ever reads its two limits.
  for (std::size_t n = 0; n < second / 4; ++n)
    samples[4 * n + 3] = samples[4 * n] > 0 ? levels.first : levels.second;
  for (const auto& point : complete(demodulated(bridge_options(), 0, samples))) {
    CHECK(point.fault != WireFault::none);
    CHECK(point.bridge == 2);
  }
}

TEST_CASE("impossible wiring of the bridges is refused", "[sensing]") {
  const auto refused = [](auto change) {
    auto options = bridge_options();
    change(options);
    CHECK_THROWS_AS(BridgeDemodulator(options), core::UsageError);
  };
  refused([](BridgeOptions& o) { o.rate_Hz = 44100; });
  refused([](BridgeOptions& o) { o.carrier_Hz = 500; });
  refused([](BridgeOptions& o) { o.bridges[2] = 4; });
  refused([](BridgeOptions& o) { o.reference = -1; });
  refused([](BridgeOptions& o) { o.full_scale[1] = 0; });
  auto options = bridge_options();
  options.rate_Hz = 96000;
  CHECK(BridgeDemodulator(options).frames_per_point() == 96);
}
