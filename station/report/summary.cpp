#include "station/report/summary.hpp"

#include <algorithm>
#include <map>

namespace turnpoint::report {

namespace {

using analysis::TrialRecord;

/// For a signed level, the choice that is right above zero; for same-different, the one right where the
/// level is largest. Falls back on the second choice.
int rising_choice(const std::vector<TrialRecord>& trials) {
  std::map<int, std::pair<double, int>> sums;
  for (const auto& trial : trials) {
    if (!trial.right_choice || !trial.level) continue;
    sums[*trial.right_choice].first += *trial.level;
    ++sums[*trial.right_choice].second;
  }
  int best = 1;
  double highest = 0;
  bool any = false;
  for (const auto& [choice, sum] : sums) {
    const double mean = sum.first / sum.second;
    if (any && mean <= highest) continue;
    best = choice;
    highest = mean;
    any = true;
  }
  return best;
}

analysis::FitOptions options_for(const SessionData& data) {
  analysis::FitOptions options;
  options.function = data.function;
  options.scale = data.scale;
  options.guess_value = 1.0 / std::max(data.alternatives, 2);
  if (data.design == Design::two_sided) options.guess = analysis::Guess::tied_to_lapse;
  if (data.design == Design::same_different) options.guess = analysis::Guess::fitted;
  return options;
}

NamedFit fit_of(const SessionData& data, const std::string& name, const std::vector<TrialRecord>& trials,
                int stream) {
  NamedFit result;
  result.name = name;
  std::vector<analysis::LevelCount> counts;
  if (data.design == Design::forced_choice) {
    counts = analysis::count_correct(trials);
    result.positive = "correct";
  } else {
    const int choice = rising_choice(data.trials);
    counts = analysis::count_choice(trials, choice);
    const auto index = static_cast<std::size_t>(choice);
    result.positive = "\u201c" + (index < data.choices.size() ? data.choices[index] : "second") + "\u201d";
  }
  result.fit = analysis::fit_psychometric(counts, options_for(data));
  if (result.fit.parameters && data.replicates > 0)
    result.bootstrap = analysis::bootstrap(result.fit, {data.replicates, 0.95, data.seed, stream, 61});
  return result;
}

/// In the order first met.
std::vector<std::string> instructions_of(const std::vector<TrialRecord>& trials) {
  std::vector<std::string> names;
  for (const auto& trial : trials)
    if (trial.type == analysis::TrialType::experimental &&
        std::find(names.begin(), names.end(), trial.instruction) == names.end())
      names.push_back(trial.instruction);
  return names;
}

}  // namespace

std::vector<NamedFit> fits_of(const SessionData& data) {
  const auto instructions = instructions_of(data.trials);
  if (instructions.size() < 2) return {fit_of(data, "", data.trials, 0)};
  std::vector<NamedFit> fits;
  for (const auto& instruction : instructions) {
    std::vector<TrialRecord> part;
    std::copy_if(data.trials.begin(), data.trials.end(), std::back_inserter(part),
                 [&](const TrialRecord& trial) { return trial.instruction == instruction; });
    fits.push_back(fit_of(data, instruction, part, static_cast<int>(fits.size())));
  }
  return fits;
}

Summary summarise(const SessionData& data) {
  Summary summary;
  summary.data = data;
  summary.outcomes = analysis::count_outcomes(data.trials);
  summary.traces = analysis::traces(data.trials);
  summary.catch_trials = analysis::catch_accuracy(data.trials);
  summary.fatigue = analysis::fatigue(data.trials);
  if (data.design == Design::adjustment) {
    summary.settings = analysis::settings(data.trials);
    return summary;
  }
  summary.bias = analysis::choice_bias(data.trials);
  analysis::TradeOptions options;
  options.exclusion = data.exclusion;
  options.replicates = data.replicates;
  options.seed = data.seed;
  summary.trade = analysis::trade(data.trials, options);
  summary.fits = fits_of(data);
  return summary;
}

}  // namespace turnpoint::report
