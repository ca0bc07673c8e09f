#include "station/simulation/power.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/analysis/trade.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/report/stored_trials.hpp"
#include "station/report/summary.hpp"
#include "station/simulation/parallel.hpp"
#include "station/simulation/power_truth.hpp"
#include "station/simulation/rehearsal.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::simulation {

namespace {

/// One number that the analysis of one session estimated.
struct Finding {
  std::string source, parameter, unit;
  double value = 0;
  std::optional<analysis::Interval> interval;
};

struct Outcome {
  std::vector<Finding> findings;
  GeneratingValues generating;
  /// condition and options of each psychometric fit
  std::vector<std::pair<std::string, analysis::FitOptions>> fits;
  report::Design design = report::Design::forced_choice;
  int presented = 0, scored = 0, right = 0;
  double duration_s = 0;
};

std::string of(const std::string& what, const std::string& instruction) {
  return instruction.empty() ? what : what + " " + instruction;
}

std::optional<analysis::Interval> interval_of(const std::optional<analysis::ParameterInterval>& found) {
  return found ? std::optional(found->interval) : std::nullopt;
}

/// Adds the procedures' own threshold estimates. A report prints no intervals for them.
void add_estimates(const Rehearsal& rehearsal, const std::string& unit, std::vector<Finding>& findings) {
  for (const auto& estimate : rehearsal.estimates)
    if (estimate.parameter == "threshold")
      findings.push_back({"procedure " + estimate.procedure, estimate.parameter, unit, estimate.mean, {}});
}

/// True for estimates whose distribution has a long tail. A slope is one of them: if the best fit is a step,
/// the slope has no upper limit.
bool heavy_tailed(const std::string& parameter) { return parameter == "slope" || parameter == "spread"; }

const char* spread_name(const analysis::FitOptions& options) {
  return options.function == terms::Function::normal ? "spread" : "slope";
}

std::string slope_unit(const analysis::FitOptions& options, const std::string& level_unit) {
  switch (options.function) {
    case terms::Function::normal:
      return level_unit;
    case terms::Function::logistic:
      return level_unit.empty() ? "" : "1/" + level_unit;
    case terms::Function::weibull:
      break;
  }
  return "exponent";
}

void add_fits(const report::SessionData& data, const std::string& unit, Outcome& outcome) {
  for (const auto& judged : report::judgements_of(data))
    if (judged.exponent)
      outcome.findings.push_back({of("numbers", judged.condition), "exponent", "", judged.exponent->value,
                                  judged.exponent->interval});
  if (report::judges(data.design)) return;
  if (data.design == report::Design::adjustment) {
    for (const auto& settings : analysis::settings(data.trials, data.conditions))
      if (settings.mean)
        outcome.findings.push_back({of(of("settings", settings.procedure), settings.condition), "PSE", unit,
                                    settings.mean->value, settings.mean->interval});
    return;
  }
  for (const auto& named : report::fits_of(data)) {
    outcome.fits.emplace_back(named.name, named.fit.options);
    if (!named.fit.parameters) continue;
    const auto& p = *named.fit.parameters;
    const auto source = of("fit", named.name);
    const bool two_sided = data.design == report::Design::two_sided;
    auto& findings = outcome.findings;
    findings.push_back(
        {source, two_sided ? "PSE" : "threshold", unit, p.threshold, interval_of(named.intervals.threshold)});
    const bool posterior = named.intervals.method == analysis::IntervalMethod::posterior;
    if (!posterior || report::slope_estimated(named))
      findings.push_back({source, spread_name(named.fit.options), slope_unit(named.fit.options, unit),
                          p.slope, interval_of(named.intervals.slope)});
    const auto level_75 =
        posterior ? named.intervals.level_75
                  : analysis::level_at(named.fit.options.function, named.fit.options.scale, p, 0.75);
    if (level_75)
      findings.push_back({source, "75 % point", unit, *level_75, interval_of(named.intervals.interval_75)});
  }
}

void add_differences(const analysis::Trade& trade, std::vector<Finding>& findings) {
  for (const auto& difference : trade.differences)
    if (difference.estimate)
      findings.push_back({difference.second + " - " + difference.first, difference.measure, difference.unit,
                          difference.estimate->value, difference.estimate->interval});
}

Outcome simulate(const protocol::Protocol& protocol, const PowerOptions& options, int session) {
  const observer::Observer observer(options.observer);
  Outcome outcome;
  const auto seed = options.seed + static_cast<std::uint64_t>(session);
  auto sits = rehearser(observer);
  sits.answer = [&](const trial::TrialSpec& trial, const observer::Question& q) {
    outcome.generating.add(protocol, trial, q, observer);
    return observer.answer(q);
  };
  const auto rehearsal = rehearse(protocol, session, seed, sits);
  report::SessionData data;
  report::add_trials(rehearsal.blocks, protocol, data);
  data.seed = seed;
  data.replicates = session < options.interval_sessions ? options.replicates : 0;
  const auto& unit = data.level_unit;
  add_estimates(rehearsal, unit, outcome.findings);
  add_fits(data, unit, outcome);
  if (data.replicates > 0)
    add_differences(analysis::trade(data.trials, report::trade_options(data)), outcome.findings);
  outcome.design = data.design;
  outcome.presented = rehearsal.trials;
  outcome.duration_s = rehearsal.duration_s;
  for (const auto& trial : data.trials)
    if (trial.type == terms::TrialType::experimental && trial.correct)
      ++outcome.scored, outcome.right += *trial.correct ? 1 : 0;
  return outcome;
}

Recovery& entry_for(const Finding& finding, std::vector<Recovery>& recoveries) {
  for (auto& entry : recoveries)
    if (entry.source == finding.source && entry.parameter == finding.parameter) return entry;
  auto& entry = recoveries.emplace_back();
  entry.source = finding.source, entry.parameter = finding.parameter, entry.unit = finding.unit;
  return entry;
}

/// The true value of each estimated number, by source and parameter.
class Truths {
 public:
  Truths(const protocol::Protocol& protocol, const PowerOptions& options,
         const std::vector<Outcome>& outcomes) {
    const observer::Observer observer(options.observer);
    for (const auto& spec : protocol.procedures)
      if (const auto level = settled_level(protocol, spec, observer))
        add("procedure " + spec.name, "threshold", *level);
    for (const auto& spec : protocol.procedures)
      if (spec.kind == procedure::Kind::adjustment)
        for (const auto& condition : with_none(protocol::conditions(protocol)))
          add(of(of("settings", spec.name), condition), "PSE", options.observer.bias);
    if (protocol.task.value && protocol.task.value->typed)
      for (const auto& condition : with_none(protocol::conditions(protocol)))
        add(of("numbers", condition), "exponent", options.observer.slope);
    GeneratingValues generating;
    for (const auto& outcome : outcomes) generating.add(outcome.generating);
    add_fits(generating, observer, outcomes);
    add_differences(generating, observer, protocol::conditions(protocol));
  }

