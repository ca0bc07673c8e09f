#pragma once
// Phases for a low crest factor, and the audible products of several tones.
#include <span>
#include <vector>

#include "physics/tone.hpp"

namespace turnpoint::physics {

// Schroeder's phases -pi n (n - 1)/N in order of frequency (Schroeder 1970), then improved by a deterministic
// descent on the sampled waveform; amplitudes and order are kept.
void assign_phases(std::span<Tone> tones);

// Peak over root-mean-square of the summed waveform, from samples over its beat period (at most 50 ms), peak
// refined between samples.
double crest_factor(std::span<const Tone> tones);

// A difference product of two or three tones.
struct Product {
  double frequency_Hz;
  int order;  // 2 or 3
};

// All products n1 f1 + n2 f2 + ... of order 2 and 3 that fall in (0, below_Hz), ascending, merged within 1
// Hz.
std::vector<Product> audible_products(std::span<const Tone> tones, double below_Hz = 20000);

}  // namespace turnpoint::physics
