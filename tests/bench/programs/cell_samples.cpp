// cell_samples DEVICE RATE_HZ SECONDS A B LATERAL: reads force cells from the channels of an IIO device, as a
// session does. Prints "ready", "point TIME_NS A B LATERAL" for each point of a grid of 1 ms on
// CLOCK_MONOTONIC, and at the end "samples N lost N gaps N disorder N rate_Hz R". If the device fails, prints
// why, and exits with 3.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "station/io/converter.hpp"
#include "station/sensing/own_clock.hpp"
#include "station/system/clocks.hpp"

using namespace turnpoint;

int main(int argc, char** argv) {
  if (argc != 7) return std::fprintf(stderr, "cell_samples DEVICE RATE_HZ SECONDS A B LATERAL\n"), 2;
  io::Config config;
  config.device = argv[1];
  config.rate_Hz = std::atof(argv[2]);
  config.channels = {argv[4], argv[5], argv[6]};
  audio::ClockFit playback;  // frame 0 at time 0
  playback.ns_per_frame = 1e9 / 192'000;
  playback.pairs = 1024;
  sensing::OwnClock clock({.rate_Hz = config.rate_Hz});
  int status = 0;
  try {
    const auto converter = io::open(config);
    std::puts("ready");
    const auto end_ns = system::monotonic_ns() + static_cast<long long>(1e9 * std::atof(argv[3]));
    while (system::monotonic_ns() < end_ns) {
      for (const auto& sample : converter->read())
        clock.push({sample.time_ns, sample.value, sample.at_limit}, playback, [](const auto& point) {
          std::printf("point %lld000000 %.9f %.9f %.9f\n", static_cast<long long>(point.index),
                      point.ratio[0], point.ratio[1], point.ratio[2]);
        });
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    status = 3;
  }
  const auto& counters = clock.counters();
  std::printf("samples %lld lost %lld gaps %lld disorder %lld rate_Hz %.3f\n",
              static_cast<long long>(counters.samples), static_cast<long long>(counters.lost),
              static_cast<long long>(counters.gaps), static_cast<long long>(counters.disorder),
              clock.rate_Hz().value_or(0));
  return status;
}
