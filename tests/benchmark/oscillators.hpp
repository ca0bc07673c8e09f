#pragma once
#include <string>
#include <vector>

namespace turnpoint::benchmark {

/// A method of generating a sinusoid: its largest error against the exact sine after given times, and its
/// cost.
struct SynthMethod {
  std::string name;
  std::vector<double> error_dB;  ///< largest error relative to full scale, one value for each of `times_s`
  double ns_per_tone_frame = 0;  ///< time to compute one frame of one tone on this machine
};

struct SynthBenchmark {
  double frequency_Hz = 0;
  int rate_Hz = 0;
  std::vector<double> times_s;
  std::vector<SynthMethod> methods;  ///< the station's own method is first
};

/// Compares the station's method with common ones (table with linear interpolation, rotation, biquad, libm
/// with an exact phase, sin(2 pi f t) with a growing t in double and float): error against time. Runs for
/// about a second.
SynthBenchmark benchmark_synthesis(double frequency_Hz = 19600.123, int rate_Hz = 192000);

}  // namespace turnpoint::benchmark
