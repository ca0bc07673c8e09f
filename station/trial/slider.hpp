#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::trial {

/// The display and the limits of a slider in one trial. `shown_low` to `shown_high` is a random window around
/// the range. The same place on the screen is therefore a different setting in each trial, so that only the
/// finger can tell.
struct SliderSpan {
  double low = 0, high = 1;  ///< limits of the settings that the surface follows, in the unit of the factor
  double step = 0;           ///< possible settings are low + k * step
  double shown_low = 0, shown_high = 1;
};

/// How long the surface takes to follow, and how often it gets a new setting to follow. The finger feels one
/// continuous movement, and the drive never has two glides at once.
inline constexpr double kGlide_s = 0.03, kGlideEvery_s = 0.05;

/// A setting during its adjustment. Pure: moves go in, glides come out.
class Slider {
 public:
  Slider(const SliderSpan& span, double start) : span_(span), setting_(start), asked_(start), felt_(start) {}

  /// Moves to the nearest step inside the range. Values that are not finite are ignored.
  void move(double wanted);
  /// The slider's position.
  double setting() const { return setting_; }
  /// The last setting that the surface has followed: Done confirms this one.
  double felt() const { return felt_; }

  /// When the surface should be moved next; empty if it is already at the setting.
  std::optional<std::int64_t> glide_due_ns() const;
  /// Call this when the surface is asked to follow. Returns the setting to follow; followed() then makes it
  /// the felt one.
  double glide(std::int64_t now_ns);
  void followed() { felt_ = asked_; }

 private:
  SliderSpan span_;
  double setting_, asked_, felt_;
  std::int64_t next_glide_ns_ = 0;
};

}  // namespace turnpoint::trial
