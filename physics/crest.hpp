#pragma once
// Finds phases for a low crest factor, and the audible products of several tones.
#include <span>
#include <vector>

#include "physics/tone.hpp"

namespace turnpoint::physics {

// Sets Schroeder's phases -pi n (n - 1)/N in order of frequency (Schroeder 1970), then improves them by a
// deterministic descent on the sampled waveform. Keeps amplitudes and order of the tones.
void assign_phases(std::span<Tone> tones);

// Peak divided by root-mean-square of the summed waveform. It is sampled over its beat period (at most 50
// ms), and the peak is interpolated between samples.
double crest_factor(std::span<const Tone> tones);

// A frequency that arises as a difference product of two or three tones.
struct Product {
  double frequency_Hz;
  int order;  // 2 or 3
};

// All products n1 f1 + n2 f2 + ... of order 2 and 3 between 0 and below_Hz, ascending; products within 1 Hz
// are merged.
std::vector<Product> audible_products(std::span<const Tone> tones, double below_Hz = 20000);

}  // namespace turnpoint::physics
