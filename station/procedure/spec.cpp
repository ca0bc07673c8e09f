#include "station/procedure/spec.hpp"

#include <algorithm>

namespace turnpoint::procedure {

std::pair<double, double> SeriesStarts::ends() const {
  if (uniform) return *uniform;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

std::vector<Problem> advise(const Spec& spec) {
  std::vector<Problem> advice;
  if (spec.stimuli.values.size() == 1)
    advice.push_back({"stimuli", "the grid has only one point",
                      "give two or more points, so that there is a level to choose"});
  if (spec.threshold.values.size() == 1)
    advice.push_back({"grid.threshold", "the grid has only one point, so there is nothing to estimate",
                      "give two or more points"});
  const auto left_out = [&](const char* key) {
    return std::find(spec.nuisance.begin(), spec.nuisance.end(), key) != spec.nuisance.end();
  };
  if (!spec.nuisance.empty() && spec.kind != Kind::psi_marginal)
    advice.push_back(
        {"nuisance", "it has no effect in this kind of procedure", "set kind = \"psi-marginal\""});
  else if (left_out("threshold") && left_out("slope"))
    advice.push_back({"nuisance", "no parameter is left for the procedure to estimate",
                      "leave out \"threshold\" or \"slope\""});
  if (spec.start && (spec.stop.threshold_sd || spec.stop.entropy_nats))
    advice.push_back({"stop", "a staircase can only be ended by a number of trials or reversals",
                      "use \"trials\" or \"reversals\""});
  if (!spec.stimuli.values.empty() && spec.stop.reversals)
    advice.push_back({"stop", "only staircases have reversals", "use \"trials\" or \"threshold_sd\""});
  if (spec.second && spec.second->stimuli.values.size() == 1)
    advice.push_back({"second.stimuli", "the grid has only one point, so the gradient cannot be estimated",
                      "give two or more points, or leave \"second\" out"});
  const auto& levels = spec.stimuli.values;
  if (spec.signal_detection && spec.criterion.values.size() > 1 &&
      (spec.scale == Scale::linear || levels.empty() || levels.front() > 0))
    advice.push_back({"stimuli", "without trials without a signal the criterion is hardly known",
                      "add the level 0, with scale = \"log10\""});
  if (spec.lapse.values.size() == 1 && spec.lapse.values[0] == 0)
    advice.push_back({"grid.lapse", "with a lapse rate of 0 only, a single slip is treated as impossible",
                      "add a value above 0, such as 0.02"});
  return advice;
}

}  // namespace turnpoint::procedure