  std::optional<double> find(const Recovery& recovery) const {
    for (const auto& truth : truths_)
      if (truth.source == recovery.source && truth.parameter == recovery.parameter) return truth.value;
    return std::nullopt;
  }

 private:
  void add(const std::string& source, const std::string& parameter, const std::optional<double>& value) {
    if (value) truths_.push_back({source, parameter, "", *value, {}});
  }

  static std::vector<std::string> with_none(std::vector<std::string> names) {
    names.emplace_back();
    return names;
  }

  void add_fits(const GeneratingValues& generating, const observer::Observer& observer,
                const std::vector<Outcome>& outcomes) {
    const bool two_sided = outcomes.front().design == report::Design::two_sided;
    for (const auto& [condition, options] : outcomes.front().fits) {
      const auto truth = generating.fit(condition, options, observer);
      const auto source = of("fit", condition);
      add(source, two_sided ? "PSE" : "threshold", truth.threshold);
      add(source, spread_name(options), truth.slope);
      add(source, "75 % point", truth.level_75);
    }
  }

  void add_differences(const GeneratingValues& generating, const observer::Observer& observer,
                       const std::vector<std::string>& names) {
    for (std::size_t a = 0; a < names.size(); ++a)
      for (std::size_t b = a + 1; b < names.size(); ++b) {
        const auto source = names[b] + " - " + names[a];
        const auto add_gap = [&](const char* parameter, std::optional<double> first,
                                 std::optional<double> second) {
          if (first && second) add(source, parameter, *second - *first);
        };
        add_gap("proportion correct", generating.share_correct(names[a]), generating.share_correct(names[b]));
        add_gap("boundary", generating.boundary(names[a], observer), generating.boundary(names[b], observer));
        // the time that a simulated observer needs outside the decision is equal in all conditions
        add(source, "time outside the decision", 0);
      }
  }

