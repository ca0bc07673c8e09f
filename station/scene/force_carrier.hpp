#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace turnpoint::scene {

/// Where a frequency appears in a capture with this sampling rate: at itself, or at its alias.
double captured_at(double frequency_Hz, int rate_Hz);

/// A frequency that amplifiers of slight nonlinearity add to two tones, or a tone itself.
struct ToneProduct {
  double first_Hz = 0, second_Hz = 0;
  int first = 1, second = 0;  ///< the product is at |first * first_Hz + second * second_Hz|
  double captured_Hz = 0;     ///< where it appears in the capture: the same, or its alias
  double distance_Hz = 0;     ///< its distance from the frequency that was asked about
};

/// Returns for example "3 x 33400 Hz - 3 x 30000 Hz = 10200 Hz".
std::string name(const ToneProduct& product);

/// The product nearest to a frequency after aliasing at the sampling rate; empty without tones. Products of
/// tones f that sound together are the tones themselves, the differences k (f_i - f_j) up to k = 4, and 2 f_i
/// - f_j. Among equally near ones, that of the lowest order is returned.
std::optional<ToneProduct> nearest_product(std::span<const double> tones_Hz, double near_Hz, int rate_Hz);

/// The filter of the force signal passes this band on both sides of the carrier, and stops everything beyond
/// `force_stop_Hz`. A product at a distance d from the carrier is an oscillation of the force with frequency
/// d.
inline constexpr double force_band_Hz = 400, force_stop_Hz = 600;

}  // namespace turnpoint::scene
