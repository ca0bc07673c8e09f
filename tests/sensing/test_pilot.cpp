#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "station/audio/synth.hpp"
#include "station/sensing/pilot.hpp"
#include "tests/sensing/room.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;

namespace {

constexpr long double two_pi = 6.28318530717958647692529L;

/// The chirp, computed in long double at `n` frames after its start.
long double chirp(long double n, long double low_Hz, long double high_Hz, long double frames, int rate_Hz) {
  const long double u = (n + 0.5L) / frames;
  if (u <= 0 || u >= 1) return 0;
  const long double cycles = low_Hz / rate_Hz * n + (high_Hz - low_Hz) / rate_Hz / frames * n * (n - 1) / 2;
  return (1 - std::cos(two_pi * u)) / 2 * std::sin(two_pi * cycles);
}

struct Loop {
  double delay_frames = 0, gain = 0.8, noise = 1e-2;
  std::uint64_t seed = 1;
};

constexpr std::int64_t start = 987'654'321;

/// Returns what a listener finds if the reference channel carries `signal`, a function of the frames since
/// the pilot's start, and noise. The capture begins 100 frames before the pilot.
template <class Signal>
std::optional<PilotEcho> heard(const Pilot& pilot, const Loop& loop, const Signal& signal) {
  PilotListener listener(pilot, start, 1, 0);
  std::vector<std::int32_t> samples(100'000);
  std::mt19937_64 random(loop.seed);
  std::normal_distribution<double> normal(0, 1);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const auto at = static_cast<long double>(n) - 100;
    samples[n] = converted(static_cast<double>(signal(at)) + loop.noise * normal(random));
  }
  listener.push({std::span(samples).first(5000), 1, start - 100, pilot.rate_Hz});
  listener.push({std::span(samples).subspan(5000), 1, start - 100 + 5000, pilot.rate_Hz});
  CHECK(listener.complete());
  return listener.find();
}

std::optional<PilotEcho> heard(const Pilot& pilot, const Loop& loop) {
  return heard(pilot, loop, [&](long double at) {
    return loop.gain * pilot.amplitude *
           chirp(at - static_cast<long double>(loop.delay_frames), pilot.low_Hz, pilot.high_Hz,
                 static_cast<long double>(pilot.frames), pilot.rate_Hz);
  });
}

}  // namespace

TEST_CASE("a pilot gives the delay of the loop to 0.05 frame, up to half a second", "[sensing][pilot]") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Pilot pilot;
  double largest = 0, square = 0, least = 1;
  constexpr int trials = 200;
  for (int k = 0; k < trials; ++k) {
    Loop loop;
    loop.delay_frames = k < 2 ? k * 96000.0 : 96000 * uniform(random);
    loop.gain = (k % 2 == 0 ? 1 : -1) * (0.3 + 0.7 * uniform(random));
    loop.seed = random();
    const auto echo = heard(pilot, loop);
    REQUIRE(echo);
    const double error = echo->delay_frames - loop.delay_frames;
    largest = std::max(largest, std::fabs(error));
    square += error * error;
    least = std::min(least, echo->likeness);
    CHECK(echo->level_dB == Approx(20 * std::log10(std::fabs(loop.gain))).margin(0.2));
  }
  CHECK(least > 0.9);
  CAPTURE(largest, std::sqrt(square / trials));
  CHECK(largest < 0.05);
  CHECK(std::sqrt(square / trials) < 0.02);
}

TEST_CASE("without the pilot there is no delay", "[sensing][pilot]") {
  const Pilot pilot;
  Loop loop;
  loop.delay_frames = 30000.3;
  REQUIRE(heard(pilot, loop));
  const auto as = [&](double low_Hz, double high_Hz, double frames) {
    return heard(pilot, loop, [=](long double at) {
      return 0.2L * chirp(at - 30000.3L, low_Hz, high_Hz, frames, 192000);
    });
  };
  CHECK(as(22000, 46000, 1920));
  CHECK_FALSE(as(46000, 22000, 1920));                       // a falling chirp
  CHECK_FALSE(as(22000, 46000, 960));                        // a chirp that is half as long
  CHECK_FALSE(as(22000 * 1.03, 46000 * 1.03, 1920 / 1.03));  // a chirp played at another rate
  CHECK_FALSE(as(10000, 20000, 1920));                       // a chirp in another band
  CHECK_FALSE(as(34000, 34000, 1920));                       // a tone
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
    loop.seed = seed;
    CHECK_FALSE(heard(pilot, loop, [](long double) { return 0.0L; }));  // nothing but noise
    loop.noise = 0;
    CHECK_FALSE(heard(pilot, loop, [](long double) { return 0.0L; }));  // digital silence
    loop.noise = 1e-2;
  }
  CHECK_FALSE(
      heard(pilot, loop, [](long double at) { return 0.5L * std::sin(two_pi * 30000 / 192000 * at); }));
  CHECK_FALSE(heard(pilot, loop, [](long double at) {  // the pilot comes twice
    return 0.2L *
           (chirp(at - 3000, 22000, 46000, 1920, 192000) + chirp(at - 40000, 22000, 46000, 1920, 192000));
  }));
}

TEST_CASE("a pilot with lost frames gives no delay", "[sensing][pilot]") {
  const Pilot pilot;
  PilotListener listener(pilot, start, 1, 0);
  const std::vector<std::int32_t> samples(50'000);
  listener.push({samples, 1, start - 100, pilot.rate_Hz});
  CHECK_FALSE(listener.complete());
  listener.push({samples, 1, start - 100 + 50'001, pilot.rate_Hz});
  CHECK(listener.complete());
  CHECK_FALSE(listener.find());
}

TEST_CASE("the synthesiser plays the pilot that the listener knows", "[sensing][pilot]") {
  const Pilot pilot;
  const audio::Format format{pilot.rate_Hz, 1, 24};
  audio::Synth synth(format);
  REQUIRE(synth.start(audio::prepare(pilot_burst(pilot, 50), format)));
  std::vector<double> samples(2100);
  synth.render(0, std::span(samples));
  double largest = 0;
  for (std::size_t n = 0; n < samples.size(); ++n)
    largest = std::max(
        largest,
        std::fabs(samples[n] - static_cast<double>(pilot.amplitude * chirp(static_cast<long double>(n) - 50,
                                                                           22000, 46000, 1920, 192000))));
  CHECK(largest < 1e-9);
  CHECK(*std::max_element(samples.begin(), samples.end()) > 0.9 * pilot.amplitude);
}
