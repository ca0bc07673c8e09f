#include "tests/benchmark/oscillators.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include "station/audio/oscillator.hpp"
#include "station/audio/sine.hpp"

namespace turnpoint::benchmark {

using namespace audio;

namespace {

constexpr std::size_t block = 384;
constexpr double kTwoPi = 2 * std::numbers::pi;

// The buffers that methods fill, one for each number type, so that no conversion is timed.
struct Block {
  std::array<double, block> wide;
  std::array<float, block> narrow;
};

// A method that fills a block beginning at a given frame.
struct Method {
  std::string name;
  std::function<void(std::int64_t frame, Block& out)> render;
  bool free_running = false;  ///< true if the error grows with every frame computed since the start
  bool narrow = false;
};

// The exact sine for the frequency that the phase increment represents, so that a method is judged by its
// arithmetic and not by the rounding of its frequency. The phase of a frame is an exact 64-bit fraction of a
// cycle.
double exact_sine(std::uint64_t increment, std::int64_t frame) {
  const auto phase = static_cast<std::int64_t>(increment * static_cast<std::uint64_t>(frame));
  return static_cast<double>(
      std::sin(static_cast<long double>(phase) * 0x1p-64L * 2 * std::numbers::pi_v<long double>));
}

Method ours(std::uint64_t increment) {
  return {"integer phase, polynomial, double", [=](std::int64_t frame, Block& out) {
            out.wide.fill(0);
            add_steady(out.wide.data(), block,
                       {increment * static_cast<std::uint64_t>(frame), increment, 0, 1, 0});
          }};
}

Method libm(std::uint64_t increment) {
  return {"integer phase, libm", [=](std::int64_t frame, Block& out) {
            for (std::size_t n = 0; n < block; ++n) {
              const auto phase =
                  static_cast<std::int64_t>(increment * (static_cast<std::uint64_t>(frame) + n));
              out.wide[n] = std::sin(static_cast<double>(phase) * (0x1p-64 * kTwoPi));
            }
          }};
}

Method table(std::uint64_t increment, int bits) {
  std::vector<double> values;
  for (int k = 0; k <= 1 << bits; ++k) values.push_back(std::sin(kTwoPi * k / (1 << bits)));
  return {"table of " + std::to_string(1 << bits) + ", linear",
          [=, values = std::move(values)](std::int64_t frame, Block& out) {
            for (std::size_t n = 0; n < block; ++n) {
              const std::uint64_t phase = increment * (static_cast<std::uint64_t>(frame) + n);
              const auto k = static_cast<std::size_t>(phase >> (64 - bits));
              const double u = static_cast<double>((phase << bits) >> 11) * 0x1p-53;
              out.wide[n] = values[k] + u * (values[k + 1] - values[k]);
            }
          }};
}

Method growing_time(double frequency_Hz, int rate_Hz) {
  return {"sin(2 pi f t), t += dt, double",
          [=, t = 0.0](std::int64_t, Block& out) mutable {
            for (std::size_t n = 0; n < block; ++n, t += 1.0 / rate_Hz)
              out.wide[n] = std::sin(kTwoPi * frequency_Hz * t);
          },
          true};
}

Method growing_float_time(double frequency_Hz, int rate_Hz) {
  return {"sin(2 pi f t), float",
          [=](std::int64_t frame, Block& out) {
            const auto w = static_cast<float>(kTwoPi * frequency_Hz);
            for (std::size_t n = 0; n < block; ++n) {
              const auto t =
                  static_cast<float>((static_cast<double>(frame) + static_cast<double>(n)) / rate_Hz);
              out.narrow[n] = std::sin(w * t);
            }
          },
          false, true};
}

Method rotation(std::uint64_t increment) {
  const double angle = static_cast<double>(increment) * 0x1p-64 * kTwoPi;
  return {
      "rotation, free running",
      [=, z = std::complex<double>(1, 0), step = std::polar(1.0, angle)](std::int64_t, Block& out) mutable {
        for (std::size_t n = 0; n < block; ++n, z = {z.real() * step.real() - z.imag() * step.imag(),
                                                     z.real() * step.imag() + z.imag() * step.real()})
          out.wide[n] = z.imag();
      },
      true};
}

Method reseeded_rotation(std::uint64_t increment) {
  const double angle = static_cast<double>(increment) * 0x1p-64 * kTwoPi;
  return {"rotation, reseeded each block",
          [=, step = std::polar(1.0, angle)](std::int64_t frame, Block& out) {
            const std::uint64_t phase = increment * static_cast<std::uint64_t>(frame);
            std::complex<double> z(sine_of_phase(phase + quarter_cycle), sine_of_phase(phase));
            for (std::size_t n = 0; n < block; ++n, z = {z.real() * step.real() - z.imag() * step.imag(),
                                                         z.real() * step.imag() + z.imag() * step.real()})
              out.wide[n] = z.imag();
          }};
}

double error_dB(const Block& made, bool narrow, std::uint64_t increment, std::int64_t frame) {
  double worst = 1e-20;
  for (std::size_t n = 0; n < block; ++n) {
    const double sample = narrow ? static_cast<double>(made.narrow[n]) : made.wide[n];
    worst = std::max(worst, std::abs(sample - exact_sine(increment, frame + static_cast<std::int64_t>(n))));
  }
  return 20 * std::log10(worst);
}

double cost_ns(Method& method, Block& out) {
  double best = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const auto before = std::chrono::steady_clock::now();
    for (int k = 0; k < 200; ++k) method.render(std::int64_t{k} * block, out);
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - before;
    best = std::min(best, taken.count() / (200.0 * block));
  }
  return best;
}

}  // namespace

SynthBenchmark benchmark_synthesis(double frequency_Hz, int rate_Hz) {
  SynthBenchmark result{frequency_Hz, rate_Hz, {0, 1, 10, 60, 600, 86400}, {}};
  const std::uint64_t increment = phase_increment(frequency_Hz, rate_Hz);
  const auto methods = [&] {
    return std::vector<Method>{ours(increment),
                               libm(increment),
                               table(increment, 12),
                               table(increment, 16),
                               reseeded_rotation(increment),
                               rotation(increment),
                               growing_time(frequency_Hz, rate_Hz),
                               growing_float_time(frequency_Hz, rate_Hz)};
  };
  Block samples;
  auto timed = methods();
  for (Method& method : methods()) {
    SynthMethod row;
    row.name = method.name;
    std::int64_t made = 0;
    for (const double time_s : result.times_s) {
      const std::int64_t frame = std::llround(time_s * rate_Hz) / block * block;
      // A free-running method has to compute every frame. A day of frames would take minutes, so stop at one
      // minute.
      if (method.free_running && time_s > 60) break;
      for (; method.free_running && made < frame; made += block) method.render(made, samples);
      method.render(frame, samples);
      made = frame + block;
      row.error_dB.push_back(error_dB(samples, method.narrow, increment, frame));
    }
    row.ns_per_tone_frame = cost_ns(timed[result.methods.size()], samples);
    result.methods.push_back(std::move(row));
  }
  return result;
}

}  // namespace turnpoint::benchmark
