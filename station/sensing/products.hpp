#pragma once
#include <span>
#include <string>
#include <vector>

namespace turnpoint::sensing {

/// Distortion products: new frequencies that arise from the tones in a nonlinear plate, clamp or amplifier:
/// subharmonics (a rattling part answers at f/2 or f/3), harmonics, and combinations to third order.
enum class ProductKind {
  half,             ///< f_i / 2
  third,            ///< f_i / 3
  second_harmonic,  ///< 2 f_i
  third_harmonic,   ///< 3 f_i
  sum,              ///< f_i + f_j
  difference,       ///< |f_i - f_j|
  two_minus_one,    ///< |2 f_i - f_j|
  two_plus_one,     ///< 2 f_i + f_j
};

struct Product {
  ProductKind kind = ProductKind::half;
  int i = 0, j = 0;         ///< indices of the tones in the list of frequencies, from 0
  double frequency_Hz = 0;  ///< frequency in the samples, after aliasing if it is above half the rate
  double level_dB = 0;      ///< rms relative to the rms of all planned tones at the same pick-up
};

/// The product's name, such as "2 f1 - f3". Tones are numbered from 1.
std::string name(const Product& product);

/// True for products that a symmetric limiter makes: 3 f, 2 f_i - f_j, 2 f_i + f_j.
bool is_odd(ProductKind kind);

/// Returns the products of these tones from `low_Hz` to 0.49 of the sampling rate, except those less than
/// `apart_Hz` from a tone. If two products are less than `apart_Hz` apart, only the first is kept.
std::vector<Product> products_of(std::span<const double> frequencies_Hz, int rate_Hz, double low_Hz,
                                 double apart_Hz);

/// Amplitude of a sinusoid in the samples, measured with a Hann window over all samples.
double amplitude_at(std::span<const double> samples, double frequency_Hz, int rate_Hz);

}  // namespace turnpoint::sensing
