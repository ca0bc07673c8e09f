#include "station/procedure/spec.hpp"

#include <algorithm>

namespace turnpoint::procedure {

using core::phrase, core::plain;

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
    advice.push_back({"stimuli", phrase("the grid has only one point"),
                      phrase("give two or more points, so that there is a level to choose")});
  if (spec.threshold.values.size() == 1)
    advice.push_back({"grid.threshold",
                      phrase("the grid has only one point, so there is nothing to estimate"),
                      phrase("give two or more points")});
  const auto left_out = [&](const char* key) {
    return std::find(spec.nuisance.begin(), spec.nuisance.end(), key) != spec.nuisance.end();
  };
  if (!spec.nuisance.empty() && spec.kind != Kind::psi_marginal)
    advice.push_back({"nuisance", phrase("it has no effect in this kind of procedure"),
                      phrase("set %1", {plain("kind = \"psi-marginal\"")})});
  else if (left_out("threshold") && left_out("slope"))
    advice.push_back({"nuisance", phrase("no parameter is left for the procedure to estimate"),
                      phrase("leave out \"threshold\" or \"slope\"")});
  if (spec.start && (spec.stop.threshold_sd || spec.stop.entropy_nats))
    advice.push_back({"stop", phrase("a staircase can only be ended by a number of trials or reversals"),
                      phrase("use \"trials\" or \"reversals\"")});
  if (!spec.stimuli.values.empty() && spec.stop.reversals)
    advice.push_back(
        {"stop", phrase("only staircases have reversals"), phrase("use \"trials\" or \"threshold_sd\"")});
  if (spec.second && spec.second->stimuli.values.size() == 1)
    advice.push_back({"second.stimuli",
                      phrase("the grid has only one point, so the gradient cannot be estimated"),
                      phrase("give two or more points, or leave \"second\" out")});
  const auto& levels = spec.stimuli.values;
  if (spec.signal_detection && spec.criterion.values.size() > 1 &&
      (spec.scale == Scale::linear || levels.empty() || levels.front() > 0))
    advice.push_back({"stimuli", phrase("without trials without a signal the criterion is hardly known"),
                      phrase("add the level 0, with %1", {plain("scale = \"log10\"")})});
  if (spec.lapse.values.size() == 1 && spec.lapse.values[0] == 0)
    advice.push_back({"grid.lapse",
                      phrase("with a lapse rate of 0 only, a single slip is treated as impossible"),
                      phrase("add a value above 0, such as 0.02")});
  return advice;
}

}  // namespace turnpoint::procedure
