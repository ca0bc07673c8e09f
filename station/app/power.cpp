#include "station/app/power.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "station/analysis/proportion.hpp"
#include "station/analysis/trade.hpp"
#include "station/app/parallel.hpp"
#include "station/app/power_truth.hpp"
#include "station/app/records.hpp"
#include "station/app/rehearsal.hpp"
#include "station/report/summary.hpp"

namespace turnpoint::app {

namespace {

using analysis::Interval;

/// One number that one session found.
struct Finding {
  std::string source, parameter, unit;
  double value = 0;
  std::optional<Interval> interval;
};

struct Outcome {
  std::vector<Finding> findings;
  std::vector<analysis::TrialRecord> trials;  ///< only of sessions with intervals
  ExpectedAnswers expected;
  std::vector<std::pair<std::string, analysis::FitOptions>> fits;  ///< instruction, options
  report::Design design = report::Design::forced_choice;
  int presented = 0, scored = 0, right = 0;
  double duration_s = 0;
};

std::string of(const std::string& what, const std::string& instruction) {
  return instruction.empty() ? what : what + " " + instruction;
}

std::optional<Interval> interval_of(const std::optional<analysis::ParameterInterval>& found) {
  return found ? std::optional(found->interval) : std::nullopt;
}

/// What the procedures themselves estimate; a report prints no interval of it.
void add_estimates(const Rehearsal& rehearsal, const std::string& unit, std::vector<Finding>& findings) {
  for (const auto& estimate : rehearsal.estimates)
    if (estimate.parameter == "threshold")
      findings.push_back({"procedure " + estimate.procedure, estimate.parameter, unit, estimate.mean, {}});
}

const char* spread_name(const analysis::FitOptions& options) {
  return options.function == analysis::Function::normal ? "spread" : "slope";
}

void add_fits(const report::SessionData& data, const std::string& unit, Outcome& outcome) {
  if (data.design == report::Design::adjustment) {
    for (const auto& settings : analysis::settings(data.trials))
      if (settings.mean)
        outcome.findings.push_back(
            {of("settings", settings.procedure), "PSE", unit, settings.mean->value, settings.mean->interval});
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
      findings.push_back({source, spread_name(named.fit.options), two_sided ? unit : "", p.slope,
                          interval_of(named.intervals.slope)});
    const auto level_75 =
        posterior ? named.intervals.level_75
                  : analysis::level_at(named.fit.options.function, named.fit.options.scale, p, 0.75);
    if (level_75)
      findings.push_back({source, "75 % point", unit, *level_75, interval_of(named.intervals.interval_75)});
  }
}

/// The second instruction minus the first, whichever a session began with.
void add_differences(const analysis::Trade& trade, std::vector<Finding>& findings) {
  if (trade.instructions.size() < 2) return;
  auto first = trade.instructions[0].instruction, second = trade.instructions[1].instruction;
  const bool turned = second < first;
  if (turned) std::swap(first, second);
  for (const auto& difference : trade.differences) {
    if (!difference.estimate) continue;
    auto value = difference.estimate->value;
    auto interval = difference.estimate->interval;
    if (turned) value = -value, interval = {-interval.high, -interval.low, interval.confidence};
    findings.push_back({second + " - " + first, difference.measure, difference.unit, value, interval});
  }
}

analysis::TradeOptions trade_options(const report::SessionData& data) {
  analysis::TradeOptions options;
  options.exclusion = data.exclusion;
  options.replicates = data.replicates;
  options.seed = data.seed;
  return options;
}

Outcome simulate(const protocol::Protocol& protocol, const PowerOptions& options, int session) {
  const observer::Observer observer(options.observer);
  Outcome outcome;
  const auto seed = options.seed + static_cast<std::uint64_t>(session);
  auto sits = rehearser(observer);
  sits.answer = [&](const session::TrialSpec& trial, const observer::Question& q) {
    outcome.expected.add(protocol, trial, q, observer);
    return observer.answer(q);
  };
  const auto rehearsal = rehearse(protocol, session, seed, sits);
  report::SessionData data;
  add_trials(rehearsal.blocks, protocol, protocol.languages.front(), data);
  data.seed = seed;
  data.replicates = session < options.interval_sessions ? options.replicates : 0;
  const auto unit = report::unit_of(data.level_label);
  add_estimates(rehearsal, unit, outcome.findings);
  add_fits(data, unit, outcome);
  if (data.replicates > 0)
    add_differences(analysis::trade(data.trials, trade_options(data)), outcome.findings);
  outcome.design = data.design;
  outcome.presented = rehearsal.trials;
  outcome.duration_s = rehearsal.duration_s;
  for (const auto& trial : data.trials)
    if (trial.type == analysis::TrialType::experimental && trial.correct)
      ++outcome.scored, outcome.right += *trial.correct ? 1 : 0;
  if (data.replicates > 0) outcome.trials = std::move(data.trials);
  return outcome;
}

Recovery& entry_for(const Finding& finding, std::vector<Recovery>& recoveries) {
  for (auto& entry : recoveries)
    if (entry.source == finding.source && entry.parameter == finding.parameter) return entry;
  auto& entry = recoveries.emplace_back();
  entry.source = finding.source, entry.parameter = finding.parameter, entry.unit = finding.unit;
  return entry;
}

/// What each number should have come out as, by source and parameter.
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
        add(of("settings", spec.name), "PSE", options.observer.bias);
    add_fits(outcomes);
    add_differences_of_all(protocol, outcomes);
  }

