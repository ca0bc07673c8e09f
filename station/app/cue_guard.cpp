#include "station/app/cue_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "station/app/cue_table.hpp"
#include "station/app/one_cue.hpp"
#include "station/protocol/combinations.hpp"
#include "station/session/trial_orders.hpp"

namespace turnpoint::app {

namespace {

using protocol::Protocol;
using protocol::TaskKind;

enum class Source { surface, duration, nothing };

struct CueKind {
  const char* name;
  const char* unit;
  double scale;
  Source source;
  double scene::Cues::*cue;
  bool follows_strength;  ///< roving always moves it
};

constexpr CueKind cue_kinds[] = {
    {"pitch", "Hz", 1, Source::surface, &scene::Cues::pitch_Hz, false},
    {"loudness", "dB", 1, Source::surface, &scene::Cues::loudness_dB, true},
    {"amplitude at the wide end", "um", 1e6, Source::surface, &scene::Cues::wide_end_amplitude_m, true},
    {"stripe pitch at the wide end", "mm", 1e3, Source::surface, &scene::Cues::stripe_pitch_m, false},
    {"edge sharpness", "mm", 1e3, Source::surface, &scene::Cues::edge_width_m, false},
    {"strip width", "mm", 1e3, Source::surface, &scene::Cues::strip_width_m, false},
    {"duration", "s", 1, Source::duration, nullptr, false},
    {"always the same key", "", 1, Source::nothing, nullptr, false},
};

constexpr double smallest_difference = 1e-3, smallest_difference_dB = 0.01;

/// Trials for which a cue cannot be known.
struct NotPlanned : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What one interval of a trial offers, before its strength is drawn.
struct Interval {
  RovedCues first, last;
  bool change = false;
  double duration_s = 0;
};

struct Presentation {
  std::vector<Interval> intervals;
  std::optional<int> correct;
  double weight = 0;
};

/// Which number of an interval of two scenes is attended to.
enum class Feature { last, change, first };

double number_of(const CueKind& kind, const Interval& interval, Feature feature, double rove_dB) {
  if (kind.source == Source::nothing) return 0;
  if (kind.source == Source::duration) return interval.duration_s;
  if (feature == Feature::first) return interval.first.at(rove_dB).*kind.cue;
  const double last = interval.last.at(rove_dB).*kind.cue;
  return feature == Feature::last ? last : last - interval.first.at(rove_dB).*kind.cue;
}

std::pair<double, double> range_of(const std::vector<Look>& looks, std::size_t intervals) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& look : looks)
    for (std::size_t i = 0; i < intervals; ++i)
      low = std::min(low, look.x[i]), high = std::max(high, look.x[i]);
  return {low, high};
}

class Guard {
 public:
  Guard(const Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey)
      : protocol_(protocol), table_(protocol, rig, survey) {}

  std::vector<CueReport> reports(const TrialCensus& census);

 private:
  Interval interval_of(const std::vector<std::string>& scenes, const protocol::Factors& factors);
  std::vector<Presentation> presentations(const TrialCensus& census);
  static std::vector<Look> looks(const CueKind& kind, Feature feature, const std::vector<Presentation>& all);
  CueReport report(const CueKind& kind, const std::vector<Presentation>& all) const;
  double guessing() const { return 1.0 / static_cast<double>(protocol_.task.choices.size()); }

  const Protocol& protocol_;
  CueTable table_;
};

Interval Guard::interval_of(const std::vector<std::string>& scenes, const protocol::Factors& factors) {
  const auto cues = [&](const std::string& scene) {
    const auto found = table_.find(scene, factors);
    if (!found) throw NotPlanned("scene \"" + scene + "\" at " + protocol::format(factors));
    return *found;
  };
  const double longest_s = protocol_.task.duration_s.value_or(protocol_.timing.explore_s.value_or(0));
  return {cues(scenes.front()), cues(scenes.back()), scenes.size() > 1,
          longest_s - 1e-3 * protocol_.scenes.at(scenes.front()).ramp_ms};
}

