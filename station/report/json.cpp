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
  // a noise trial has no level, so its level is null
  json["levels"] = list_of(named.fit.data, [](const auto& point) -> Json {
    return {{"level", value(point.level)}, {"trials", point.trials}, {"positive", value(point.sum())}};
  });
  auto statements = named.fit.statements;
  statements.insert(statements.end(), named.intervals.statements.begin(), named.intervals.statements.end());
  json["statements"] = value(statements);
  return json;
}

Json prediction_json(const analysis::PredictedAnswers& answers) {
  const auto observed =
      list_of(answers.observed_quantiles, [](const auto& quantile) { return value(quantile); });
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
  json["difficulties"] = list_of(entry.cells, [](const auto& cell) -> Json {
    return {{"difficulty", value(cell.difficulty)},
            {"answered", cell.answered},
            {"correct", cell.correct},
            {"interval", value(cell.accuracy)},
            {"mean_correct_s", value(cell.mean_correct_s)},
            {"drift", value(cell.drift)}};
  });
  json["predicted"] = Json::array();
  if (entry.check)
    json["predicted"] = list_of(entry.check->difficulties, [](const auto& at) -> Json {
      return {{"right", prediction_json(at.right)}, {"wrong", prediction_json(at.wrong)}};
    });
  json["caf"] = list_of(entry.caf, [](const auto& bin) -> Json {
    return {{"mean_time_s", value(bin.mean_time_s)},
            {"trials", bin.trials},
            {"correct", bin.correct},
            {"interval", value(analysis::wilson(bin.correct, bin.trials))}};
  });
  json["statements"] = value(entry.statements);
  return json;
}

Json judgements_json(const analysis::Judgements& judged) {
  const auto levels = list_of(judged.levels, [](const auto& level) -> Json {
    return {{"level", value(level.level)},
            {"answers", level.values.size()},
            {"mean", value(level.mean)},
            {"median", value(level.median)}};
  });
  return {{"condition", judged.condition},
          {"levels", levels},
          {"exponent", value(judged.exponent)},
          {"statements", value(judged.statements)}};
}

Json boundaries_json(const std::vector<analysis::AtBoundary>& values) {
  return list_of(values, [](const auto& at) -> Json {
    return {{"planned_mm", value(at.planned_mm)},
            {"value", value(at.value)},
            {"interval", value(at.interval)},
            {"trials", at.trials}};
  });
}

Json finger_json(const std::optional<analysis::Finger>& finger) {
  if (!finger) return nullptr;
  Json json;
  json["conditions"] = list_of(finger->conditions, [](const auto& entry) {
    Json condition{{"condition", entry.condition},
                   {"trials", entry.trials},
                   {"measured", entry.measured},
                   {"felt", entry.felt}};
    for (const auto& row : kFinger) condition[row.key] = value(entry.*row.value);
    return condition;
  });
  json["felt_minus_planned_mm"] = boundaries_json(finger->boundaries.shift_mm);
  json["mu_low"] = boundaries_json(finger->boundaries.mu_low);
  json["mu_high"] = boundaries_json(finger->boundaries.mu_high);
  json["statements"] = value(finger->statements);
  return json;
}

Json proportion_json(const std::optional<analysis::Proportion>& proportion) {
  if (!proportion) return nullptr;
  return {{"right", proportion->right},
          {"trials", proportion->trials},
          {"proportion", value(proportion->value)},
          {"interval", value(proportion->interval)}};
}

void add_counts(const analysis::YesNoCounts& counts, Json& json) {
  json["hits"] = counts.hits, json["misses"] = counts.misses;
  json["false_alarms"] = counts.false_alarms, json["correct_rejections"] = counts.correct_rejections;
}

