#pragma once
// The working state of a zone design: tones, their shapes on a grid, and the friction that a fingertip feels.
#include <optional>
#include <vector>

#include "physics/zone.hpp"

namespace turnpoint::physics {

// Squared amplitude of one tone on a grid with its last maximum set to one, and the drive that this requires.
struct ToneShape {
  double frequency_Hz = 0;
  double drive_gain = 1;  // |v(0)| at unit last maximum
  std::vector<double> square;
};

class ZoneProfile {
 public:
  // Chooses offsets below `highest_Hz` for up to request.tones tones and their relative weights, by
  // non-negative least squares towards uniform squared amplitude in the zone.
  ZoneProfile(const Surface& surface, const FrictionMap& friction, const ZoneRequest& request,
              double highest_Hz);

  double highest_Hz() const { return shapes_.front().frequency_Hz; }
  // Moves all tones by one frequency difference, lower ones not beyond the band, and recomputes their shapes.
  void shift_to(double highest_Hz);
  // Sets the overall level so that mean friction over the zone has the desired value; throws
  // std::domain_error.
  void scale_to_friction();
  // The profile's own edge; empty if it has none.
  std::optional<double> edge_m() const;
  double edge_slope_m_per_Hz() const;
  std::vector<Tone> tones() const;
  void measure(ZoneDesign& design) const;

 private:
  ToneShape shape(double frequency_Hz) const;
  void choose_tones(double highest_Hz);
  std::vector<double> fit(const std::vector<const ToneShape*>& shapes, double& residual) const;
  std::vector<double> summed() const;
  std::vector<double> felt(double scale) const;
  double zone_mean(const std::vector<double>& values) const;
  std::vector<double> mean_weights() const;
  bool in_zone(std::size_t i) const { return x_[i] >= request_.from_m && x_[i] <= request_.boundary_m; }

  const Surface& surface_;
  const FrictionMap& friction_;
  const ZoneRequest& request_;
  std::vector<double> x_;
  std::vector<ToneShape> shapes_;
  std::vector<double> weights_;          // of squared amplitudes
  std::vector<double> weights_of_mean_;  // of each point's friction in the zone's mean
  double scale_ = 1e-12;                 // m^2 per unit of the weighted sum
  bool scaled_before_ = false;           // the next scale is close to this one
};

}  // namespace turnpoint::physics