  std::vector<Finding> truths_;
};

void finish(Recovery& entry, const std::vector<analysis::Interval>& intervals) {
  const auto n = static_cast<double>(entry.estimates.size());
  entry.heavy_tailed = heavy_tailed(entry.parameter);
  entry.mean = std::accumulate(entry.estimates.begin(), entry.estimates.end(), 0.0) / n;
  double squares = 0;
  for (const double value : entry.estimates) squares += (value - entry.mean) * (value - entry.mean);
  entry.sd = n > 1 ? std::sqrt(squares / (n - 1)) : 0;
  entry.median = analysis::quantile(entry.estimates, 0.5);
  entry.lower_quartile = analysis::quantile(entry.estimates, 0.25);
  entry.upper_quartile = analysis::quantile(entry.estimates, 0.75);
  if (entry.truth) entry.bias = (entry.heavy_tailed ? entry.median : entry.mean) - *entry.truth;
  if (intervals.empty()) return;
  std::vector<double> widths;
  int hold = 0;
  for (const auto& interval : intervals) {
    widths.push_back(interval.high - interval.low);
    if (entry.truth && interval.low <= *entry.truth && *entry.truth <= interval.high) ++hold;
  }
  const auto count = static_cast<int>(intervals.size());
  entry.interval_width = analysis::quantile(std::move(widths), 0.5);
  if (entry.truth)
    entry.coverage =
        analysis::Proportion{hold, count, static_cast<double>(hold) / count, analysis::wilson(hold, count)};
}

std::vector<Recovery> recover(const protocol::Protocol& protocol, const PowerOptions& options,
                              const std::vector<Outcome>& outcomes) {
  std::vector<Recovery> recoveries;
  std::vector<std::vector<analysis::Interval>> intervals;
  for (const auto& outcome : outcomes)
    for (const auto& finding : outcome.findings) {
      auto& entry = entry_for(finding, recoveries);
      entry.estimates.push_back(finding.value);
      intervals.resize(recoveries.size());
      const auto index = static_cast<std::size_t>(&entry - recoveries.data());
      if (finding.interval) intervals[index].push_back(*finding.interval);
    }
  const Truths truths(protocol, options, outcomes);
  for (std::size_t i = 0; i < recoveries.size(); ++i) {
    const bool difference = recoveries[i].source.find(" - ") != std::string::npos;
    recoveries[i].sessions =
        difference ? std::min(options.interval_sessions, options.observers) : options.observers;
    recoveries[i].truth = truths.find(recoveries[i]);
    finish(recoveries[i], intervals[i]);
  }
  return recoveries;
}

}  // namespace

Power power(const protocol::Protocol& protocol, const PowerOptions& options) {
  if (options.observers < 1 || options.interval_sessions < 0 || options.replicates < 40 ||
      options.threads < 1)
    throw std::invalid_argument(
        "power: there must be at least 1 observer, 1 thread and 40 replicates, and the number of sessions "
        "with intervals must not be negative");
  if (protocol::judges(protocol.task) && !(protocol.task.value && protocol.task.value->typed))
    throw terms::UsageError(protocol.path +
                            ": ratings have no threshold, so there is nothing to estimate; simulate sessions "
                            "with `turnpoint run --observer sim` and analyse their export");
  std::vector<Outcome> outcomes(static_cast<std::size_t>(options.observers));
  in_parallel(options.observers, options.threads, options.progress, [&](int session) {
    outcomes[static_cast<std::size_t>(session)] = simulate(protocol, options, session);
  });
  Power power;
  power.observers = options.observers;
  power.interval_sessions = std::min(options.interval_sessions, options.observers);
  int scored = 0, right = 0;
  for (const auto& outcome : outcomes) {
    power.trials += static_cast<double>(outcome.presented) / options.observers;
    power.minutes += outcome.duration_s / 60 / options.observers;
    scored += outcome.scored, right += outcome.right;
  }
  if (scored > 0) power.accuracy = static_cast<double>(right) / scored;
  power.recoveries = recover(protocol, options, outcomes);
  return power;
}

}  // namespace turnpoint::simulation
