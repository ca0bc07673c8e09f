#include "station/procedure/spec.hpp"

#include <algorithm>

namespace turnpoint::procedure {

using texts::phrase, texts::plain;

std::pair<double, double> SeriesStarts::ends() const {
  if (uniform) return *uniform;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

int most_trials(const Stop& stop) {
  constexpr int kLeast = 400, kTimes = 4, kForReversal = 10;
  const int asked = std::max({stop.trials.value_or(0), stop.min_trials.value_or(0), stop.of_last.value_or(0),
                              kForReversal * stop.reversals.value_or(0)});
  return stop.max_trials.value_or(std::max(kLeast, kTimes * asked));
}

std::vector<Problem> advise(const Spec& spec) {
  std::vector<Problem> advice;
  if (spec.stimuli.values.size() == 1)
    advice.push_back({"stimuli", phrase("problem.one_point"), phrase("problem.two_points_to_choose")});
  if (spec.threshold.values.size() == 1)
    advice.push_back({"grid.threshold", phrase("problem.one_point_estimate"), phrase("problem.two_points")});
  const auto left_out = [&](const char* key) {
    return std::find(spec.nuisance.begin(), spec.nuisance.end(), key) != spec.nuisance.end();
  };
  if (!spec.nuisance.empty() && spec.kind != Kind::psi_marginal)
    advice.push_back({"nuisance", phrase("problem.no_effect_kind"),
                      phrase("problem.set", {plain("kind = \"psi-marginal\"")})});
  else if (left_out("threshold") && left_out("slope"))
    advice.push_back(
        {"nuisance", phrase("problem.nothing_estimated"), phrase("problem.leave_threshold_slope")});
  if (spec.start && (spec.stop.threshold_sd || spec.stop.entropy_nats))
    advice.push_back({"stop", phrase("problem.staircase_end"), phrase("problem.use_trials_reversals")});
  if (!spec.stimuli.values.empty() && spec.stop.reversals)
    advice.push_back({"stop", phrase("problem.only_staircases"), phrase("problem.use_trials_sd")});
  if (spec.second && spec.second->stimuli.values.size() == 1)
    advice.push_back(
        {"second.stimuli", phrase("problem.one_point_gradient"), phrase("problem.two_points_or_second")});
  const auto& levels = spec.stimuli.values;
  if (spec.signal_detection && spec.criterion.values.size() > 1 &&
      (spec.scale == Scale::linear || levels.empty() || levels.front() > 0))
    advice.push_back({"stimuli", phrase("problem.criterion_unknown"),
                      phrase("problem.add_zero", {plain("scale = \"log10\"")})});
  if (spec.lapse.values.size() == 1 && spec.lapse.values[0] == 0)
    advice.push_back({"grid.lapse", phrase("problem.lapse_zero"), phrase("problem.add_small")});
  return advice;
}

}  // namespace turnpoint::procedure