Json scale_json(const analysis::StimulusScale& scale) {
  Json stimuli = Json::array();
  for (std::size_t i = 0; i < scale.stimuli.size(); ++i) {
    const bool pairs = !scale.chosen.empty();
    stimuli.push_back({{"stimulus", value(scale.stimuli[i])},
                       {"value", scale.fit ? value(scale.fit->values[i]) : Json(nullptr)},
                       {"chosen", pairs ? Json(scale.chosen[i]) : Json(nullptr)},
                       {"presented", pairs ? Json(scale.presented[i]) : Json(nullptr)}});
  }
  const auto& fit = scale.fit;
  const auto& check = scale.check;
  const auto& triples = scale.transitivity;
  constexpr const char* names[] = {"bradley-terry", "thurstone", "differences"};
  return {{"condition", scale.condition},
          {"model", names[static_cast<int>(scale.model)]},
          {"trials", scale.trials},
          {"stimuli", stimuli},
          {"noise", fit ? value(fit->noise) : Json(nullptr)},
          {"favours_second", fit ? value(fit->favours_second) : Json(nullptr)},
          {"favours_second_unit", tendency_unit(scale.model)},
          {"log_likelihood", fit ? value(fit->log_likelihood) : Json(nullptr)},
          {"deviance", fit ? value(fit->deviance) : Json(nullptr)},
          {"degrees_of_freedom", fit ? Json(fit->degrees) : Json(nullptr)},
          {"deviance_p", check ? value(check->deviance_p) : Json(nullptr)},
          {"runs", check ? Json(check->runs) : Json(nullptr)},
          {"runs_p", check ? value(check->runs_p) : Json(nullptr)},
          {"six_points", check && check->six_points > 0 ? Json(check->six_points) : Json(nullptr)},
          {"six_points_p", check ? value(check->six_points_p) : Json(nullptr)},
          {"triples", triples ? Json(triples->triples) : Json(nullptr)},
          {"circular", triples ? Json(triples->circular) : Json(nullptr)},
          {"moderate_violations", triples ? Json(triples->moderate) : Json(nullptr)},
          {"strong_violations", triples ? Json(triples->strong) : Json(nullptr)},
          {"consistence", triples ? value(triples->consistence) : Json(nullptr)},
          {"statements", value(scale.statements)}};
}

Json confusion_json(const analysis::Confusion& confusion, const SessionData& data) {
  const auto rows = list_of(confusion.rows, [&](const auto& row) -> Json {
    return {{"stimulus",
             row.stimulus ? Json(data.choices.at(static_cast<std::size_t>(*row.stimulus))) : Json(nullptr)},
            {"level", value(row.level)},
            {"answers", row.answers},  // the number of each answer, in the order of "choices"
            {"trials", row.trials},
            {"correct", proportion_json(row.right)}};
  });
  return {{"condition", confusion.condition}, {"rows", rows}, {"correct", proportion_json(confusion.right)}};
}

Json rating_fit_json(const std::optional<analysis::RatingFit>& fit) {
  if (!fit) return nullptr;
  return {{"sensitivity", value(fit->sensitivity)},  // d' or d_a
          {"mean", value(fit->mean)},
          {"sd", value(fit->sd)},
          {"area", value(fit->area)},
          {"log_likelihood", value(fit->log_likelihood)},
          {"criteria", list_of(fit->criteria, [](double criterion) { return value(criterion); })}};
}

Json roc_json(const analysis::RatedDetection& entry) {
  const auto points = list_of(entry.roc.points, [](const auto& point) -> Json {
    return {{"false_alarms", value(point.false_alarms)}, {"hits", value(point.hits)}};
  });
  return {{"condition", entry.condition},
          {"level", value(entry.level)},
          {"noise", entry.noise},  // numbers of trials, from the surest no to the surest yes
          {"signal", entry.signal},
          {"points", points},
          {"area", value(entry.roc.area)},
          {"equal_variances", rating_fit_json(entry.equal)},
          {"unequal_variances", rating_fit_json(entry.unequal)}};
}

Json discrimination_json(const analysis::Discrimination& entry) {
  const auto d_primes = list_of(entry.d_primes, [](const auto& one) {
    Json json{{"model", analysis::name(one.first)}};
    json.update(value(one.second));
    return json;
  });
  return {{"condition", entry.condition},
          {"level", value(entry.level)},
          {"correct", proportion_json(entry.right)},
          {"d_prime", d_primes}};
}

Json signal_json(const analysis::SpeedAccuracyCurve& curve) {
  Json lags = Json::array();
  for (const auto& point : curve.points) {
    Json json{{"after_s", value(point.lag_s)}, {"response_time_s", value(point.time_s)}};
    add_counts(point.counts, json);
    json["d_prime"] = value(point.d_prime);
    json["levels"] = Json::array();
    if (!curve.by_level.empty())
      json["levels"] = list_of(curve.by_level[lags.size()], [](const auto& level) -> Json {
        return {{"level", value(level.level)}, {"d_prime", value(level.d_prime)}};
      });
    lags.push_back(std::move(json));
  }
  return {{"condition", curve.condition},
          {"asymptote", value(curve.asymptote)},
          {"rate_per_s", value(curve.rate_per_s)},
          {"intercept_s", value(curve.intercept_s)},
          {"lags", lags}};
}

Json threshold_curve_json(const ThresholdCurve& curve) {
  const auto points = list_of(curve.points, [](const auto& point) -> Json {
    return {{"second", value(point.second)},
            {"threshold", value(point.threshold)},
            {"interval", value(point.interval)}};
  });
  return {{"procedure", curve.procedure},
          {"block", curve.block},
          {"second", core::say(curve.label, "en")},
          {"points", points}};
}

