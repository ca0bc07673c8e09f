#include "station/simulation/lock_in.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace turnpoint::simulation {

using std::numbers::pi;

std::complex<double> phasor(double cycles_per_frame, std::int64_t frame) {
  // Split the frame number in two, so that whole cycles can be dropped from the large part before precision
  // is lost.
  const std::int64_t high = frame >> 20, low = frame & 0xfffff;
  const double many = std::fmod(std::fmod(cycles_per_frame * 0x1p20, 1.0) * static_cast<double>(high), 1.0);
  const double few = std::fmod(cycles_per_frame * static_cast<double>(low), 1.0);
  return std::polar(1.0, 2 * pi * (many + few));
}

LockIn::LockIn(double frequency_Hz, int rate_Hz, int step_frames, int window_steps)
    : frequency_Hz_(frequency_Hz),
      cycles_per_frame_(frequency_Hz / rate_Hz),
      window_steps_(window_steps),
      every_(static_cast<std::size_t>(std::max(1, window_steps / 10))),
      turn_(std::polar(1.0, -2 * pi * cycles_per_frame_)) {
  double total = 0;
  const int before = kWindow - window_steps;  // the newest steps come last
  for (int k = 0; k < window_steps; ++k) {
    const double weight = 0.5 - 0.5 * std::cos(2 * pi * (k + 0.5) / window_steps);
    window_[static_cast<std::size_t>(before + k)] = weight;
    total += weight;
  }
  scale_ = 2 / (total * step_frames);
}

void LockIn::begin_step(std::int64_t frame) {
  steps_[next_] = sum_;
  next_ = (next_ + 1) % kWindow;
  if (next_ % every_ == 0) {
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < kWindow; ++k) sum += window_[k] * steps_[(next_ + k) % kWindow];
    amplitude_ = scale_ * sum;
  }
  sum_ = 0;
  rotor_ = std::conj(phasor(cycles_per_frame_, frame));
}

}  // namespace turnpoint::simulation
