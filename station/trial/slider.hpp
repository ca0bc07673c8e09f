#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::trial {

/// What a slider shows and allows in one trial. `shown_low` to `shown_high` is a random window around the
/// range: the same place on the screen means another setting in each trial, so that only the finger can tell.
struct SliderSpan {
  double low = 0, high = 1;  ///< settings that the surface follows, in the unit of the factor
  double step = 0;           ///< settings are low + k step
  double shown_low = 0, shown_high = 1;
};

/// How long the surface takes to follow, and how often it is given something new to follow: the finger feels
/// one movement, and the drive never has two glides at once.
inline constexpr double kGlide_s = 0.03, kGlideEvery_s = 0.05;

/// A setting while it is adjusted. Pure: moves in, glides out.
class Slider {
 public:
  Slider(const SliderSpan& span, double start) : span_(span), setting_(start), asked_(start), felt_(start) {}

  /// To the nearest step inside the range; what is not finite is ignored.
  void move(double wanted);
  /// Where the slider stands.
  double setting() const { return setting_; }
  /// The last setting that the surface was given: what Done is about.
  double felt() const { return felt_; }

  /// When the surface should be moved next; none when it is where the setting is.
  std::optional<std::int64_t> glide_due_ns() const;
  /// The surface is asked to follow now; returns the setting to follow, which followed() makes the felt one.
  double glide(std::int64_t now_ns);
  void followed() { felt_ = asked_; }

 private:
  SliderSpan span_;
  double setting_, asked_, felt_;
  std::int64_t next_glide_ns_ = 0;
};

}  // namespace turnpoint::trial
