#include "station/panel/edge_filter.hpp"

namespace turnpoint::panel {

EdgeFilter::Result EdgeFilter::edge(std::int64_t time_ns, bool active) noexcept {
  if (time_ns < quiet_from_ns_ || active == active_) return Result::ignored;
  active_ = active;
  quiet_from_ns_ = time_ns + refractory_ns_;
  return active ? Result::pressed : Result::released;
}

EdgeFilter::Result EdgeFilter::settle(std::int64_t time_ns, bool level_active) noexcept {
  if (time_ns < quiet_from_ns_ || level_active == active_) return Result::ignored;
  active_ = level_active;
  quiet_from_ns_ = time_ns + refractory_ns_;
  return level_active ? Result::pressed : Result::released;
}

}  // namespace turnpoint::panel
