#pragma once
// The working state of a zone design: tones, their shapes on a grid, and the friction that a fingertip feels.
#include <optional>
#include <vector>

#include "physics/zone.hpp"

namespace turnpoint::physics {

// Squared amplitude of one tone on a grid, relative to its last maximum, and the drive amplitude that the
// tone needs.
struct ToneShape {
  double frequency_Hz = 0;
  double drive_gain = 1;  // |v(0)| divided by |v| at the last maximum
  std::vector<double> square;
};

class ZoneProfile {
 public:
  // Chooses up to request.tones tones at and below `highest_Hz`, and their relative weights. Non-negative
  // least squares finds the weights that make the squared amplitude in the zone as uniform as possible.
  ZoneProfile(const Surface& surface, const FrictionMap& friction, ZoneRequest request, double highest_Hz);

  double highest_Hz() const { return shapes_.front().frequency_Hz; }
  // Shifts all tones by the same frequency difference, so that the highest is at `highest_Hz`, and recomputes
  // their shapes. A tone that would leave the band stays at the band's lower end, or is removed if it would
  // be too close to the next tone there.
  void shift_to(double highest_Hz);
  // Scales the amplitudes of all tones together so that the mean friction in the zone has the desired value.
  // Throws Refused if no level does.
  void scale_to_friction();
  // Finds the levels for another mean friction, for the same tones as before: the result is the one that a
  // new profile would have, if the place of its edge does not depend on friction. Throws as
  // scale_to_friction().
  void rescale_to_friction(double friction);
  // Position of the edge in the amplitude profile that all tones of the zone produce together; empty if there
  // is none.
  std::optional<double> edge_m() const;
  double edge_slope_m_per_Hz() const;
  std::vector<Tone> tones() const;
  void measure(ZoneDesign& design) const;

 private:
  ToneShape shape(double frequency_Hz) const;
  void choose_tones(double highest_Hz);
  std::vector<double> fit(const std::vector<const ToneShape*>& shapes, double& residual) const;
  std::vector<double> summed() const;
  void scale(const std::vector<double>& sum);
  std::vector<double> felt(double scale) const;
  double zone_mean(const std::vector<double>& values) const;
  std::vector<double> mean_weights() const;
  bool in_zone(std::size_t i) const { return x_[i] >= request_.from_m && x_[i] <= request_.boundary_m; }

  const Surface& surface_;
  const FrictionMap& friction_;
  ZoneRequest request_;
  std::vector<double> x_;
  std::vector<ToneShape> shapes_;
  std::vector<double> weights_;          // weight of each tone's squared amplitude
  std::vector<double> weights_of_mean_;  // weight of each point's friction in the zone's mean
  // factor (m^2) that turns the weighted sum of squared shapes into squared displacement
  static constexpr double first_scale_m2 = 1e-12;
  double scale_ = first_scale_m2;
  bool scaled_before_ = false;               // true once `scale_` was found; the next search starts from it
  std::vector<std::vector<double>> scaled_;  // the sums for which levels were found, in this order
};

}  // namespace turnpoint::physics
