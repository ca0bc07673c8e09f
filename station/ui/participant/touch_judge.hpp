#pragma once
#include <cstdint>
#include <optional>

#include "station/core/limits.hpp"

namespace turnpoint::ui {

/// A finger that came down on the panel. Times are CLOCK_MONOTONIC.
struct Touch {
  std::int64_t time_ns = 0;
  int target = -1;         ///< index of the answer button under the finger; -1 if there is none
  double diameter_mm = 0;  ///< diameter of the contact; 0 if the panel does not report it
  int number = 0;          ///< the touch's number, which the judge passes on
};

/// Decides which touch is an answer, so that an accidental touch never becomes one. Pure: no clock, no
/// toolkit.
/// Only a single finger can answer. A touch counts if it began after the answers opened, lies on a target, is
/// not a palm, and no other touch begins within `settle_ns` before or after it. If several fingers land at
/// once, none of them answers, and the question stays open. Hands that have rested on the panel for longer
/// than that do not matter. After an answer, all further touches (such as a double tap) are ignored until the
/// answers open again. The time of an answer is the time at which its touch began; decide() returns the
/// answer `settle_ns` later.
class TouchJudge {
 public:
  struct Rules {
    std::int64_t settle_ns = core::kOneTouch_ns;
    /// a larger contact is a palm: a thumb pressed flat makes a contact of about 18 mm, a palm one of 30 mm
    /// or more
    double palm_mm = 24;
  };

  TouchJudge() = default;
  explicit TouchJudge(const Rules& rules) : rules_(rules) {}

  void open();   ///< Opens the answers. Touches that are already down can never answer.
  void close();  ///< Closes the answers.
  void again();  ///< Takes one more answer: the session did not accept the last one.
  bool is_open() const { return open_; }

  /// Reports that a finger came down. There is no call for lifting a finger, because lifting does not
  /// withdraw an answer: a quick tap is over before it has settled.
  void down(const Touch& touch);
  /// Reports that Qt has cancelled all touches (because of a system gesture or a lost device).
  void cancel();

  /// Returns the touch that is the answer, if one has settled by now. Each answer is returned only once.
  std::optional<Touch> decide(std::int64_t now_ns);
  /// The time at which to call decide() next, if a touch is settling.
  std::optional<std::int64_t> due_ns() const;
  /// Index of the answer button to draw as pressed: a touch on it is settling or was accepted. -1 if there is
  /// none.
  int pressed() const;

 private:
  Rules rules_;
  bool open_ = false;
  std::optional<Touch> candidate_;
  std::optional<std::int64_t> last_down_ns_;
  int given_ = -1;
};

}  // namespace turnpoint::ui
