#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::simulation {

/// The ratio of the displacement at each pick-up to that of the drive edge, computed with the model `mode` at
/// evenly spaced frequencies. The surface is solved once per frequency, which takes seconds for a thick
/// plate.
struct SurfaceResponse {
  std::vector<double> frequency_Hz;
  std::vector<std::vector<std::complex<double>>> at;  ///< the ratios, indexed by [pick-up][frequency]
};
SurfaceResponse surface_response(const physics::Surface& surface, std::span<const double> x_m, double low_Hz,
                                 double high_Hz);

/// A digital filter that is fitted to a SurfaceResponse. It consists of resonators that all pick-ups share,
/// and of a few taps for the remaining part of the response. All resonance frequencies are multiplied by
/// `scale`.
class PickupFilter {
 public:
  PickupFilter(const SurfaceResponse& response, double rate_Hz, double scale);

  /// Takes the displacement of the drive edge in the next frame.
  void step(double drive);
  /// The displacement at a pick-up (by its index) in this frame.
  double output(std::size_t place) const;
  /// The filter's own response, and its largest difference from the response to which it was fitted.
  std::complex<double> response(std::size_t place, double frequency_Hz) const;
  double fit_error() const { return fit_error_; }
  std::size_t resonances() const { return pole_re_.size(); }
  /// Frequency (Hz) and quality factor of each resonator.
  std::vector<std::pair<double, double>> resonators() const;
  /// Copies the state of another filter, so that the surface continues its motion without a jump.
  void continue_from(const PickupFilter& other);

 private:
  static constexpr std::size_t kTaps = 4;
  struct Place {
    std::vector<double> re, im;  // weights of the resonators at this pick-up
    std::vector<double> taps;
  };

  double rate_Hz_;
  std::vector<double> pole_re_, pole_im_, state_re_, state_im_;
  std::vector<double> past_;
  std::vector<Place> places_;
  double fit_error_ = 0;
};

}  // namespace turnpoint::simulation
