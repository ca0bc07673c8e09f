#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include "station/io/lines.hpp"

namespace turnpoint::io {

/// What the filter concludes from one or more edges of a line.
struct LineChange {
  enum class Kind {
    pressed,   ///< the line became active and stayed active
    released,  ///< the line became inactive and stayed inactive
    glitch,    ///< the line changed its level and changed back before the new level had lasted long enough
    lost,      ///< the level changed, but no edge was reported: the kernel dropped edges
  };
  Kind kind = Kind::pressed;
  /// kernel's time stamp of the first edge; for `lost`, the time at which the change was noticed
  std::int64_t time_ns = 0;
  int edges = 0;               ///< number of edges in the burst; 0 for `lost`
  std::int64_t length_ns = 0;  ///< time from the first to the last of these edges
  bool active = false;         ///< whether the line is active now
};

/// Distinguishes presses from bouncing contacts and from interference. It uses the kernel's time stamps only.
/// Edges closer together than `hold_ns` form a burst. If the line holds its new level after a burst, that is
/// a press or a release, with the time stamp of the burst's first edge. If the line returns to its old level,
/// that is a glitch. After each press or release there is a dead time of `refractory_ns`: a further change is
/// reported only if it still holds after the dead time, with its own time stamp. (The kernel's debouncing
/// would stamp the last edge of the bouncing, milliseconds late.) Pure; times are CLOCK_MONOTONIC in ns. If a
/// spike comes just before a press, both are in the same burst, so the press is stamped too early, by at most
/// `bounce_ns`. Ganssle measured the bouncing of 18 kinds of switch: 1.6 ms on average, and at most 6.2 ms
/// with one exception (A Guide to Debouncing, 2004).
class EdgeFilter {
 public:
  struct Rules {
    std::int64_t hold_ns = 1'500'000;
    std::int64_t refractory_ns = 50'000'000;
    std::int64_t bounce_ns = 10'000'000;  ///< a longer burst counts as interference
  };

  EdgeFilter(const Rules& rules, bool active) noexcept
      : rules_(rules), level_(active), stable_(active), told_(active) {}

  /// Returns a press, release or glitch that is certain. Before the call, all edges before `now_ns` must have
  /// been passed to edge(). Call until it returns nothing.
  std::optional<LineChange> decide(std::int64_t now_ns) noexcept;

  /// Takes the next edge; first call decide() with the time of this edge. `active` is the level after the
  /// edge. Returns a glitch if the burst has become too long for a bouncing contact.
  std::optional<LineChange> edge(std::int64_t time_ns, bool active) noexcept;

  /// Takes the level that was read at `now_ns` while no edge was waiting. If this level goes on differing
  /// from the level after the last edge, edges were lost. The new level is then accepted, but not reported as
  /// a press, because its time is unknown.
  std::optional<LineChange> level(std::int64_t now_ns, bool active) noexcept;

  /// The time at which decide() can judge the current burst; the largest time if there is none.
  std::int64_t due_ns() const noexcept;

 private:
  LineChange change(LineChange::Kind kind, std::int64_t time_ns) const noexcept {
    return {kind, time_ns, edges_, last_ns_ - first_ns_, level_};
  }

  Rules rules_;
  bool level_;                     ///< level after the last edge
  bool stable_;                    ///< the latest level that lasted at least `hold_ns`
  std::int64_t stable_since_ = 0;  ///< time of the first edge of the burst that led to the stable level
  bool told_;                      ///< the level that was reported last
  std::int64_t quiet_until_ = std::numeric_limits<std::int64_t>::min();
  bool in_burst_ = false;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  int edges_ = 0;
  /// time since when readings of the line have differed from `level_`
  std::optional<std::int64_t> elsewhere_since_;
};

/// Detects lost edges from the kernel's per-line sequence numbers.
class SequenceCheck {
 public:
  /// Returns the number of edges that were lost just before the edge with this sequence number.
  std::uint32_t missed_before(std::uint32_t sequence) noexcept {
    const std::uint32_t missed = last_ == 0 ? 0 : sequence - last_ - 1;
    last_ = sequence;
    return missed;
  }

 private:
  std::uint32_t last_ = 0;
};

}  // namespace turnpoint::io
