#include "station/analysis/trial_record.hpp"

#include <algorithm>

namespace turnpoint::analysis {

std::vector<std::string> conditions_of(const std::vector<TrialRecord>& trials,
                                       const std::vector<std::string>& order) {
  const auto has = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  std::vector<std::string> met, names;
  for (const auto& trial : trials)
    if (trial.type == TrialType::experimental && !has(met, trial.instruction))
      met.push_back(trial.instruction);
  for (const auto& name : order)
    if (has(met, name) && !has(names, name)) names.push_back(name);
  for (const auto& name : met)
    if (!has(names, name)) names.push_back(name);
  return names;
}

}  // namespace turnpoint::analysis
