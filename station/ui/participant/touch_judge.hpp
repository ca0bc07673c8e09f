#pragma once
#include <cstdint>
#include <optional>

#include "station/terms/limits.hpp"

namespace turnpoint::ui {

/// A finger that came down on the panel. Times are CLOCK_MONOTONIC.
struct Touch {
  std::int64_t time_ns = 0;
  int target = -1;         ///< index of the answer under it, -1 for none
  double diameter_mm = 0;  ///< of the contact; 0 where the panel does not tell
};

/// Decides which touch is an answer, so that no slip ever becomes one. Pure: no clock, no toolkit.
///
/// One finger alone answers. A touch counts if it began after the answers opened, lies on a target, is no
/// palm, and no other touch begins within `settle_ns` before or after it; ten fingers at once are nobody's
/// answer, and leave the question open. Hands that rest on the panel for longer do not block. After one
/// answer all others (a double tap) are ignored until the answers open anew. The answer carries the time at
/// which the touch began, and is given `settle_ns` after it.
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

  void open();   ///< answers open now: all touches that are down already can never answer
  void close();  ///< no answer wanted
  bool is_open() const { return open_; }

  /// Lifting is not asked about: a quick tap is over before it has settled, and takes no answer back.
  void down(const Touch& touch);
  /// The toolkit took all touches away (a gesture of the system, a lost device).
  void cancel();

  /// The answer, once, if one has settled by now.
  std::optional<Answer> decide(std::int64_t now_ns);
  /// When to ask decide() next, if a touch is settling.
  std::optional<std::int64_t> due_ns() const;
  /// The target to show as pressed: settling or given. -1: none.
  int pressed() const;

 private:
  Rules rules_;
  bool open_ = false;
  std::optional<Touch> candidate_;
  std::optional<std::int64_t> last_down_ns_;
  int given_ = -1;
};

}  // namespace turnpoint::ui