  std::optional<double> find(const Recovery& recovery) const {
    for (const auto& truth : truths_)
      if (truth.source == recovery.source && truth.parameter == recovery.parameter) return truth.value;
    return std::nullopt;
  }

 private:
  void add(const std::string& source, const std::string& parameter, double value) {
    truths_.push_back({source, parameter, "", value, {}});
  }

  void add_fits(const std::vector<Outcome>& outcomes) {
    ExpectedAnswers expected;
    for (const auto& outcome : outcomes) expected.add(outcome.expected);
    const bool two_sided = outcomes.front().design == report::Design::two_sided;
    const auto count = outcomes.front().design == report::Design::forced_choice
                           ? ExpectedAnswers::Count::correct
                           : ExpectedAnswers::Count::choice;
    for (const auto& [instruction, fit_options] : outcomes.front().fits) {
      const auto p = expected.fit(instruction, fit_options, count);
      if (!p) continue;
      const auto source = of("fit", instruction);
      add(source, two_sided ? "PSE" : "threshold", p->threshold);
      add(source, spread_name(fit_options), p->slope);
      if (const auto level = analysis::level_at(fit_options.function, fit_options.scale, *p, 0.75))
        add(source, "75 % point", *level);
    }
  }

  void add_differences_of_all(const protocol::Protocol& protocol, const std::vector<Outcome>& outcomes) {
    std::vector<analysis::TrialRecord> all;
    for (const auto& outcome : outcomes) all.insert(all.end(), outcome.trials.begin(), outcome.trials.end());
    analysis::TradeOptions options;
    options.exclusion = {protocol.analysis.exclude_below_s, protocol.analysis.exclude_mad};
    options.replicates = 1;  // only the numbers count here
    if (!all.empty()) add_differences(analysis::trade(all, options), truths_);
  }

  std::vector<Finding> truths_;
};

void finish(Recovery& entry, const std::vector<Interval>& intervals) {
  const auto n = static_cast<double>(entry.estimates.size());
  entry.mean = std::accumulate(entry.estimates.begin(), entry.estimates.end(), 0.0) / n;
  double squares = 0;
  for (const double value : entry.estimates) squares += (value - entry.mean) * (value - entry.mean);
  entry.sd = n > 1 ? std::sqrt(squares / (n - 1)) : 0;
  if (entry.truth) entry.bias = entry.mean - *entry.truth;
  if (intervals.empty()) return;
  double width = 0;
  int hold = 0;
  for (const auto& interval : intervals) {
    width += interval.high - interval.low;
    if (entry.truth && interval.low <= *entry.truth && *entry.truth <= interval.high) ++hold;
  }
  const auto count = static_cast<int>(intervals.size());
  entry.interval_width = width / count;
  if (entry.truth)
    entry.coverage =
        analysis::Proportion{hold, count, static_cast<double>(hold) / count, analysis::wilson(hold, count)};
}

std::vector<Recovery> recover(const protocol::Protocol& protocol, const PowerOptions& options,
                              const std::vector<Outcome>& outcomes) {
  std::vector<Recovery> recoveries;
  std::vector<std::vector<Interval>> intervals;
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
        "power: at least 1 observer and thread, 40 replicates, and no negative number of sessions with "
        "intervals are allowed");
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

}  // namespace turnpoint::app
