#include "station/report/summary.hpp"

#include <algorithm>
#include <map>

#include "station/analysis/psychometric_posterior.hpp"
#include "station/text/number.hpp"

namespace turnpoint::report {

using texts::phrase, texts::plain;

namespace {

using analysis::TrialRecord;

constexpr int kBandPoints = 61;

/// Returns the choice that is right at levels above 0. If no trial shows which one that is, returns the
/// second choice.
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

/// Counts the "yes" answers at each level. Trials without a signal are counted at kNoise, a level below all
/// others.
std::vector<analysis::LevelCount> count_yes(const std::vector<TrialRecord>& trials, int positive) {
  auto marked = trials;
  for (auto& trial : marked)
    if (trial.right_choice && *trial.right_choice != positive) trial.level = analysis::kNoise;
  return analysis::count_choice(marked, positive);
}

analysis::FitOptions options_for(const SessionData& data) {
  analysis::FitOptions options;
  options.function = data.function;
  options.scale = data.scale;
  options.guess_value = 1.0 / std::max(data.alternatives, 2);
  if (data.design == Design::two_sided) options.guess = analysis::Guess::tied_to_lapse;
  if (has_noise(data.design)) {
    options.guess = analysis::Guess::fitted;
    options.guess_high = 0.9;
  }
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
    const bool noise = has_noise(data.design);
    const int choice = noise ? data.positive : rising_choice(data.trials);
    counts = noise ? count_yes(trials, choice) : analysis::count_choice(trials, choice);
    const auto index = static_cast<std::size_t>(choice);
    result.positive = "\u201c" + (index < data.choices.size() ? data.choices[index] : "second") + "\u201d";
  }
  const auto options = options_for(data);
  const int band_points = data.replicates > 0 ? kBandPoints : 0;
  if (data.prior) {
    auto posterior = analysis::fit_posterior(counts, options, *data.prior, band_points);
    result.fit = std::move(posterior.fit);
    result.intervals = std::move(posterior.intervals);
    return result;
  }
  result.fit = analysis::fit_psychometric(counts, options);
  if (result.fit.parameters && data.replicates > 0)
    result.intervals =
        analysis::bootstrap(result.fit, {data.replicates, 0.95, data.seed, stream, band_points});
  return result;
}

/// Removes the measures that belong to parts of the report which the protocol does not show.
void hide(const SessionData& data, analysis::Trade& trade) {
  for (auto& entry : trade.instructions) {
    if (!shows(data, "diffusion")) {
      entry.boundary.reset(), entry.nondecision_s.reset(), entry.contaminants.reset(), entry.drift.reset();
      for (auto& cell : entry.cells) cell.drift.reset();
      std::erase_if(entry.statements, [](const auto& said) { return said.code.starts_with("diffusion-"); });
    }
    if (!shows(data, "lisas")) entry.lisas_s.reset();
    if (!shows(data, "ies")) entry.inverse_efficiency_s.reset();
    if (!shows(data, "bis")) entry.balanced.reset();
    if (!shows(data, "caf")) {
      entry.caf.clear();
      std::erase_if(entry.statements, [](const auto& said) { return said.code.starts_with("caf-"); });
    }
  }
  std::erase_if(trade.differences, [&data](const auto& difference) {
    const auto& name = difference.measure;
    return ((name == "boundary" || name == "time outside the decision" || name == "drift") &&
            !shows(data, "diffusion")) ||
           (name == "LISAS" && !shows(data, "lisas")) ||
           (name == "inverse efficiency" && !shows(data, "ies")) || (name == "BIS" && !shows(data, "bis"));
  });
}

analysis::Detecting detecting(const SessionData& data) {
  if (data.design == Design::yes_no) return analysis::Detecting::presence;
  return data.design == Design::two_sided ? analysis::Detecting::sides : analysis::Detecting::forced_choice;
}

/// The choice that counts as "yes".
int positive(const SessionData& data) {
  if (data.design == Design::yes_no) return data.positive;
  return data.design == Design::two_sided ? rising_choice(data.trials) : 1;
}

std::vector<analysis::Detection> detections_of(const SessionData& data) {
  if (!data.scored || data.choices.size() > 2 || !data.deciding.empty() || !shows(data, "dprime")) return {};
  return analysis::detect(data.trials, data.conditions, detecting(data), positive(data));
}

}  // namespace

