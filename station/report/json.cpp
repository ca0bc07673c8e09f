#include <cmath>

#include "station/analysis/proportion.hpp"
#include "station/analysis/psychometric_posterior.hpp"
#include "station/report/document.hpp"
#include "station/report/json_parts.hpp"
#include "station/report/measures.hpp"

namespace turnpoint::report {

namespace {

/// Returns the prior as JSON: for each parameter, the range in which the prior is uniform and, if the prior
/// falls off beyond this range, where it reaches 0. Returns null for a bootstrap, which has no prior.
Json prior_json(const NamedFit& named) {
  const auto& prior = named.intervals.prior;
  if (!prior) return nullptr;
  const auto uniform = [](double low, double high, bool logarithmic) -> Json {
    return {{"low", value(low)}, {"high", value(high)}, {"uniform_in", logarithmic ? "logarithm" : "value"}};
  };
  const auto& options = named.fit.options;
  const auto flat = analysis::flat_part(options.function, options.scale, *prior);
  Json json;
  json["threshold"] =
      uniform(flat.threshold_low, flat.threshold_high, options.scale == analysis::Scale::log10);
  json["threshold"]["falls_to_0_at"] = {value(prior->threshold_low), value(prior->threshold_high)};
  json["slope"] = uniform(flat.slope_low, flat.slope_high, true);
  json["slope"]["falls_to_0_at"] = {value(prior->slope_low), value(prior->slope_high)};
  json["lapse"] = uniform(options.lapse_low, options.lapse_high, false);
  if (options.guess == analysis::Guess::fitted)
    json["guess"] = uniform(options.guess_low, options.guess_high, false);
  return json;
}

Json fit_json(const NamedFit& named, const SessionData& data) {
  const auto& part = analysis_of(named, data);
  const auto& p = named.fit.parameters;
  const bool posterior = named.intervals.method == analysis::IntervalMethod::posterior;
  Json json{{"name", named.name}, {"positive", named.positive}, {"measures", part.meaning}};
  json["level"] = core::say(part.level_label, "en");
  json["level_unit"] = part.level_unit;
  json["threshold"] = p ? value(p->threshold) : Json(nullptr);
  json["threshold_interval"] = value(named.intervals.threshold);
  json["slope"] = p && slope_estimated(named) ? value(p->slope) : Json(nullptr);
  json["slope_interval"] = value(named.intervals.slope);
  json["guess"] = p ? value(p->guess) : Json(nullptr);
  json["lapse"] = p ? value(p->lapse) : Json(nullptr);
  json["level_75"] = value(named.intervals.level_75);
  json["level_75_interval"] = value(named.intervals.interval_75);
  json["negative_log_likelihood"] =
      p && !posterior ? value(named.fit.negative_log_likelihood) : Json(nullptr);
  json["deviance"] = p && !posterior ? value(named.fit.deviance) : Json(nullptr);
  json["deviance_p"] = value(named.intervals.deviance_p);
  json["weight"] = named.fit.weight;
  json["replicates"] = named.intervals.replicates;
  json["intervals"] = core::say(describe_intervals(named, data), "en");
  json["prior"] = prior_json(named);
  json["levels"] = Json::array();  // a noise trial has no level, so its level is null
  for (const auto& point : named.fit.data)
    json["levels"].push_back(
        {{"level", value(point.level)}, {"trials", point.trials}, {"positive", value(point.sum())}});
  auto statements = named.fit.statements;
  statements.insert(statements.end(), named.intervals.statements.begin(), named.intervals.statements.end());
  json["statements"] = value(statements);
  return json;
}

Json prediction_json(const analysis::PredictedAnswers& answers) {
  Json observed = Json::array();
  for (const auto& quantile : answers.observed_quantiles) observed.push_back(value(std::optional(quantile)));
  return {{"observed", answers.observed},
          {"predicted_proportion", value(answers.probability)},
          {"observed_mean_s", value(answers.observed_mean_s)},
          {"predicted_mean_s", value(answers.mean_s)},
          {"observed_quantiles_s", observed},
          {"predicted_quantiles_s", answers.quantile_s}};
}

Json instruction_json(const analysis::InstructionResult& entry) {
  Json json{{"instruction", entry.instruction},     {"presented", entry.presented},
            {"answered", entry.answered},           {"timeouts", entry.timeouts},
            {"anticipations", entry.anticipations}, {"excluded", entry.excluded}};
  for (const auto& row : kSpeedAndAccuracy) json[row.key] = value(entry.*row.value);
  json["deadline_s"] = value(entry.deadline_s);
  json["effective_draws"] = value(entry.effective_draws);
  json["deciles_s"] = entry.times ? Json(entry.times->deciles_s) : Json(nullptr);
  json["difficulties"] = Json::array();
  for (const auto& cell : entry.cells)
    json["difficulties"].push_back({{"difficulty", value(cell.difficulty)},
                                    {"answered", cell.answered},
                                    {"correct", cell.correct},
                                    {"interval", value(cell.accuracy)},
                                    {"mean_correct_s", value(cell.mean_correct_s)},
                                    {"drift", value(cell.drift)}});
  json["predicted"] = Json::array();
  if (entry.check)
    for (const auto& difficulty : entry.check->difficulties)
      json["predicted"].push_back(
          {{"right", prediction_json(difficulty.right)}, {"wrong", prediction_json(difficulty.wrong)}});
  json["caf"] = Json::array();
  for (const auto& bin : entry.caf)
    json["caf"].push_back({{"mean_time_s", value(bin.mean_time_s)},
                           {"trials", bin.trials},
                           {"correct", bin.correct},
                           {"interval", value(analysis::wilson(bin.correct, bin.trials))}});
  json["statements"] = value(entry.statements);
  return json;
}

Json judgements_json(const analysis::Judgements& judged) {
  Json json{{"condition", judged.condition}, {"levels", Json::array()}};
  for (const auto& level : judged.levels)
    json["levels"].push_back({{"level", value(level.level)},
                              {"answers", level.values.size()},
                              {"mean", value(level.mean)},
                              {"median", value(level.median)}});
  json["exponent"] = value(judged.exponent);
  json["statements"] = value(judged.statements);
  return json;
}

Json boundaries_json(const std::vector<analysis::AtBoundary>& values) {
  Json list = Json::array();
  for (const auto& at : values)
    list.push_back({{"planned_mm", value(at.planned_mm)},
                    {"value", value(at.value)},
                    {"interval", at.interval ? value(*at.interval) : Json(nullptr)},
                    {"trials", at.trials}});
  return list;
}

Json finger_json(const std::optional<analysis::Finger>& finger) {
  if (!finger) return nullptr;
  Json json{{"conditions", Json::array()}};
  for (const auto& entry : finger->conditions) {
    Json condition{{"condition", entry.condition},
                   {"trials", entry.trials},
                   {"measured", entry.measured},
                   {"felt", entry.felt}};
    for (const auto& row : kFinger) condition[row.key] = value(entry.*row.value);
    json["conditions"].push_back(std::move(condition));
  }
  json["felt_minus_planned_mm"] = boundaries_json(finger->boundaries.shift_mm);
  json["mu_low"] = boundaries_json(finger->boundaries.mu_low);
  json["mu_high"] = boundaries_json(finger->boundaries.mu_high);
  json["statements"] = value(finger->statements);
  return json;
}

Json strip_json(const std::vector<analysis::FrictionCurve>& curves) {
  Json json = Json::array();
  for (const auto& curve : curves)
    json.push_back({{"direction", curve.direction},
                    {"from_boundary_mm", curve.from_boundary_mm},
                    {"friction", curve.friction},
                    {"se", curve.se}});
  return json;
}

Json threshold_curves_json(const std::vector<ThresholdCurve>& curves) {
  Json json = Json::array();
  for (const auto& curve : curves) {
    Json points = Json::array();
    for (const auto& point : curve.points)
      points.push_back({{"second", value(point.second)},
                        {"threshold", value(point.threshold)},
                        {"interval", value(point.interval)}});
    json.push_back({{"procedure", curve.procedure},
                    {"block", curve.block},
                    {"second", core::say(curve.label, "en")},
                    {"points", points}});
  }
  return json;
}

Json repeats_json(const std::vector<analysis::RepeatedTrials>& repeats) {
  Json json = Json::array();
  for (const auto& at : repeats)
    json.push_back({{"level", value(at.level)}, {"presented", at.presented}, {"repeated", at.repeated}});
  return json;
}

Json proportion_json(const std::optional<analysis::Proportion>& proportion) {
  if (!proportion) return nullptr;
  return {{"right", proportion->right},
          {"trials", proportion->trials},
          {"proportion", value(proportion->value)},
          {"interval", value(proportion->interval)}};
}

Json confusion_json(const analysis::Confusion& confusion, const SessionData& data) {
  Json json{{"condition", confusion.condition}, {"rows", Json::array()}};
  for (const auto& row : confusion.rows) {
    Json entry;
    entry["stimulus"] =
        row.stimulus ? Json(data.choices.at(static_cast<std::size_t>(*row.stimulus))) : Json(nullptr);
    entry["level"] = value(row.level);
    entry["answers"] = row.answers;  // the number of each answer, in the order of "choices"
    entry["trials"] = row.trials;
    entry["correct"] = proportion_json(row.right);
    json["rows"].push_back(std::move(entry));
  }
  json["correct"] = proportion_json(confusion.right);
  return json;
}

Json rating_fit_json(const std::optional<analysis::RatingFit>& fit) {
  if (!fit) return nullptr;
  Json json{{"sensitivity", value(std::optional(fit->sensitivity))},  // d' or d_a
            {"mean", value(fit->mean)},
            {"sd", value(std::optional(fit->sd))},
            {"area", value(std::optional(fit->area))},
            {"log_likelihood", value(fit->log_likelihood)}};
  json["criteria"] = Json::array();
  for (const double criterion : fit->criteria) json["criteria"].push_back(value(criterion));
  return json;
}

Json roc_json(const analysis::RatedDetection& entry) {
  Json json{{"condition", entry.condition}, {"level", value(entry.level)}};
  json["noise"] = entry.noise;  // numbers of trials, from the surest no to the surest yes
  json["signal"] = entry.signal;
  json["points"] = Json::array();
  for (const auto& point : entry.roc.points)
    json["points"].push_back({{"false_alarms", value(point.false_alarms)}, {"hits", value(point.hits)}});
  json["area"] = value(std::optional(entry.roc.area));
  json["equal_variances"] = rating_fit_json(entry.equal);
  json["unequal_variances"] = rating_fit_json(entry.unequal);
  return json;
}

Json discrimination_json(const analysis::Discrimination& entry) {
  Json json{{"condition", entry.condition}, {"level", value(entry.level)}};
  json["correct"] = proportion_json(entry.right);
  json["d_prime"] = Json::array();
  for (const auto& [model, estimate] : entry.d_primes)
    json["d_prime"].push_back({{"model", analysis::name(model)},
                               {"value", value(estimate.value)},
                               {"interval", value(estimate.interval)}});
  return json;
}

Json trend_json(const std::optional<analysis::Trend>& trend) {
  if (!trend) return nullptr;
  return {{"per_100_trials", value(trend->per_100_trials)}, {"interval", value(trend->interval)}};
}

Json side_json(const analysis::SideSettings& side) {
  return {{"settings", side.settings}, {"mean", value(side.mean)}, {"sd", value(side.sd)}};
}

std::string in_english(const std::string& text) { return text; }
std::string in_english(const core::Phrase& phrase) { return core::say(phrase, "en"); }

template <class Fact>
Json facts_json(const std::vector<Fact>& facts) {
  Json json = Json::object();
  for (const auto& [name, text] : facts) json[in_english(name)] = in_english(text);
  return json;
}

}  // namespace

std::string to_json(const Summary& summary) {
  const auto& data = summary.data;
  Json json{{"session_id", data.session_id}, {"participant", data.participant},
            {"title", data.title},           {"run_mode", data.run_mode},
            {"status", data.status},         {"level", core::say(data.level_label, "en")},
            {"level_unit", data.level_unit}, {"choices", data.choices}};
  json["measures"] = meanings_json(data);
  json["facts"] = facts_json(data.facts);
  json["station"] = facts_json(data.health);
  const auto& n = summary.outcomes;
  json["trials"] = {{"presented", n.presented}, {"answered", n.answered},           {"unsure", n.unsure},
                    {"timeouts", n.timeouts},   {"anticipations", n.anticipations}, {"aborted", n.aborted},
                    {"faults", n.faults}};
  json["fits"] = Json::array();
  for (const auto& named : summary.fits) json["fits"].push_back(fit_json(named, data));
  for (const auto& settings : summary.settings)
    json["settings"].push_back({{"procedure", settings.procedure},
                                {"condition", settings.condition},
                                {"settings", settings.values.size()},
                                {"mean", value(settings.mean)},
                                {"sd", value(settings.sd)},
                                {"start_slope", value(settings.start_slope)},
                                {"from_below", side_json(settings.from_below)},
                                {"from_above", side_json(settings.from_above)},
                                {"side_difference", value(settings.side_difference)},
                                {"statements", value(settings.statements)}});
  for (const auto& judged : summary.judgements) json["judgements"].push_back(judgements_json(judged));
  json["confusion"] = Json::array();
  for (const auto& confusion : summary.confusions)
    json["confusion"].push_back(confusion_json(confusion, data));
  json["instructions"] = Json::array();
  for (const auto& entry : summary.trade.instructions)
    json["instructions"].push_back(instruction_json(entry));
  json["model_p"] = value(summary.trade.model_p);
  json["differences"] = Json::array();
  for (const auto& difference : summary.trade.differences)
    json["differences"].push_back({{"first", difference.first},
                                   {"second", difference.second},
                                   {"measure", difference.measure},
                                   {"unit", difference.unit},
                                   {"estimate", value(difference.estimate)},
                                   {"p", difference.estimate ? value(difference.estimate->p) : Json(nullptr)},
                                   {"corrected_p", value(difference.corrected_p)}});
  json["detection"] = Json::array();
  for (const auto& entry : summary.detections)
    json["detection"].push_back({{"condition", entry.condition},
                                 {"level", value(entry.level)},
                                 {"hits", entry.counts.hits},
                                 {"misses", entry.counts.misses},
                                 {"false_alarms", entry.counts.false_alarms},
                                 {"correct_rejections", entry.counts.correct_rejections},
                                 {"d_prime", value(entry.d_prime)},
                                 {"criterion", value(entry.criterion)}});
  json["roc"] = Json::array();
  for (const auto& entry : summary.rocs) json["roc"].push_back(roc_json(entry));
  json["response_signal"] = Json::array();
  for (const auto& curve : summary.curves) {
    auto lags = Json::array();
    for (const auto& point : curve.points) {
      auto levels = Json::array();
      if (!curve.by_level.empty())
        for (const auto& level : curve.by_level[lags.size()])
          levels.push_back({{"level", value(level.level)}, {"d_prime", value(level.d_prime)}});
      lags.push_back({{"after_s", value(point.lag_s)},
                      {"response_time_s", value(point.time_s)},
                      {"hits", point.counts.hits},
                      {"misses", point.counts.misses},
                      {"false_alarms", point.counts.false_alarms},
                      {"correct_rejections", point.counts.correct_rejections},
                      {"d_prime", value(point.d_prime)},
                      {"levels", levels}});
    }
    json["response_signal"].push_back({{"condition", curve.condition},
                                       {"asymptote", value(curve.asymptote)},
                                       {"rate_per_s", value(curve.rate_per_s)},
                                       {"intercept_s", value(curve.intercept_s)},
                                       {"lags", lags}});
  }
  json["response_signal_differences"] = Json::array();
  for (const auto& pair : summary.curve_differences)
    json["response_signal_differences"].push_back({{"first", pair.first},
                                                   {"second", pair.second},
                                                   {"asymptote", value(pair.asymptote)},
                                                   {"asymptote_p", value(pair.p[0])},
                                                   {"rate_p", value(pair.p[1])},
                                                   {"intercept_p", value(pair.p[2])},
                                                   {"asymptote_corrected_p", value(pair.corrected_p[0])},
                                                   {"rate_corrected_p", value(pair.corrected_p[1])},
                                                   {"intercept_corrected_p", value(pair.corrected_p[2])},
                                                   {"rate_ratio", value(pair.rate_ratio)},
                                                   {"intercept_s", value(pair.intercept_s)}});
  json["discrimination"] = Json::array();
  for (const auto& entry : summary.discriminations)
    json["discrimination"].push_back(discrimination_json(entry));
  json["estimates"] = Json::array();
  for (const auto& estimate : data.estimates) json["estimates"].push_back(value(estimate));
  json["early_ends"] = Json::array();
  for (const auto& end : data.early_ends) json["early_ends"].push_back(value(end));
  json["threshold_curves"] = threshold_curves_json(data.threshold_curves);
  json["bias"] = nullptr;
  if (summary.bias)
    json["bias"] = {{"share_second", value(summary.bias->share_second)},
                    {"interval", value(summary.bias->interval)},
                    {"criterion", value(summary.bias->criterion)},
                    {"statements", value(summary.bias->statements)}};
  json["confidence"] = Json::array();
  for (const auto& [degree, right] : summary.confidence)
    json["confidence"].push_back({{"degree", degree},
                                  {"right", right.right},
                                  {"trials", right.trials},
                                  {"proportion", value(right.value)},
                                  {"interval", value(right.interval)}});
  json["catch"] = nullptr;
  if (summary.catch_trials)
    json["catch"] = {{"right", summary.catch_trials->right},
                     {"trials", summary.catch_trials->trials},
                     {"interval", value(summary.catch_trials->interval)}};
  json["finger"] = finger_json(summary.finger);
  json["friction_along_strip"] = strip_json(summary.data.strip);
  json["repeated_trials"] = repeats_json(summary.data.repeats);
  json["trend_response_time_s"] = trend_json(summary.fatigue.response_time_s);
  json["trend_proportion_correct"] = trend_json(summary.fatigue.proportion_correct);
  auto statements = summary.trade.statements;
  statements.insert(statements.end(), summary.fatigue.statements.begin(), summary.fatigue.statements.end());
  json["statements"] = value(statements);
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace turnpoint::report
