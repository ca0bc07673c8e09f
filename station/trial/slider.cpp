#include "station/trial/slider.hpp"

#include <algorithm>
#include <cmath>

#include "station/procedure/grid.hpp"

namespace turnpoint::trial {

void Slider::move(double wanted) {
  if (!std::isfinite(wanted)) return;
  const auto steps = std::llround((std::clamp(wanted, span_.low, span_.high) - span_.low) / span_.step);
  setting_ = std::min(procedure::at_step(span_.low, steps, span_.step), span_.high);
}

std::optional<std::int64_t> Slider::glide_due_ns() const {
  return setting_ == asked_ ? std::nullopt : std::optional(next_glide_ns_);
}

double Slider::glide(std::int64_t now_ns) {
  next_glide_ns_ = now_ns + static_cast<std::int64_t>(kGlideEvery_s * 1e9);
  return asked_ = setting_;
}

}  // namespace turnpoint::trial