std::vector<Presentation> Guard::presentations(const TrialCensus& census) {
  std::vector<Presentation> all;
  const auto orders = session::orders_of(protocol_.task);
  for (const auto& kind : census.kinds())
    for (const auto& order : orders) {
      Presentation presentation;
      presentation.correct =
          order.correct ? order.correct : session::correct_choice(protocol_.task, kind.factors);
      if (!presentation.correct) continue;  // no answer is right: it counts neither way
      presentation.weight = kind.share / static_cast<double>(orders.size());
      for (const auto& scenes : order.intervals)
        presentation.intervals.push_back(interval_of(scenes, kind.factors));
      all.push_back(std::move(presentation));
    }
  return all;
}

// Roving is uniform: points of a low-discrepancy sequence (Roberts 2018) stand for the draws of the
// intervals.
std::vector<Look> Guard::looks(const CueKind& kind, Feature feature, const std::vector<Presentation>& all) {
  constexpr double g = 1.2207440846057596;
  constexpr double steps[] = {1 / g, 1 / (g * g), 1 / (g * g * g)};
  const auto moves = [&](const Interval& interval) {
    const bool by_edge = interval.first.low || interval.last.low;
    return interval.first.rove_dB > 0 && kind.source == Source::surface && (kind.follows_strength || by_edge);
  };
  const bool roved = std::any_of(all.begin(), all.end(), [&](const Presentation& presentation) {
    return std::any_of(presentation.intervals.begin(), presentation.intervals.end(), moves);
  });
  const int points = roved ? std::clamp(static_cast<int>(40'000 / (all.size() + 1)), 16, 256) : 1;
  std::vector<Look> looks;
  double turn = 0.5;
  for (const auto& presentation : all) {
    turn += 0.7548776662466927;
    for (int k = 0; k < points; ++k) {
      Look look;
      look.correct = *presentation.correct, look.weight = presentation.weight / points;
      for (std::size_t i = 0; i < presentation.intervals.size(); ++i) {
        const auto& interval = presentation.intervals[i];
        const double u = points == 1 ? 0.5 : std::fmod(turn + (k + 1) * steps[i], 1.0);
        look.x[i] = number_of(kind, interval, feature, interval.first.rove_dB * (2 * u - 1));
      }
      looks.push_back(look);
    }
  }
  return looks;
}

CueReport Guard::report(const CueKind& kind, const std::vector<Presentation>& all) const {
  CueReport report;
  report.cue = kind.name, report.unit = kind.unit;
  const auto task = protocol_.task.kind;
  const bool change = kind.source == Source::surface &&
                      std::any_of(all.begin(), all.end(), [](const Presentation& presentation) {
                        return std::any_of(presentation.intervals.begin(), presentation.intervals.end(),
                                           [](const Interval& interval) { return interval.change; });
                      });
  auto features = std::vector<Feature>{Feature::last};
  if (change) features.insert(features.end(), {Feature::change, Feature::first});
  Grain grain{smallest_difference_dB, 0};
  for (const auto feature : features) {
    const auto looked = looks(kind, feature, all);
    if (feature == Feature::last) {
      std::tie(report.low, report.high) = range_of(looked, all.front().intervals.size());
      if (std::string(kind.unit) != "dB")
        grain = {smallest_difference * std::max(std::fabs(report.low), std::fabs(report.high)),
                 smallest_difference};
    }
    report.accuracy = std::max(report.accuracy, accuracy(best_rule(task, looked, grain), task, looked));
  }
  report.low *= kind.scale, report.high *= kind.scale;
  return report;
}

std::vector<CueReport> Guard::reports(const TrialCensus& census) {
  const auto all = presentations(census);
  std::vector<CueReport> reports;
  if (all.empty()) return reports;
  for (const auto& kind : cue_kinds) reports.push_back(report(kind, all));
  for (auto& report : reports) report.chance = std::max(guessing(), reports.back().accuracy);
  reports.back().chance = guessing();
  return reports;
}

}  // namespace

CueGuard cue_guard(const Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
                   const TrialCensus& census) {
  CueGuard guard;
  if (protocol.task.kind == TaskKind::adjustment) {
    guard.nothing_to_tell = "in an adjustment no setting is right or wrong";
    return guard;
  }
  try {
    guard.reports = Guard(protocol, rig, survey).reports(census);
    if (guard.reports.empty()) guard.nothing_to_tell = "no answer outside practice is right or wrong";
  } catch (const NotPlanned& missing) {
    guard.not_compared = missing.what();
  }
  return guard;
}

}  // namespace turnpoint::app
