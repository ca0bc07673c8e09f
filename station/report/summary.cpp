#include "station/report/summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "station/analysis/proportion.hpp"
#include "station/analysis/psychometric_posterior.hpp"
#include "station/core/number.hpp"
#include "station/report/measures.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

using core::phrase, core::plain;

namespace {

using analysis::TrialRecord;

constexpr int kBandPoints = 61;

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

/// A level of 0 lies below every level of a logarithmic axis: such a trial had no signal, so its answers tell
/// the guess rate.
void mark_zero(const SessionData& data, std::vector<analysis::LevelCount>& counts) {
  if (data.scale != analysis::Scale::log10) return;
  for (auto& point : counts)
    if (!(point.level > 0)) point.level = analysis::kNoise;
}

/// In 2ifc with two sides, the answers as choices of a scene instead of an interval.
std::vector<TrialRecord> by_scene(const SessionData& data, std::vector<TrialRecord> trials) {
  if (!data.scenes.empty())
    for (auto& trial : trials) trial.response = trial.chosen_scene, trial.right_choice = trial.right_scene;
  return trials;
}

NamedFit fit_of(const SessionData& data, const std::string& name, const std::vector<TrialRecord>& trials,
                int stream) {
  NamedFit result;
  result.name = name;
  std::vector<analysis::LevelCount> counts;
  if (data.design == Design::forced_choice) {
    counts = analysis::count_correct(trials, data.alternatives);
    result.positive = "correct";
  } else {
    const bool noise = has_noise(data.design);
    int choice = data.positive;
    if (!data.scored && analysis::falls(analysis::count_choice(trials, choice))) choice = 1 - choice;
    counts = noise ? count_yes(trials, choice) : analysis::count_choice(by_scene(data, trials), choice);
    const auto index = static_cast<std::size_t>(choice);
    const auto& answers = data.scenes.empty() ? data.choices : data.scenes;
    result.positive = "\u201c" + (index < answers.size() ? answers[index] : "second") + "\u201d";
  }
  mark_zero(data, counts);
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
    if (!shows(data, "ez")) {
      entry.boundary.reset(), entry.nondecision_s.reset(), entry.contaminants.reset(), entry.drift.reset();
      entry.effective_draws.reset();
      entry.check.reset();
      for (auto& cell : entry.cells) cell.drift.reset();
      std::erase_if(entry.statements, [](const auto& said) { return said.code.starts_with("diffusion-"); });
    }
    if (!shows(data, "lisas")) entry.lisas_s.reset();
    if (!shows(data, "ies")) entry.inverse_efficiency_s.reset();
    if (!shows(data, "caf")) {
      entry.caf.clear();
      std::erase_if(entry.statements, [](const auto& said) { return said.code.starts_with("caf-"); });
    }
  }
  if (!shows(data, "ez")) {
    trade.model_p.reset();
    std::erase_if(trade.statements, [](const auto& said) { return said.code.starts_with("diffusion-"); });
  }
  std::erase_if(trade.differences, [&data](const auto& difference) {
    const auto& name = difference.measure;
    if (name.starts_with(analysis::kBinMeasure)) return !shows(data, "caf");
    return std::any_of(std::begin(kSpeedAndAccuracy), std::end(kSpeedAndAccuracy), [&](const auto& row) {
      return name == row.name && *row.part != '\0' && !shows(data, row.part);
    });
  });
}

analysis::Detecting detecting(const SessionData& data) {
  if (data.design == Design::yes_no) return analysis::Detecting::presence;
  return data.design == Design::two_sided ? analysis::Detecting::sides : analysis::Detecting::forced_choice;
}

/// The choice that counts as "yes".
int positive(const SessionData& data) {
  return data.design == Design::yes_no || data.design == Design::two_sided ? data.positive : 1;
}

/// The trials with levels that count from the cut, so that levels on its two sides are mirror images.
std::vector<TrialRecord> around_cut(const SessionData& data) {
  auto trials = by_scene(data, data.trials);
  if (data.design == Design::two_sided)
    for (auto& trial : trials)
      if (trial.level) *trial.level -= data.cut;
  return trials;
}

std::vector<analysis::Detection> detections_of(const SessionData& data) {
  if (!data.scored || data.choices.size() != 2 || !data.deciding.empty()) return {};
  return analysis::detect(around_cut(data), data.conditions, detecting(data), positive(data));
}

