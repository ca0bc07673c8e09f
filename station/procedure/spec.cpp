#include "station/procedure/spec.hpp"

#include <algorithm>

namespace turnpoint::procedure {

std::vector<Problem> advise(const Spec& spec) {
  std::vector<Problem> advice;
  if (spec.stimuli.values.size() == 1)
    advice.push_back({"stimuli", "a grid of one point", "two or more, to have something to choose"});
  if (spec.threshold.values.size() == 1)
    advice.push_back({"grid.threshold", "a grid of one point: nothing is left to find", "two or more"});
  const auto left_out = [&](const char* key) {
    return std::find(spec.nuisance.begin(), spec.nuisance.end(), key) != spec.nuisance.end();
  };
  if (!spec.nuisance.empty() && spec.kind != Kind::psi_marginal)
    advice.push_back({"nuisance", "has no effect on this kind", "kind = \"psi-marginal\""});
  else if (left_out("threshold") && left_out("slope"))
    advice.push_back({"nuisance", "no trial is spent on anything", "\"threshold\" or \"slope\" left out"});
  if (spec.start && (spec.stop.threshold_sd || spec.stop.entropy_nats))
    advice.push_back(
        {"stop", "a staircase ends by trials and reversals alone", "\"trials\" or \"reversals\""});
  if (!spec.stimuli.values.empty() && spec.stop.reversals)
    advice.push_back(
        {"stop", "there are no reversals without a staircase", "\"trials\" or \"threshold_sd\""});
  if (spec.lapse.values.size() == 1 && spec.lapse.values[0] == 0)
    advice.push_back(
        {"grid.lapse", "only 0: one slip counts as impossible", "a value above 0, such as 0.02"});
  return advice;
}

}  // namespace turnpoint::procedure
