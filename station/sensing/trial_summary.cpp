#include "station/sensing/trial_summary.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "station/analysis/quantile.hpp"

namespace turnpoint::sensing {

TrialSummary summarise(std::span<const FingerPoint> track, Band band, std::span<const Stroke> strokes,
                       const MovementWindow& window) {
  TrialSummary summary;
  const auto contacts = std::ranges::count_if(track, [](const FingerPoint& point) { return point.contact; });
  summary.contact_s = static_cast<double>(contacts) / points_per_second(band);
  summary.strokes = static_cast<int>(strokes.size());

  std::vector<double> normal_N, speed_mm_s;
  for (const Stroke& stroke : strokes)
    for (const auto& point : track.subspan(stroke.first, stroke.end - stroke.first)) {
      normal_N.push_back(point.normal_N);
      speed_mm_s.push_back(std::abs(point.speed_mm_s));
    }
  if (normal_N.size() > 1) {
    const auto share = [](const std::vector<double>& values, double least, double most) {
      if (most == MovementWindow::any) return TrialSummary::none;
      const auto inside =
          std::ranges::count_if(values, [&](double value) { return value >= least && value <= most; });
      return static_cast<double>(inside) / static_cast<double>(values.size());
    };
    summary.normal_N = analysis::mean(normal_N);
    summary.normal_sd_N = std::sqrt(analysis::variance(normal_N));
    summary.normal_in_window = share(normal_N, window.least_normal_N, window.most_normal_N);
    summary.speed_mm_s = analysis::mean(speed_mm_s);
    summary.speed_in_window = share(speed_mm_s, window.least_speed_mm_s, window.most_speed_mm_s);
  }
  return summary;
}

Movement judge(const TrialSummary& summary, const MovementWindow& window) {
  if (summary.strokes < window.strokes) return Movement::strokes;
  // the comparisons below are false for NaN, which means "not asked for" or "no stroke"
  if (summary.normal_in_window < window.fraction) {
    const double middle_N = (window.least_normal_N + window.most_normal_N) / 2;
    return summary.normal_N < middle_N ? Movement::light : Movement::hard;
  }
  if (summary.speed_in_window < window.fraction) {
    const double middle_mm_s = (window.least_speed_mm_s + window.most_speed_mm_s) / 2;
    return summary.speed_mm_s < middle_mm_s ? Movement::slow : Movement::fast;
  }
  return Movement::ok;
}

const char* name(Movement movement) {
  switch (movement) {
    case Movement::ok:
      return "ok";
    case Movement::strokes:
      return "strokes";
    case Movement::light:
      return "light";
    case Movement::hard:
      return "hard";
    case Movement::slow:
      return "slow";
    case Movement::fast:
      return "fast";
  }
  return "";
}

}  // namespace turnpoint::sensing