std::vector<NamedFit> fits_of(const SessionData& data) {
  if (data.thresholds_differ) return {};
  const auto instructions = analysis::conditions_of(data.trials, data.conditions);
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

std::vector<analysis::Judgements> judgements_of(const SessionData& data) {
  using analysis::Judged;
  if (!judges(data.design)) return {};
  return analysis::judgements(data.trials, data.conditions,
                              data.design == Design::ratings ? Judged::ratings
                              : data.level_unit == "dB"      ? Judged::magnitudes_dB
                                                             : Judged::magnitudes);
}

bool has_confusions(const SessionData& data) {
  return !judges(data.design) && (data.choices.size() > 2 || data.design == Design::categories);
}

bool slope_estimated(const NamedFit& named) {
  if (named.intervals.method == analysis::IntervalMethod::posterior) return named.intervals.slope.has_value();
  return !named.fit.at_bound.slope_low && !named.fit.at_bound.slope_high;
}

texts::Phrase describe_intervals(const NamedFit& named, const SessionData& data) {
  const auto& intervals = named.intervals;
  if (intervals.method == analysis::IntervalMethod::none) return {};
  if (intervals.method == analysis::IntervalMethod::bootstrap)
    return phrase("statement.likelihood", {plain(intervals.replicates)});
  const auto& prior = *intervals.prior;
  const auto& options = named.fit.options;
  const auto flat = analysis::flat_part(options.function, options.scale, prior);
  const auto number = [](double value) { return plain(text::number(value, 3)); };
  texts::Phrase parts;
  const auto add = [&](const char* name, const char* how, double low, double high) {
    if (!parts.values.empty()) parts.values.push_back(plain("; "));
    parts.values.push_back(phrase(how, {phrase(name), number(low), number(high)}));
  };
  const auto falling = [&](double low, double high) {
    if (prior.falling_share != 0)
      parts.values.push_back(phrase("statement.falling", {number(low), number(high)}));
  };
  constexpr const char *kUniform = "statement.uniform", *kLogarithm = "statement.uniform_logarithm";
  add(data.design == Design::two_sided ? "report.pse" : "report.threshold",
      options.scale == analysis::Scale::log10 ? kLogarithm : kUniform, flat.threshold_low,
      flat.threshold_high);
  if (!data.level_unit.empty()) parts.values.push_back(plain(" " + data.level_unit));
  falling(prior.threshold_low, prior.threshold_high);
  add(options.function == terms::Function::normal ? "report.spread" : "report.slope", kLogarithm,
      flat.slope_low, flat.slope_high);
  falling(prior.slope_low, prior.slope_high);
  add("report.lapse", kUniform, options.lapse_low, options.lapse_high);
  if (options.guess == analysis::Guess::fitted)
    add("statement.guess", kUniform, options.guess_low, options.guess_high);
  return phrase("statement.posterior", {parts});
}

bool shows(const SessionData& data, const std::string& part) {
  if (data.show) return std::find(data.show->begin(), data.show->end(), part) != data.show->end();
  if (part == "response-signal") return true;
  if (part == "diffusion") return data.choices.size() <= 2;
  return part != "dprime" || data.design == Design::yes_no || data.design == Design::ratings ||
         !data.deciding.empty();
}

analysis::TradeOptions trade_options(const SessionData& data) {
  analysis::TradeOptions options;
  options.order = data.conditions;
  options.exclusion = data.exclusion;
  options.replicates = data.replicates;
  options.seed = data.seed;
  return options;
}

Summary summarise(const SessionData& data) {
  Summary summary;
  summary.data = data;
  summary.outcomes = analysis::count_outcomes(data.trials);
  if (shows(data, "trace")) summary.traces = analysis::traces(data.trials);
  summary.catch_trials = analysis::catch_accuracy(data.trials);
  summary.confidence = analysis::accuracy_by_confidence(data.trials);
  summary.fatigue = analysis::fatigue(data.trials);
  summary.finger = analysis::finger(data.finger, data.conditions);
  if (data.design == Design::adjustment) {
    summary.settings = analysis::settings(data.trials, data.conditions);
    return summary;
  }
  if (judges(data.design)) {
    summary.judgements = judgements_of(data);
    if (data.design == Design::ratings && shows(data, "dprime"))
      summary.rocs =
          analysis::rating_rocs(data.trials, data.conditions, static_cast<int>(data.choices.size()));
    return summary;
  }
  if (data.choices.size() <= 2) summary.bias = analysis::choice_bias(data.trials);
  if (has_confusions(data))
    summary.confusions =
        analysis::confusions(data.trials, data.conditions, static_cast<int>(data.choices.size()));
  summary.trade = analysis::trade(data.trials, trade_options(data));
  hide(data, summary.trade);
  summary.detections = detections_of(data);
  if (data.design == Design::yes_no && !summary.detections.empty())
    summary.rocs = analysis::rocs(data.trials, data.conditions, data.positive);
  if (data.choices.size() == 2 && shows(data, "response-signal"))
    summary.curves = analysis::response_signal(data.trials, data.conditions, detecting(data), positive(data));
  if (!data.deciding.empty() && shows(data, "dprime"))
    summary.discriminations =
        analysis::discriminate(data.trials, data.conditions, data.deciding, data.alternatives);
  if (data.design != Design::categories && shows(data, "psychometric")) summary.fits = fits_of(data);
  return summary;
}

}  // namespace turnpoint::report
