#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::plant {

/// Displacement at a place of the surface per displacement of the drive edge, by the model `mode`, at evenly
/// spaced frequencies. One solution per frequency, so a thick plate takes seconds.
struct SurfaceResponse {
  std::vector<double> frequency_Hz;
  std::vector<std::vector<std::complex<double>>> at;  ///< [place][frequency]
};
SurfaceResponse surface_response(const physics::Surface& surface, std::span<const double> x_m, double low_Hz,
                                 double high_Hz);

/// A filter with this response: resonators shared by all places, and a few taps for what is left. All
/// resonances can be moved by a factor.
class PickupFilter {
 public:
  PickupFilter(const SurfaceResponse& response, double rate_Hz, double scale);

  /// Takes the displacement of the drive edge in the next frame.
  void step(double drive);
  /// The displacement at a place in this frame.
  double output(std::size_t place) const;
  /// The response of the filter itself, and the largest difference from what was to be fitted.
  std::complex<double> response(std::size_t place, double frequency_Hz) const;
  double fit_error() const { return fit_error_; }
  std::size_t resonances() const { return pole_re_.size(); }
  /// Takes over the motion of another filter of the same surface.
  void continue_from(const PickupFilter& other);

 private:
  static constexpr std::size_t kTaps = 4;
  struct Place {
    std::vector<double> re, im;  // what each resonator contributes
    std::vector<double> taps;
  };

  double rate_Hz_;
  std::vector<double> pole_re_, pole_im_, state_re_, state_im_;
  std::vector<double> past_;
  std::vector<Place> places_;
  double fit_error_ = 0;
};

}  // namespace turnpoint::plant
