#pragma once
#include <array>
#include <span>
#include <type_traits>
#include <vector>

#include "physics/friction.hpp"
#include "station/follow/pattern.hpp"

namespace turnpoint::follow {

/// Converts between the gain of a drive plan (1: as planned) and the relative friction that a finger meets at
/// a place of the strip. All tones of the plan share the gain, so the displacement at a place is the gain
/// times the planned one, and friction is averaged over the fingertip. Built from fine tables in the
/// constructor; its const functions only look up: 128 places, 65 levels, error below 0.003 of friction.
/// Places beyond the strip count as its ends.
class GainMap {
 public:
  static constexpr int kPlaces = 128, kLevels = 65;

  GainMap() = default;
  /// The planned displacement without a finger (peak, root of summed squares over the tones) at two or more
  /// ascending places; the share of it, from 0 to 1, that a finger leaves under its whole fingertip if its
  /// middle is at this place (empty: all of it); friction over displacement under the finger; length of the
  /// fingertip; and the largest gain that the rig allows. Throws std::invalid_argument for values that are
  /// not possible.
  GainMap(std::span<const double> x_m, std::span<const double> displacement_m,
          std::span<const double> finger_share, const physics::FrictionMap& friction, double fingertip_m,
          double most_gain);

  /// Relative friction (1: the surface at rest) at a gain from 0 to most_gain().
  double relative_friction(double place_m, double gain) const noexcept;
  /// The gain that gives this relative friction: 0 for 1 and more, most_gain() below lowest_friction().
  double gain(double place_m, double relative_friction) const noexcept;
  /// The gain that gives this displacement under the finger, at most most_gain().
  double gain_for_displacement(double place_m, double displacement_m) const noexcept;
  /// The lowest relative friction that can be reached at a place; the highest is 1 everywhere.
  double lowest_friction(double place_m) const noexcept;
  /// Displacement under the finger at the largest gain, averaged over the fingertip.
  double most_displacement_m(double place_m) const noexcept;

  double first_m() const noexcept { return first_m_; }
  double last_m() const noexcept { return first_m_ + (kPlaces - 1) * step_m_; }
  double most_gain() const noexcept { return most_gain_; }

 private:
  struct Between {
    std::size_t i;
    double t;
  };
  Between between(double place_m) const noexcept;

  double first_m_ = 0, step_m_ = 1, most_gain_ = 1;
  std::array<float, kPlaces> lowest_{}, displacement_m_{};
  /// drop_[place][level]: the square root of 1 - friction at even steps of gain
  std::array<std::array<float, kLevels>, kPlaces> drop_{};
  /// gain_[place][level]: the gain at even steps of the square root of (1 - friction)/(1 - lowest)
  std::array<std::array<float, kLevels>, kPlaces> gain_{};
};
static_assert(std::is_trivially_copyable_v<GainMap>);

/// A stretch of the strip in which a pattern asks for what cannot be presented, with the largest miss in it.
struct Unmet {
  double from_m = 0, to_m = 0;
  double at_m = 0, asked = 0;  ///< the place of the largest miss, and what is asked for there
  double least = 0, most = 0;  ///< what can be presented there
};

/// Where a pattern asks for more than `tolerance` (in its own unit) beyond what can be presented, from
/// begin_m to end_m, in steps of 0.1 mm: without the events and with all of them, at all times.
/// `resting_friction` is the coefficient of friction of the surface at rest; it is not used for a pattern of
/// displacement.
std::vector<Unmet> unmet(const Pattern& pattern, const GainMap& map, double resting_friction, double begin_m,
                         double end_m, double tolerance);

}  // namespace turnpoint::follow
