#pragma once
#include <cstdint>
#include <optional>

#include "station/terms/limits.hpp"

namespace turnpoint::ui {

/// A finger that came down on the panel. Times are CLOCK_MONOTONIC.
struct Touch {
  std::int64_t time_ns = 0;
  int target = -1;         ///< index of the answer under it; -1 if there is none
  double diameter_mm = 0;  ///< diameter of the contact; 0 if the panel does not report it
};

/// Decides which touch is an answer, so that no slip ever becomes one. Pure: no clock, no toolkit.
/// Only a single finger can answer. A touch counts if it began after the answers opened, lies on a target, is
/// not a palm, and no other touch begins within `settle_ns` before or after it. If several fingers land at
/// once, none of them answers, and the question stays open. Hands that have rested on the panel for longer do
/// not block. After one answer all others (a double tap) are ignored until the answers open again. The answer
/// has the time at which the touch began, and is returned `settle_ns` later.
class TouchJudge {
 public:
  struct Rules {
    std::int64_t settle_ns = terms::kOneTouch_ns;
    double palm_mm = 24;  ///< a thumb pressed flat makes about 18 mm, a palm 30 or more
  };
  struct Answer {
    int target = 0;
    std::int64_t time_ns = 0;
  };

  TouchJudge() = default;
  explicit TouchJudge(const Rules& rules) : rules_(rules) {}

  void open();   ///< Answers open now. Touches that are already down can never answer.
  void close();  ///< answers close
  bool is_open() const { return open_; }

  /// A finger came down. Lifting does not matter: a quick tap is over before it has settled, and lifting does
  /// not withdraw an answer.
  void down(const Touch& touch);
  /// The toolkit cancelled all touches (a gesture of the system, a lost device).
  void cancel();

  /// The answer, if one has settled by now. Each answer is returned only once.
  std::optional<Answer> decide(std::int64_t now_ns);
  /// When to ask decide() next, if a touch is settling.
  std::optional<std::int64_t> due_ns() const;
  /// The target to show as pressed, because it is settling or was accepted; -1: none.
  int pressed() const;

 private:
  Rules rules_;
  bool open_ = false;
  std::optional<Touch> candidate_;
  std::optional<std::int64_t> last_down_ns_;
  int given_ = -1;
};

}  // namespace turnpoint::ui
