#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace turnpoint::calibration {

/// Delays between pairs of events; seconds.
struct Delay {
  double median_s = 0;
  double sd_s = 0;  ///< about the mean: the jitter
  int pairs = 0;
  int unmatched = 0;  ///< touches without exactly one partner
};

/// Against what touches were compared. A button under the finger (or a stylus that closes a contact) tells
/// when the panel was touched, so it gives the way in; a photodiode on the flash that answers each touch
/// gives the way out, up to light.
enum class LatencyReference { button, photodiode };

/// A touch panel's own latency, by the time stamps that its answers have.
struct PanelLatency {
  std::string made_on;         ///< YYYY-MM-DD
  std::string quality;         ///< of the touches' time stamps: kernel | toolkit
  std::optional<Delay> touch;  ///< from the finger to the time stamp
  std::optional<Delay> flash;  ///< from the time stamp to light
};

/// Fewest pairs for a latency: fewer tell little about jitter.
inline constexpr int kLeastPairs = 10;
/// Longer than this apart, a touch and an edge have nothing to do with each other.
inline constexpr std::int64_t kLongestLatency_ns = 400'000'000;

/// Pairs each touch with the one edge before it (button) or after it (photodiode) within kLongestLatency_ns.
/// A touch with none or with more than one counts as unmatched, never as a guess. Times are CLOCK_MONOTONIC,
/// in any order. None with fewer than two pairs.
std::optional<Delay> pair_delays(std::vector<std::int64_t> touches_ns, std::vector<std::int64_t> edges_ns,
                                 LatencyReference reference);

}  // namespace turnpoint::calibration
