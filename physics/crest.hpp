#pragma once
// Finds phases that give the sum of several tones a low crest factor, and lists the audible products that a
// nonlinear system makes of them.
#include <span>
#include <vector>

#include "physics/tone.hpp"

namespace turnpoint::physics {

// Sets the phases of the tones for a low crest factor; amplitudes and order stay as they are. It starts with
// Schroeder's (1970) phases, -pi n (n - 1)/N for N equal tones numbered by frequency, then lowers the peak of
// the sampled waveform step by step. The result is deterministic.
void assign_phases(std::span<Tone> tones);

// Crest factor: the peak of the summed waveform divided by its root mean square. The waveform is sampled over
// its beat period (at most 50 ms), and the peak is interpolated between samples.
double crest_factor(std::span<const Tone> tones);

// A frequency that a nonlinear system produces: from two tones (f1 - f2), or at third order from two or three
// tones (2 f1 - f2, f1 + f2 - f3).
struct Product {
  double frequency_Hz;
  int order;  // 2: product of two tones; 3: third-order product
};

// All products of order 2 and 3 between 0 and below_Hz, ascending. Products within 1 Hz of each other are
// merged.
std::vector<Product> audible_products(std::span<const Tone> tones, double below_Hz = 20000);

}  // namespace turnpoint::physics
