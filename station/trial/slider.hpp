#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::trial {

/// The limits and the display of a slider in one trial. The screen shows a window from `shown_low` to
/// `shown_high`, which is placed at random around the range. A given position on the screen is therefore a
/// different setting in each trial, so that participants cannot repeat a setting by its position.
struct SliderSpan {
  double low = 0, high = 1;  ///< limits of the settings, in the unit of the factor
  double step = 0;           ///< possible settings are low + k * step
  double shown_low = 0, shown_high = 1;
  bool operator==(const SliderSpan&) const = default;
};

/// Duration of one glide of the surface to a new setting, and time from the start of one glide to the next.
/// Glides never overlap. To the finger, successive glides are one continuous movement.
inline constexpr double kGlide_s = 0.03, kGlideEvery_s = 0.05;

/// Decides, while a participant moves the slider, when the surface glides to which setting. It uses no clock
/// and no device.
class Slider {
 public:
  Slider(const SliderSpan& span, double start) : span_(span), setting_(start), asked_(start), felt_(start) {}

  /// Moves the slider to the nearest step inside the range. Ignores values that are not finite.
  void move(double wanted);
  /// The slider's position.
  double setting() const { return setting_; }
  /// The last setting to which the surface has begun to glide. The Done button confirms this setting.
  double felt() const { return felt_; }

  /// The time at which the surface should glide to the setting; empty if the surface is already there.
  std::optional<std::int64_t> glide_due_ns() const;
  /// Starts a glide. Returns the setting to which the surface must glide. Call followed() once the glide has
  /// begun; felt() then returns this setting.
  double glide(std::int64_t now_ns);
  void followed() { felt_ = asked_; }

 private:
  SliderSpan span_;
  double setting_, asked_, felt_;
  std::int64_t next_glide_ns_ = 0;
};

}  // namespace turnpoint::trial
