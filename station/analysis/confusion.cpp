#include "station/analysis/confusion.hpp"

#include <map>
#include <utility>

#include "station/analysis/proportion.hpp"

namespace turnpoint::analysis {

namespace {

Confusion confusion_of(const std::vector<TrialRecord>& trials, const std::string& condition, int choices) {
  Confusion confusion;
  confusion.condition = condition;
  std::map<std::pair<std::optional<int>, std::optional<double>>, ConfusionRow> rows;
  int right = 0, scored = 0;
  for (const auto& trial : trials) {
    if (!counted(trial) || !trial.response || trial.instruction != condition) continue;
    const auto level = trial.right_choice ? std::nullopt : trial.level;
    auto& row = rows[{trial.right_choice, level}];
    row.stimulus = trial.right_choice, row.level = level;
    row.answers.resize(static_cast<std::size_t>(choices));
    ++row.answers.at(static_cast<std::size_t>(*trial.response));
    ++row.trials;
    scored += trial.right_choice.has_value();
    right += trial.right_choice == trial.response;
  }
  for (auto& [stimulus, row] : rows) {
    if (row.stimulus)
      row.right = proportion(row.answers.at(static_cast<std::size_t>(*row.stimulus)), row.trials);
    confusion.rows.push_back(std::move(row));
  }
  if (scored > 0) confusion.right = proportion(right, scored);
  return confusion;
}

}  // namespace

std::vector<Confusion> confusions(const std::vector<TrialRecord>& trials,
                                  const std::vector<std::string>& order, int choices) {
  std::vector<Confusion> all;
  for (const auto& condition : conditions_of(trials, order))
    all.push_back(confusion_of(trials, condition, choices));
  return all;
}

}  // namespace turnpoint::analysis
