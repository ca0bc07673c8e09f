#include "station/rehearsal/cue_kinds.hpp"

#include <algorithm>

namespace turnpoint::rehearsal {

double value_of(const CueKind& kind, const Interval& interval, Feature feature, double share) {
  if (kind.source == Source::nothing) return 0;
  const auto number = static_cast<std::size_t>(feature) - static_cast<std::size_t>(Feature::one);
  const bool is_one = feature >= Feature::one;
  if (kind.source == Source::duration) {
    if (!is_one) return interval.duration_s;
    return number < interval.lengths_s.size() ? interval.lengths_s[number] : 0;
  }
  const auto at = [&](std::size_t scene) {
    return interval.scenes[scene].at(interval.rove_dB[scene] * share).*kind.cue;
  };
  const auto last = interval.scenes.size() - 1;
  if (is_one) return at(std::min(number, last));
  if (feature == Feature::first) return at(0);
  return feature == Feature::last ? at(last) : at(last) - at(0);
}

bool roves(const CueKind& kind, const Interval& interval) {
  if (kind.source != Source::surface) return false;
  const bool by_edge = std::any_of(interval.scenes.begin(), interval.scenes.end(),
                                   [](const RovedCues& cues) { return cues.low.has_value(); });
  return (kind.follows_strength || by_edge) &&
         std::any_of(interval.rove_dB.begin(), interval.rove_dB.end(), [](double dB) { return dB > 0; });
}

}  // namespace turnpoint::rehearsal
