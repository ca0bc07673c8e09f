#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace turnpoint::rig {

/// Statistics of the delays, in seconds, between touches and the matching edges of a reference signal.
struct Delay {
  double median_s = 0;
  double sd_s = 0;  ///< standard deviation: the jitter
  int pairs = 0;
  int unmatched = 0;  ///< touches without exactly one matching edge
};

/// The source of the reference edges. A button under the finger (or a stylus that closes a contact) gives the
/// time at which the panel was touched, so it measures input latency. The screen flashes a square at each
/// touch; a photodiode on this square gives the time of the light, so it measures display latency.
enum class LatencyReference { button, photodiode };

/// The latency of a touch panel: from the finger's contact to the time stamp of the touch (input), and from
/// the time stamp to the light on the screen (display).
struct PanelLatency {
  std::string made_on;         ///< date, YYYY-MM-DD
  std::string quality;         ///< source of the touches' time stamps: kernel | toolkit
  std::optional<Delay> touch;  ///< from the finger's contact to the touch's time stamp
  std::optional<Delay> flash;  ///< from the touch's time stamp to the light on the screen
};

/// The smallest number of pairs from which a latency is computed. Fewer pairs would say little about jitter.
inline constexpr int kLeastPairs = 10;
/// If a touch and an edge are further apart than this, they are unrelated.
inline constexpr std::int64_t kLongestLatency_ns = 400'000'000;

/// Pairs each touch with the edge before it (button) or after it (photodiode) within kLongestLatency_ns. A
/// touch with no such edge, or with several, counts as unmatched. Times are CLOCK_MONOTONIC, in any order.
/// Empty with fewer than two pairs.
std::optional<Delay> pair_delays(std::vector<std::int64_t> touches_ns, std::vector<std::int64_t> edges_ns,
                                 LatencyReference reference);

}  // namespace turnpoint::rig