/// Adds d' over all levels to each condition, and its differences: the macro trade.
void add_sensitivity(const SessionData& data, analysis::Trade& trade) {
  if (data.signalled || !data.parts.empty()) return;  // lags, or levels of several factors, are not pooled
  for (const auto& detection : detections_of(data))
    for (auto& entry : trade.instructions)
      if (!detection.level && detection.condition == entry.instruction) entry.d_prime = detection.d_prime;
  const auto& conditions = trade.instructions;
  for (std::size_t a = 0; a < conditions.size(); ++a)
    for (std::size_t b = a + 1; b < conditions.size(); ++b) {
      if (!conditions[a].d_prime || !conditions[b].d_prime) continue;
      auto gap = analysis::difference_of(*conditions[a].d_prime, *conditions[b].d_prime);
      const double error = (gap.interval.high - gap.interval.low) / (2 * analysis::kZ95);
      gap.p = 2 * analysis::normal_cdf(-std::fabs(gap.value) / error);
      trade.differences.push_back({conditions[a].instruction, conditions[b].instruction, "d'", "SD", gap});
    }
}

/// Corrects the p values of differences between conditions.
void correct_differences(const SessionData& data, std::vector<analysis::Difference>& differences) {
  std::vector<analysis::Tested> tests;
  for (const auto& one : differences)
    tests.push_back({one.measure, one.estimate ? one.estimate->p : std::nullopt});
  const auto p = corrected(data, std::move(tests));
  for (std::size_t i = 0; i < p.size(); ++i) differences[i].corrected_p = p[i];
}

}  // namespace

const LevelAnalysis& analysis_of(const NamedFit& named, const SessionData& data) {
  return data.parts.empty() ? data : data.parts.at(named.part);
}

SessionData part_of(const SessionData& data, std::size_t part) {
  if (data.parts.empty()) return data;
  SessionData one = data;
  static_cast<LevelAnalysis&>(one) = data.parts.at(part);
  one.parts.clear();
  std::erase_if(one.trials, [part](const auto& trial) { return trial.part != part; });
  return one;
}

std::vector<std::optional<double>> corrected(const SessionData& data, std::vector<analysis::Tested> tests) {
  if (data.holm == protocol::Holm::none) return std::vector<std::optional<double>>(tests.size());
  if (data.holm == protocol::Holm::all)
    for (auto& test : tests) test.family.clear();
  return analysis::holm(tests);
}

analysis::Trade trade_of(const SessionData& data, const analysis::TradeOptions& options) {
  auto trade = analysis::trade(data.trials, options);
  hide(data, trade);
  add_sensitivity(data, trade);
  correct_differences(data, trade.differences);
  return trade;
}

std::vector<analysis::SpeedAccuracyCurve> curves_of(const SessionData& data) {
  std::vector<analysis::SpeedAccuracyCurve> curves;
  for (std::size_t i = 0; i < std::max<std::size_t>(1, data.parts.size()); ++i) {
    const auto part = part_of(data, i);
    if (!part.scored || part.choices.size() != 2 || !shows(part, "response-signal")) continue;
    for (auto& curve :
         analysis::response_signal(around_cut(part), part.conditions, detecting(part), positive(part)))
      curves.push_back(std::move(curve));
  }
  return curves;
}

std::vector<analysis::CurveDifference> curve_differences_of(
    const SessionData& data, const std::vector<analysis::SpeedAccuracyCurve>& curves) {
  auto differences = analysis::curve_differences(curves);
  std::vector<analysis::Tested> tests;
  for (const auto& one : differences)
    for (std::size_t i = 0; i < one.p.size(); ++i) tests.push_back({std::to_string(i), one.p[i]});
  const auto p = corrected(data, std::move(tests));
  for (std::size_t i = 0; i < p.size(); ++i) differences[i / 3].corrected_p[i % 3] = p[i];
  return differences;
}

