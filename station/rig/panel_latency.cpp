#include "station/rig/panel_latency.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/median.hpp"

namespace turnpoint::rig {

namespace {

/// Returns the delay between a touch and the matching edge of the reference signal (button or photodiode);
/// empty unless exactly one edge matches.
std::optional<std::int64_t> lag_ns(std::int64_t touch_ns, const std::vector<std::int64_t>& edges_ns,
                                   LatencyReference reference) {
  const bool before = reference == LatencyReference::button;
  const auto from = before ? touch_ns - kLongestLatency_ns : touch_ns;
  const auto to = before ? touch_ns : touch_ns + kLongestLatency_ns;
  const auto first = std::lower_bound(edges_ns.begin(), edges_ns.end(), from);
  const auto end = std::upper_bound(first, edges_ns.end(), to);
  if (end - first != 1) return std::nullopt;
  return std::abs(*first - touch_ns);
}

}  // namespace

std::optional<Delay> pair_delays(std::vector<std::int64_t> touches_ns, std::vector<std::int64_t> edges_ns,
                                 LatencyReference reference) {
  std::sort(touches_ns.begin(), touches_ns.end());
  std::sort(edges_ns.begin(), edges_ns.end());
  std::vector<double> lags_s;
  Delay delay;
  for (const auto touch_ns : touches_ns) {
    const auto lag = lag_ns(touch_ns, edges_ns, reference);
    if (lag)
      lags_s.push_back(static_cast<double>(*lag) * 1e-9);
    else
      ++delay.unmatched;
  }
  delay.pairs = static_cast<int>(lags_s.size());
  if (delay.pairs < 2) return std::nullopt;
  delay.median_s = core::median(lags_s);
  double mean_s = 0, squares = 0;
  for (const double lag : lags_s) mean_s += lag / delay.pairs;
  for (const double lag : lags_s) squares += (lag - mean_s) * (lag - mean_s);
  delay.sd_s = std::sqrt(squares / (delay.pairs - 1));
  return delay;
}

}  // namespace turnpoint::rig
