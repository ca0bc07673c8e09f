#include "station/rehearsal/cue_kinds.hpp"

namespace turnpoint::rehearsal {

double value_of(const CueKind& kind, const Interval& interval, Feature feature, double rove_dB) {
  if (kind.source == Source::nothing) return 0;
  if (kind.source == Source::duration) return interval.duration_s;
  if (feature == Feature::first) return interval.first.at(rove_dB).*kind.cue;
  const double last = interval.last.at(rove_dB).*kind.cue;
  return feature == Feature::last ? last : last - interval.first.at(rove_dB).*kind.cue;
}

bool roves(const CueKind& kind, const Interval& interval) {
  const bool by_edge = interval.first.low || interval.last.low;
  return interval.first.rove_dB > 0 && kind.source == Source::surface && (kind.follows_strength || by_edge);
}

}  // namespace turnpoint::rehearsal
