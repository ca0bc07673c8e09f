#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "station/terms/force_carriers.hpp"

namespace turnpoint::scene {

using terms::carriers_Hz;

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

/// A carrier, and its distance from the nearest distortion product of the drive tones.
struct CarrierChoice {
  double carrier_Hz = carriers_Hz.front();
  double clearance_Hz = 0;
};
/// With this clearance (distance from the nearest distortion product of the drive tones), the products are
/// far outside the filter of either band.
inline constexpr double enough_clearance_Hz = 1500;

/// Chooses the first of carriers_Hz with enough clearance, or else the one with the most clearance. Each plan
/// lists the tones of one stimulus of a block. Tones of different plans never sound together, but all plans
/// get the same carrier.
///
/// With many tones, there is often no carrier with enough clearance. For random plans from 22.4 to 46 kHz
/// with tones at least 1 kHz apart, there is one in 98 % of plans with two tones, 58 % with three and 11 %
/// with four. A clearance above force_stop_Hz still keeps the products out of the force. This clearance is
/// reached in 99 % of plans with three tones, 81 % with four, 15 % with six, and hardly any with eight.
CarrierChoice choose_carrier(std::span<const std::vector<double>> plans, int rate_Hz);

}  // namespace turnpoint::scene
