#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include "station/lines/lines.hpp"

namespace turnpoint::lines {

/// What a filter made of one or more edges of a line.
struct LineChange {
  enum class Kind {
    pressed,   ///< became active, and stayed so
    released,  ///< became inactive, and stayed so
    glitch,    ///< left its level and came back before the new one had lasted long enough
    lost,      ///< is at another level although no edge said so: the kernel dropped edges
  };
  Kind kind = Kind::pressed;
  std::int64_t time_ns = 0;    ///< kernel's stamp of the first edge; for `lost` when it was noticed
  int edges = 0;               ///< of the burst that led to this; 0 for `lost`
  std::int64_t length_ns = 0;  ///< from the first to the last of these edges
  bool active = false;         ///< the level now
};

/// Tells presses from bouncing contacts and from interference, by the kernel's stamps alone. Edges closer
/// together than `hold_ns` are one burst. A burst after which the line holds its new level is a press or a
/// release, with the stamp of the burst's first edge; one after which it is back at its old level is a
/// glitch. After each change the line must stay away from the old level until `refractory_ns` have passed
/// for another change to be told; that one has its own stamp too. (The kernel's own debouncing would stamp
/// the last edge of the bouncing, milliseconds late.) Pure; times are CLOCK_MONOTONIC in ns.
///
/// A spike may come just before a press, in the same burst, so a press can be stamped too early, by at most
/// `bounce_ns`. Ganssle measured bouncing of 18 kinds of switch: 1.6 ms on average, 6.2 ms at most but for
/// one (A Guide to Debouncing, 2004).
class EdgeFilter {
 public:
  struct Rules {
    std::int64_t hold_ns = 1'500'000;
    std::int64_t refractory_ns = 50'000'000;
    std::int64_t bounce_ns = 10'000'000;  ///< a longer burst is interference
  };

  EdgeFilter(const Rules& rules, bool active) noexcept
      : rules_(rules), level_(active), stable_(active), told_(active) {}

  /// What is certain once every edge before `now_ns` has been given; call until there is nothing more.
  std::optional<LineChange> decide(std::int64_t now_ns) noexcept;

  /// The next edge, after decide() for its time; `active` is the level after it. Returns the glitch that
  /// ends where a burst has become too long for a bouncing contact.
  std::optional<LineChange> edge(std::int64_t time_ns, bool active) noexcept;

  /// The level as read at `now_ns`, when no edge is waiting. A line that stays elsewhere than its edges have
  /// left it has lost edges: its new level is then taken over, without a press that nobody can date.
  std::optional<LineChange> level(std::int64_t now_ns, bool active) noexcept;

  /// When decide() can be certain of what is open; the largest time where nothing is open.
  std::int64_t due_ns() const noexcept;

 private:
  LineChange change(LineChange::Kind kind, std::int64_t time_ns) const noexcept {
    return {kind, time_ns, edges_, last_ns_ - first_ns_, level_};
  }

  Rules rules_;
  bool level_;                     ///< after the last edge
  bool stable_;                    ///< the level that has lasted
  std::int64_t stable_since_ = 0;  ///< first edge of the burst that led to it
  bool told_;                      ///< the level that was told
  std::int64_t quiet_until_ = std::numeric_limits<std::int64_t>::min();
  bool in_burst_ = false;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  int edges_ = 0;
  std::optional<std::int64_t> elsewhere_since_;  ///< the level read is not the level known
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

}  // namespace turnpoint::lines