std::vector<NamedFit> fits_of(const SessionData& data) {
  std::vector<NamedFit> fits;
  for (std::size_t part = 0; part < data.parts.size(); ++part)
    for (auto& named : fits_of(part_of(data, part))) {
      named.part = part;
      if (named.name.empty()) named.name = data.parts[part].name;
      fits.push_back(std::move(named));
    }
  const bool fitted =
      data.design == Design::forced_choice || data.design == Design::two_sided || has_noise(data.design);
  if (!data.parts.empty() || !fitted || data.thresholds_differ) return fits;
  const auto instructions = analysis::conditions_of(data.trials, data.conditions);
  // A participant of a group has one of several conditions, which keeps its name.
  const bool one = data.name.empty() && data.conditions.size() < 2 && instructions.size() < 2;
  if (one || instructions.empty()) return {fit_of(data, "", data.trials, 0)};
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

std::optional<analysis::ScaleModel> scale_model(Design design, core::Function function) {
  if (design == Design::differences) return analysis::ScaleModel::differences;
  if (design != Design::pairs) return std::nullopt;
  return function == core::Function::logistic ? analysis::ScaleModel::bradley_terry
                                              : analysis::ScaleModel::thurstone;
}

std::vector<analysis::StimulusScale> scales_of(const SessionData& data, int sessions) {
  const auto model = scale_model(data.design, data.function);
  if (!model) return {};
  return analysis::scales(data.trials, data.conditions, *model, sessions, data.stimuli);
}

std::vector<std::pair<double, analysis::Estimate>> places_of(const analysis::StimulusScale& scale) {
  std::vector<std::pair<double, analysis::Estimate>> places;
  const std::size_t ends = scale.model == analysis::ScaleModel::differences ? 1 : 0;
  for (std::size_t i = ends; scale.fit && i + ends < scale.stimuli.size(); ++i)
    places.emplace_back(scale.stimuli[i], scale.fit->values[i]);
  return places;
}

std::string place_name(double stimulus, const std::string& level_unit) {
  return kPlaceOf + core::number(stimulus, 6) + (level_unit.empty() ? "" : " ") + level_unit;
}

const char* scale_unit(analysis::ScaleModel model) {
  switch (model) {
    case analysis::ScaleModel::bradley_terry:
      return "log odds";
    case analysis::ScaleModel::thurstone:
      return "SD";
    case analysis::ScaleModel::differences:
      break;
  }
  return "";
}

core::Phrase place_label(analysis::ScaleModel model) {
  const auto name = core::phrase("report.scale_value");
  const std::string unit = scale_unit(model);
  return unit.empty() ? name : in_unit(name, core::plain(unit));
}

const char* tendency_unit(analysis::ScaleModel model) {
  return model == analysis::ScaleModel::differences ? kNoiseUnit : scale_unit(model);
}

bool has_confusions(const SessionData& data) {
  return !judges(data.design) && (data.choices.size() > 2 || data.design == Design::categories);
}

bool slope_estimated(const NamedFit& named) {
  if (named.intervals.method == analysis::IntervalMethod::posterior) return named.intervals.slope.has_value();
  return !named.fit.at_bound.slope_low && !named.fit.at_bound.slope_high;
}

core::Phrase describe_intervals(const NamedFit& named, const SessionData& data) {
  const auto& intervals = named.intervals;
  if (intervals.method == analysis::IntervalMethod::none) return {};
  if (intervals.method == analysis::IntervalMethod::bootstrap)
    return phrase("statement.likelihood", {plain(intervals.replicates)});
  const auto& prior = *intervals.prior;
  const auto& options = named.fit.options;
  const auto flat = analysis::flat_part(options.function, options.scale, prior);
  const auto number = [](double value) { return plain(core::number(value, 3)); };
  core::Phrase parts;
  const auto add = [&](const char* name, const char* how, double low, double high) {
    if (!parts.values.empty()) parts.values.push_back(plain("; "));
    parts.values.push_back(phrase(how, {phrase(name), number(low), number(high)}));
  };
  const auto falling = [&](double low, double high) {
    if (prior.falling_share != 0)
      parts.values.push_back(phrase("statement.falling", {number(low), number(high)}));
  };
  constexpr const char *kUniform = "statement.uniform", *kLogarithm = "statement.uniform_logarithm";
  const auto& part = analysis_of(named, data);
  add(part.design == Design::two_sided ? "report.pse" : "report.threshold",
      options.scale == analysis::Scale::log10 ? kLogarithm : kUniform, flat.threshold_low,
      flat.threshold_high);
  if (!part.level_unit.empty()) parts.values.push_back(plain(" " + part.level_unit));
  falling(prior.threshold_low, prior.threshold_high);
  add(options.function == core::Function::normal ? "report.spread" : "report.slope", kLogarithm,
      flat.slope_low, flat.slope_high);
  falling(prior.slope_low, prior.slope_high);
  add("report.lapse", kUniform, options.lapse_low, options.lapse_high);
  if (options.guess == analysis::Guess::fitted)
    add("statement.guess", kUniform, options.guess_low, options.guess_high);
  return phrase("statement.posterior", {parts});
}

bool shows(const SessionData& data, const std::string& part) {
  if (part == "points") return data.payoff;
  if (data.show) return std::find(data.show->begin(), data.show->end(), part) != data.show->end();
  if (part == "response-signal") return true;
  if (part == "ez") return data.choices.size() <= 2 && !data.signalled && !data.unsure;
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

namespace {

template <class Entry>
void append(std::vector<Entry> more, std::vector<Entry>& all) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// How the regression of the effects of the trial before sees the answers; empty for three or more answers.
std::optional<analysis::DependenceOptions> dependence_options(const SessionData& data) {
  using analysis::Answers;
  analysis::DependenceOptions options;
  options.positive = data.positive;
  options.after_error = data.scored && !data.prior;
  switch (data.design) {
    case Design::ratings:
      options.answers = Answers::values;
      return options;
    case Design::numbers:
      options.answers = Answers::logarithms;
      options.decibel = data.level_unit == "dB";
      return options;
    case Design::adjustment:
      options.answers = Answers::settings;
      return options;
    case Design::categories:
    case Design::pairs:
    case Design::differences:
      return std::nullopt;
    case Design::forced_choice:
      options.answers = Answers::sides;
      options.positive = 1;
      options.decibel = data.level_unit == "dB";
      break;
    case Design::two_sided:
      options.answers = data.scenes.empty() ? Answers::choices : Answers::sides;
      if (!data.scenes.empty()) options.positive = 1;
      options.cut = data.cut;
      break;
    case Design::yes_no:
    case Design::same_different:
      options.answers = Answers::choices;
      options.noise = true;
      options.decibel = data.level_unit == "dB";
      break;
  }
  return data.choices.size() == 2 ? std::optional(options) : std::nullopt;
}

/// The effects of the trial before in one analysis.
std::vector<analysis::Dependence> dependences_of(const SessionData& data) {
  using analysis::Answers;
  const auto options = dependence_options(data);
  if (!options) return {};
  const bool logistic = options->answers == Answers::sides || options->answers == Answers::choices;
  auto all = analysis::serial_dependence(data.trials, data.conditions, *options);
  for (auto& one : all) {
    one.analysis = data.name, one.unit = data.level_unit;
    if (logistic) one.answer = data.choices.at(static_cast<std::size_t>(options->positive));
  }
  return all;
}

/// Adds what the answers at the levels of one analysis say, except for the psychometric functions.
void add_levels(const SessionData& data, int scale_sessions, Summary& summary) {
  append(dependences_of(data), summary.dependences);
  if (data.design == Design::adjustment) {
    append(analysis::settings(data.trials, data.conditions), summary.settings);
    return;
  }
  if (judges(data.design)) {
    append(judgements_of(data), summary.judgements);
    if (data.design == Design::ratings && shows(data, "dprime"))
      append(analysis::rating_rocs(data.trials, data.conditions, static_cast<int>(data.choices.size())),
             summary.rocs);
    return;
  }
  if (scales(data.design)) {
    append(scales_of(data, scale_sessions), summary.scales);
    return;
  }
  if (has_confusions(data))
    append(analysis::confusions(data.trials, data.conditions, static_cast<int>(data.choices.size())),
           summary.confusions);
  const auto detections = detections_of(data);
  if (shows(data, "dprime")) {
    if (data.design == Design::yes_no && !detections.empty())
      append(analysis::rocs(data.trials, data.conditions, data.positive), summary.rocs);
    append(detections, summary.detections);
  }
  if (!data.deciding.empty() && shows(data, "dprime"))
    append(analysis::discriminate(data.trials, data.conditions, data.deciding, data.alternatives),
           summary.discriminations);
}

}  // namespace

Summary summarise(const SessionData& data, int scale_sessions) {
  Summary summary;
  summary.data = data;
  summary.outcomes = analysis::count_outcomes(data.trials);
  if (shows(data, "trace")) summary.traces = analysis::traces(data.trials);
  summary.catch_trials = analysis::catch_accuracy(data.trials);
  summary.confidence = analysis::accuracy_by_confidence(data.trials);
  summary.fatigue = analysis::fatigue(data.trials);
  summary.finger = analysis::finger(data.finger, data.conditions);
  summary.followed = analysis::followed(data.followed, data.conditions);
  const auto count = std::max<std::size_t>(1, data.parts.size());
  for (std::size_t part = 0; part < count; ++part) add_levels(part_of(data, part), scale_sessions, summary);
  if (data.design == Design::adjustment || judges(data.design)) return summary;
  if (data.choices.size() <= 2) summary.bias = analysis::choice_bias(data.trials);
  auto how = trade_options(data);
  how.halves = shows(data, "ez");
  summary.trade = trade_of(data, how);
  summary.curves = curves_of(data);
  summary.curve_differences = curve_differences_of(data, summary.curves);
  if (data.scored && (data.show || summary.trade.instructions.size() > 1) && shows(data, "bis"))
    summary.trade.statements.push_back({"bis-study", phrase("statement.bis_study")});
  if (shows(data, "psychometric")) summary.fits = fits_of(data);
  return summary;
}

}  // namespace turnpoint::report
