#include "tests/benchmark/oscillators.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::benchmark;

TEST_CASE("the error of the integer phase does not grow with time, that of other methods does",
          "[benchmark]") {
  const SynthBenchmark table = benchmark_synthesis();
  REQUIRE(table.methods.size() == 8);
  const auto& ours = table.methods[0].error_dB;
  REQUIRE(ours.size() == table.times_s.size());
  for (const double error_dB : ours) CHECK(error_dB < -290);
  for (const auto& method : table.methods) CHECK(method.ns_per_tone_frame > 0);
  const auto& growing = table.methods[6].error_dB;
  CHECK(growing.back() > growing.front() + 60);
  CHECK(growing.back() > -200);
  // By the last of the measured times, the method that computes sin(2 pi f t) in float has lost its phase.
  CHECK(table.methods[7].error_dB.back() > -20);
  CHECK(table.methods[2].error_dB[0] == Approx(-133).margin(8));
}
