#include "station/io/edge_filter.hpp"

#include <algorithm>

namespace turnpoint::io {

using Kind = LineChange::Kind;

std::optional<LineChange> EdgeFilter::decide(std::int64_t now_ns) noexcept {
  if (in_burst_ && now_ns >= last_ns_ + rules_.hold_ns) {
    in_burst_ = false;
    if (level_ == stable_) return change(Kind::glitch, first_ns_);
    stable_ = level_;
    stable_since_ = first_ns_;
  }
  if (stable_ == told_ || now_ns < quiet_until_) return std::nullopt;
  told_ = stable_;
  quiet_until_ = stable_since_ + rules_.refractory_ns;
  return change(told_ ? Kind::pressed : Kind::released, stable_since_);
}

std::optional<LineChange> EdgeFilter::edge(std::int64_t time_ns, bool active) noexcept {
  std::optional<LineChange> too_long;
  if (in_burst_ && time_ns > first_ns_ + rules_.bounce_ns) {
    too_long = change(Kind::glitch, first_ns_);
    in_burst_ = false;
  }
  if (!in_burst_) {
    in_burst_ = true;
    first_ns_ = time_ns;
    edges_ = 0;
  }
  last_ns_ = time_ns;
  ++edges_;
  level_ = active;
  elsewhere_since_.reset();
  return too_long;
}

std::optional<LineChange> EdgeFilter::level(std::int64_t now_ns, bool active) noexcept {
  if (in_burst_ || active == level_) {
    elsewhere_since_.reset();
    return std::nullopt;
  }
  // A single reading that differs does not prove a lost edge, because the report of the edge may still
  // arrive.
  if (!elsewhere_since_) elsewhere_since_ = now_ns;
  if (now_ns < *elsewhere_since_ + std::max(rules_.hold_ns, std::int64_t{1})) return std::nullopt;
  elsewhere_since_.reset();
  level_ = stable_ = told_ = active;
  return LineChange{Kind::lost, now_ns, 0, 0, active};
}

std::int64_t EdgeFilter::due_ns() const noexcept {
  if (in_burst_) return last_ns_ + rules_.hold_ns;
  return stable_ == told_ ? std::numeric_limits<std::int64_t>::max() : quiet_until_;
}

}  // namespace turnpoint::io
