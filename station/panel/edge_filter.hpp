#pragma once
#include <cstdint>

#include "station/panel/lines.hpp"

namespace turnpoint::panel {

/// Turns the bouncing of a contact into one event: the first edge counts, with its own stamp, and for a
/// refractory time nothing else does. (The kernel's debouncing would report the last edge, milliseconds
/// later.) Pure.
class EdgeFilter {
 public:
  enum class Result {
    ignored,   ///< bouncing, or a level that did not change
    pressed,   ///< became active
    released,  ///< became inactive
  };

  EdgeFilter(std::int64_t refractory_ns, bool active) noexcept
      : refractory_ns_(refractory_ns), active_(active) {}

  /// Edges in the order of their stamps; `active` is the level after the edge.
  Result edge(std::int64_t time_ns, bool active) noexcept;

  /// When bouncing has ended the level may differ from what was reported: call once `settles_ns` is past.
  std::int64_t settles_ns() const noexcept { return quiet_from_ns_; }
  Result settle(std::int64_t time_ns, bool level_active) noexcept;

 private:
  std::int64_t refractory_ns_;
  bool active_;
  std::int64_t quiet_from_ns_ = 0;
};

/// Sees from the kernel's per-line sequence numbers how many edges were lost before one.
class SequenceCheck {
 public:
  /// The number of edges lost just before this one.
  std::uint32_t missed_before(std::uint32_t sequence) noexcept {
    const std::uint32_t missed = last_ == 0 ? 0 : sequence - last_ - 1;
    last_ = sequence;
    return missed;
  }

 private:
  std::uint32_t last_ = 0;
};

}  // namespace turnpoint::panel