Json trend_json(const std::optional<analysis::Trend>& trend) {
  if (!trend) return nullptr;
  return {{"per_100_trials", value(trend->per_100_trials)}, {"interval", value(trend->interval)}};
}

Json side_json(const analysis::SideSettings& side) {
  return {{"settings", side.settings}, {"mean", value(side.mean)}, {"sd", value(side.sd)}};
}

Json settings_json(const analysis::Settings& settings) {
  return {{"procedure", settings.procedure},
          {"condition", settings.condition},
          {"settings", settings.values.size()},
          {"mean", value(settings.mean)},
          {"sd", value(settings.sd)},
          {"start_slope", value(settings.start_slope)},
          {"from_below", side_json(settings.from_below)},
          {"from_above", side_json(settings.from_above)},
          {"side_difference", value(settings.side_difference)},
          {"statements", value(settings.statements)}};
}

const char* model_name(analysis::Answers answers) {
  switch (answers) {
    case analysis::Answers::sides:
      return "sides";
    case analysis::Answers::choices:
      return "choices";
    case analysis::Answers::values:
      return "ratings";
    case analysis::Answers::settings:
      return "settings";
    case analysis::Answers::logarithms:
      return "logarithms";
  }
  return "";
}

Json dependence_json(const analysis::Dependence& entry) {
  Json json{{"condition", entry.condition},
            {"analysis", entry.analysis},
            {"model", model_name(entry.how.answers)},
            {"answer", entry.answer.empty() ? Json(nullptr) : Json(entry.answer)},
            {"level_unit", entry.unit},
            {"ratios", entry.how.decibel},
            {"pairs", entry.pairs}};
  for (const auto& row : kBefore) {
    const auto& found = entry.*row.value;
    json[row.key] = value(found);
    if (found) json[row.key]["p"] = value(found->p);
  }
  json["curve"] = list_of(entry.curve, [](const auto& point) -> Json {
    return {{"stimulus", point.stimulus}, {"pairs", point.pairs}, {"shift", value(point.shift)}};
  });
  json["statements"] = value(entry.statements);
  return json;
}

std::string in_english(const std::string& text) { return text; }
std::string in_english(const core::Phrase& phrase) { return core::say(phrase, "en"); }

template <class Fact>
Json facts_json(const std::vector<Fact>& facts) {
  Json json = Json::object();
  for (const auto& [name, text] : facts) json[in_english(name)] = in_english(text);
  return json;
}

