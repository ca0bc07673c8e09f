#include "station/rehearsal/power.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/visits.hpp"
#include "station/rehearsal/power_session.hpp"
#include "station/report/stored_trials.hpp"
#include "station/trial/question.hpp"

namespace turnpoint::rehearsal {

namespace {

/// True for estimates whose distribution has a long tail. A slope is one of them: if the best fit is a step,
/// the slope has no upper limit.
bool heavy_tailed(const std::string& parameter) { return parameter == "slope" || parameter == "spread"; }

Recovery& entry_for(const Finding& finding, std::vector<Recovery>& recoveries) {
  for (auto& entry : recoveries)
    if (entry.source == finding.source && entry.parameter == finding.parameter) return entry;
  auto& entry = recoveries.emplace_back();
  entry.source = finding.source, entry.parameter = finding.parameter, entry.unit = finding.unit;
  return entry;
}

/// Returns the mean of the settings of a slider; empty if it depends on other factors.
std::optional<double> mean_setting(const protocol::Protocol& protocol, double bias) {
  auto factors = protocol::any_factors(protocol);
  const double equal = trial::equal_setting(protocol, factors);
  for (const auto& factor : protocol.factors)
    for (const auto& level : factor.levels) {
      auto others = factors;
      others[factor.name] = level;
      if (trial::equal_setting(protocol, others) != equal) return std::nullopt;
    }
  return equal + bias;
}

/// The true value of each estimated number, by source and parameter.
class Truths {
 public:
  Truths(const protocol::Protocol& protocol, const PowerOptions& options,
         const std::vector<SessionOutcome>& outcomes) {
    const simulation::Observer observer(options.observer);
    for (const auto& spec : protocol.procedures)
      for (const auto& [parameter, value] : true_parameters(protocol, spec, observer))
        for (int number = 1; number <= protocol::session_count(protocol); ++number)
          add("procedure " + spec.name + session_suffix(protocol, number), parameter, value);
    for (const auto& spec : protocol.procedures)
      if (spec.kind == procedure::Kind::adjustment)
        for (const auto& condition : with_none(protocol::analysed_conditions(protocol)))
          add(source_of(source_of("settings", spec.name), condition), "PSE",
              mean_setting(protocol, options.observer.bias));
    if (protocol.task.value && protocol.task.value->typed)
      for (const auto& condition : with_none(protocol::analysed_conditions(protocol)))
        add(source_of("numbers", condition), "exponent", options.observer.slope);
    GeneratingValues generating;
    for (const auto& outcome : outcomes) generating.add(outcome.generating);
    if (outcomes.front().design == report::Design::categories)
      for (const auto& condition : with_none(protocol::analysed_conditions(protocol)))
        add(source_of("answers", condition), "proportion correct", generating.share_correct(condition));
    add_d_primes(protocol, generating, observer);
    add_fits(generating, observer, outcomes);
    add_differences(generating, observer, protocol::analysed_conditions(protocol));
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

  /// Adds the true d' of each model: the value of d' at which the model gives the simulated observer's true
  /// proportion correct.
  void add_d_primes(const protocol::Protocol& protocol, const GeneratingValues& generating,
                    const simulation::Observer& observer) {
    std::set<double> levels;
    for (const auto& spec : protocol.procedures) levels.insert(spec.values.begin(), spec.values.end());
    const auto unit = protocol::words_of(protocol::common_level(protocol).value_or("")).unit;
    const auto intervals = static_cast<int>(protocol.task.choices.size());
    const auto add_at = [&](const std::string& condition, const std::optional<double>& level,
                            const std::optional<double>& share) {
      for (const auto model : report::deciding_in(protocol.task.kind))
        if (share)
          add(source_of("answers", condition), d_prime_name(model, level, unit),
              analysis::d_prime(model, *share, intervals));
    };
    for (const auto& condition : with_none(protocol::analysed_conditions(protocol))) {
      add_at(condition, std::nullopt, generating.share_correct(condition));
      for (const double level : levels)
        add_at(condition, level, generating.share_correct_at(condition, level, observer));
    }
  }

  void add_fits(const GeneratingValues& generating, const simulation::Observer& observer,
                const std::vector<SessionOutcome>& outcomes) {
    for (const auto& [condition, options] : outcomes.front().fits) {
      const auto truth = generating.fit(condition, options, observer);
      const auto source = source_of("fit", condition);
      const bool two_sided = options.guess == analysis::Guess::tied_to_lapse;
      add(source, two_sided ? "PSE" : "threshold", truth.threshold);
      add(source, spread_name(options), truth.slope);
      add(source, "75 % point", truth.level_75);
    }
  }

  void add_differences(const GeneratingValues& generating, const simulation::Observer& observer,
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
        // the time that a simulated observer needs outside the decision is the same in all conditions, so the
        // true difference is 0
        add(source, "time outside the decision", 0);
        // its drift depends on the stimulus only
        add(source, "drift", 0);
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
  // if all answers are right, the interval of d' has no upper end
  const double width = analysis::quantile(std::move(widths), 0.5);
  if (std::isfinite(width)) entry.interval_width = width;
  if (entry.truth)
    entry.coverage =
        analysis::Proportion{hold, count, static_cast<double>(hold) / count, analysis::wilson(hold, count)};
}

std::vector<Recovery> recover(const protocol::Protocol& protocol, const PowerOptions& options,
                              const std::vector<SessionOutcome>& outcomes) {
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

int sessions_of(const Part& part, int observers) { return (observers - part.number) / part.of + 1; }

Power power_of(const protocol::Protocol& protocol, const PowerOptions& asked,
               const std::vector<SessionOutcome>& outcomes) {
  auto options = asked;
  options.observers = static_cast<int>(outcomes.size());
  Power power;
  power.observers = options.observers, power.asked = asked.observers;
  if (outcomes.empty()) return power;
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

Power power(const protocol::Protocol& protocol, const PowerOptions& options) {
  return power_of(protocol, options, simulate_sessions(protocol, options));
}

}  // namespace turnpoint::rehearsal
