#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// One way of making a sinusoid: its largest error against the exact sine after a time, and what it costs.
struct SynthMethod {
  std::string name;
  std::vector<double> error_dB;  ///< re full scale, at each of `times_s`
  double ns_per_tone_frame = 0;  ///< on this machine, now
};

struct SynthBenchmark {
  double frequency_Hz = 0;
  int rate_Hz = 0;
  std::string processor;  ///< which of our loops ran
  std::vector<double> times_s;
  std::vector<SynthMethod> methods;  ///< ours first
};

/// Error against time of the methods in use elsewhere (table with linear interpolation, rotation, biquad,
/// libm with an exact phase, sin(2 pi f t) with a growing t in double and float) and of ours. Runs for about
/// a second.
SynthBenchmark benchmark_synthesis(double frequency_Hz = 19600.123, int rate_Hz = 192000);

}  // namespace turnpoint::benchmark