/// The report of one task.
Json task_json(const Summary& summary) {
  const auto& data = summary.data;
  Json json{{"session_id", data.session_id},
            {"participant", data.participant},
            {"title", data.title},
            {"run_mode", data.run_mode},
            {"task", data.task.empty() ? Json(nullptr) : Json(data.task)},
            {"status", data.status},
            {"level", core::say(data.level_label, "en")},
            {"level_unit", data.level_unit},
            {"choices", data.choices}};
  json["measures"] = meanings_json(data);
  json["facts"] = facts_json(data.facts);
  json["station"] = facts_json(data.health);
  const auto& n = summary.outcomes;
  json["trials"] = {{"presented", n.presented}, {"answered", n.answered},           {"unsure", n.unsure},
                    {"timeouts", n.timeouts},   {"anticipations", n.anticipations}, {"aborted", n.aborted},
                    {"faults", n.faults}};
  json["fits"] = list_of(summary.fits, [&](const auto& named) { return fit_json(named, data); });
  if (!summary.settings.empty()) json["settings"] = list_of(summary.settings, settings_json);
  if (!summary.judgements.empty()) json["judgements"] = list_of(summary.judgements, judgements_json);
  if (!summary.scales.empty()) json["scales"] = list_of(summary.scales, scale_json);
  json["confusion"] =
      list_of(summary.confusions, [&](const auto& confusion) { return confusion_json(confusion, data); });
  json["instructions"] = list_of(summary.trade.instructions, instruction_json);
  json["model_p"] = value(summary.trade.model_p);
  json["differences"] = list_of(summary.trade.differences, [](const auto& difference) -> Json {
    return {{"first", difference.first},
            {"second", difference.second},
            {"measure", difference.measure},
            {"unit", difference.unit},
            {"estimate", value(difference.estimate)},
            {"p", difference.estimate ? value(difference.estimate->p) : Json(nullptr)},
            {"corrected_p", value(difference.corrected_p)}};
  });
  json["trial_before"] = list_of(summary.dependences, dependence_json);
  json["detection"] = list_of(summary.detections, [](const auto& entry) {
    Json detection{{"condition", entry.condition}, {"level", value(entry.level)}};
    add_counts(entry.counts, detection);
    detection["d_prime"] = value(entry.d_prime), detection["criterion"] = value(entry.criterion);
    return detection;
  });
  json["roc"] = list_of(summary.rocs, roc_json);
  json["response_signal"] = list_of(summary.curves, signal_json);
  json["response_signal_differences"] = list_of(summary.curve_differences, [](const auto& pair) -> Json {
    return {{"first", pair.first},
            {"second", pair.second},
            {"asymptote", value(pair.asymptote)},
            {"asymptote_p", value(pair.p[0])},
            {"rate_p", value(pair.p[1])},
            {"intercept_p", value(pair.p[2])},
            {"asymptote_corrected_p", value(pair.corrected_p[0])},
            {"rate_corrected_p", value(pair.corrected_p[1])},
            {"intercept_corrected_p", value(pair.corrected_p[2])},
            {"rate_ratio", value(pair.rate_ratio)},
            {"intercept_s", value(pair.intercept_s)}};
  });
  json["discrimination"] = list_of(summary.discriminations, discrimination_json);
  json["estimates"] = list_of(data.estimates, [](const auto& one) { return value(one); });
  json["early_ends"] = list_of(data.early_ends, [](const auto& end) { return value(end); });
  json["threshold_curves"] = list_of(data.threshold_curves, threshold_curve_json);
  json["bias"] = nullptr;
  if (summary.bias)
    json["bias"] = {{"share_second", value(summary.bias->share_second)},
                    {"interval", value(summary.bias->interval)},
                    {"criterion", value(summary.bias->criterion)},
                    {"statements", value(summary.bias->statements)}};
  json["confidence"] = list_of(summary.confidence, [](const auto& one) {
    Json confidence{{"degree", one.first}};
    confidence.update(proportion_json(one.second));
    return confidence;
  });
  json["catch"] = proportion_json(summary.catch_trials);
  json["finger"] = finger_json(summary.finger);
  json["friction_along_strip"] = list_of(data.strip, [](const auto& curve) -> Json {
    return {{"direction", curve.direction},
            {"from_boundary_mm", curve.from_boundary_mm},
            {"friction", curve.friction},
            {"se", curve.se}};
  });
  json["following"] = list_of(summary.followed, [](const auto& entry) {
    Json condition{{"condition", entry.condition}, {"trials", entry.trials}, {"faultless", entry.faultless}};
    for (const auto& row : kFollowing) condition[row.key] = value(entry.*row.value);
    return condition;
  });
  json["friction_over_place"] = list_of(data.followed_places, [](const auto& places) -> Json {
    const auto spreads = [](const std::vector<analysis::Spread>& list) {
      return list_of(list, [](const auto& one) -> Json {
        return {{"median", value(one.median)}, {"low", value(one.low)}, {"high", value(one.high)}};
      });
    };
    return {{"condition", places.condition},
            {"scene", places.scene},
            {"direction", places.narrow ? "towards the narrow end" : "towards the wide end"},
            {"place_mm", places.place_mm},
            {"asked", spreads(places.asked)},
            {"commanded", spreads(places.commanded)},
            {"felt", spreads(places.felt)},
            {"felt_minus_asked", spreads(places.deviation)}};
  });
  json["repeated_trials"] = list_of(data.repeats, [](const auto& at) -> Json {
    return {{"level", value(at.level)}, {"presented", at.presented}, {"repeated", at.repeated}};
  });
  json["trend_response_time_s"] = trend_json(summary.fatigue.response_time_s);
  json["trend_proportion_correct"] = trend_json(summary.fatigue.proportion_correct);
  auto statements = summary.trade.statements;
  statements.insert(statements.end(), summary.fatigue.statements.begin(), summary.fatigue.statements.end());
  json["statements"] = value(statements);
  return json;
}

std::string dumped(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

}  // namespace

std::string to_json(const Summary& summary) { return dumped(task_json(summary)); }

std::string to_json(const std::vector<Summary>& of_tasks) {
  if (of_tasks.size() == 1) return to_json(of_tasks.front());
  // what is about the whole session is not repeated with each task
  Json whole, tasks = Json::array();
  for (const auto& summary : of_tasks) {
    auto one = task_json(summary);
    for (const auto* key : {"session_id", "participant", "title", "run_mode", "status", "facts", "station"}) {
      whole[key] = one[key];
      one.erase(key);
    }
    tasks.push_back(std::move(one));
  }
  whole["tasks"] = std::move(tasks);
  return dumped(whole);
}

}  // namespace turnpoint::report
