#include "station/simulation/noise.hpp"

#include <numbers>

namespace turnpoint::simulation {

PinkNoise::PinkNoise(std::uint64_t seed, std::uint64_t source, double rate_Hz, double low_Hz,
                     double high_Hz) {
  for (double f = low_Hz; f <= high_Hz; f *= 2) {
    const double keep = std::exp(-2 * std::numbers::pi * f / rate_Hz);
    const Noise noise(seed, source * 64 + octaves_.size());
    octaves_.push_back({noise, keep, std::sqrt(1 - keep * keep), noise.at(-1)});
  }
  scale_ = 1 / std::sqrt(static_cast<double>(octaves_.size()));
}

double PinkNoise::next() {
  double sum = 0;
  for (auto& octave : octaves_) {
    octave.value = octave.keep * octave.value + octave.take * octave.noise.at(count_);
    sum += octave.value;
  }
  ++count_;
  return scale_ * sum;
}

}  // namespace turnpoint::simulation
