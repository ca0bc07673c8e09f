#include "station/ui/participant/touch_judge.hpp"

#include <utility>

namespace turnpoint::ui {

void TouchJudge::open() {
  open_ = true;
  candidate_.reset();
  given_ = -1;
}

void TouchJudge::close() {
  open_ = false;
  candidate_.reset();
  given_ = -1;
}

void TouchJudge::again() { given_ = -1; }

void TouchJudge::down(const Touch& touch) {
  const bool alone = !last_down_ns_ || touch.time_ns - *last_down_ns_ > rules_.settle_ns;
  last_down_ns_ = touch.time_ns;
  if (!open_ || given_ >= 0) return;
  if (candidate_) {
    if (touch.time_ns - candidate_->time_ns <= rules_.settle_ns) candidate_.reset();
    return;
  }
  if (!alone || touch.target < 0 || touch.diameter_mm > rules_.palm_mm) return;
  candidate_ = touch;
}

void TouchJudge::cancel() { candidate_.reset(); }

std::optional<Touch> TouchJudge::decide(std::int64_t now_ns) {
  if (!open_ || !candidate_ || now_ns < candidate_->time_ns + rules_.settle_ns) return std::nullopt;
  given_ = candidate_->target;
  return std::exchange(candidate_, std::nullopt);
}

std::optional<std::int64_t> TouchJudge::due_ns() const {
  if (!candidate_) return std::nullopt;
  return candidate_->time_ns + rules_.settle_ns;
}

int TouchJudge::pressed() const { return candidate_ ? candidate_->target : given_; }

}  // namespace turnpoint::ui
