#include "station/rehearsal/power.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/protocol/visits.hpp"
#include "station/rehearsal/power_session.hpp"
#include "station/report/stored_trials.hpp"
#include "station/report/study.hpp"
#include "station/report/summary.hpp"
#include "station/trial/question.hpp"

namespace turnpoint::rehearsal {

namespace {

/// True for estimates whose distribution has a long tail. A slope is one of them: if the best fit is a step,
/// the slope has no upper limit.
bool heavy_tailed(const std::string& parameter) {
  return parameter == "slope" || parameter == "spread" || parameter == kRate || parameter == kRateRatio;
}

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
    // a procedure may run in blocks with different boundaries, and then converges on no one level
    for (const auto& spec : protocol.procedures) {
      if (!options.cautions.empty()) break;
      for (const auto& [parameter, value] : true_parameters(protocol, spec, observer))
        for (int number = 1; number <= protocol::session_count(protocol); ++number)
          add("procedure " + spec.name + session_suffix(protocol, number), parameter, value);
    }
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
    const auto& meaning = protocol.meanings.front();
    if (const auto model = report::scale_model(meaning.design, meaning.function))
      for (const auto& condition : with_none(protocol::analysed_conditions(protocol)))
        for (const auto& [parameter, value] :
             generating.scale(condition, *model, protocol::words_of(meaning.level).unit))
          add(source_of("scale", condition), parameter, value);
    if (outcomes.front().design == report::Design::categories)
      for (const auto& condition : with_none(protocol::analysed_conditions(protocol)))
        add(source_of("answers", condition), analysis::kCorrect, generating.share_correct(condition));
    add_d_primes(protocol, generating, observer);
    add_fits(generating, observer, outcomes);
    add_differences(generating, observer, protocol::analysed_conditions(protocol));
    for (const auto& condition : with_none(protocol::analysed_conditions(protocol))) {
      const auto diffusion = source_of("diffusion", condition), signal = source_of("signal", condition);
      add(diffusion, analysis::kBoundary, generating.boundary(condition, observer));
      add(diffusion, analysis::kDrift, generating.drift(condition));
      if (options.observer.residual_range_s == 0)
        add(diffusion, analysis::kNondecision, observer.nondecision_s());
      if (const auto curve = generating.curve(condition)) {
        add(signal, kAsymptote, (*curve)[0]);
        add(signal, kRate, (*curve)[1]);
        add(signal, kIntercept, (*curve)[2]);
      }
    }
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
    std::set<std::string> added;
    for (const auto& outcome : outcomes)  // of groups, each person has only some of the conditions
      for (const auto& [condition, options] : outcome.fits) {
        if (!added.insert(condition).second) continue;
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
        add_gap(analysis::kCorrect, generating.share_correct(names[a]), generating.share_correct(names[b]));
        add_gap(analysis::kBoundary, generating.boundary(names[a], observer),
                generating.boundary(names[b], observer));
        // the time that a simulated observer needs outside the decision is the same in all conditions, so the
        // true difference is 0
        add(source, analysis::kNondecision, 0);
        // its drift depends on the stimulus only
        add(source, analysis::kDrift, 0);
        const auto first = generating.curve(names[a]), second = generating.curve(names[b]);
        if (!first || !second) continue;
        add(source, kAsymptote, (*second)[0] - (*first)[0]);
        add(source, kRateRatio, (*second)[1] / (*first)[1]);
        add(source, kIntercept, (*second)[2] - (*first)[2]);
      }
  }

  std::vector<Finding> truths_;
};

analysis::Proportion proportion_of(int count, int of) {
  return {count, of, static_cast<double>(count) / of, analysis::wilson(count, of)};
}

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
  if (entry.truth) entry.coverage = proportion_of(hold, count);
}

/// Gathers the findings of sessions or studies. `truth_of` says what is true of an entry.
template <class TruthOf>
std::vector<Recovery> recover(const std::vector<std::vector<Finding>>& all, int with_intervals,
                              const TruthOf& truth_of) {
  std::vector<Recovery> recoveries;
  std::vector<std::vector<analysis::Interval>> intervals;
  std::vector<std::pair<int, int>> claims;  // number of claims, and of findings that could be one
  for (const auto& findings : all)
    for (const auto& finding : findings) {
      auto& entry = entry_for(finding, recoveries);
      entry.estimates.push_back(finding.value);
      intervals.resize(recoveries.size()), claims.resize(recoveries.size());
      const auto index = static_cast<std::size_t>(&entry - recoveries.data());
      if (finding.interval) intervals[index].push_back(*finding.interval);
      if (finding.claimed) claims[index].first += *finding.claimed, ++claims[index].second;
    }
  const auto count = static_cast<int>(all.size());
  for (std::size_t i = 0; i < recoveries.size(); ++i) {
    auto& entry = recoveries[i];
    // findings that need many computations are made of some sessions only
    const auto is = [&entry](const char* what) { return entry.source.starts_with(what); };
    const bool some = entry.source.find(" - ") != std::string::npos || is("diffusion") || is("signal");
    entry.sessions = some ? std::min(with_intervals, count) : count;
    entry.truth = truth_of(entry);
    finish(entry, intervals[i]);
    if (claims[i].second > 0) entry.claimed = proportion_of(claims[i].first, claims[i].second);
  }
  return recoveries;
}

/// The means over people of what is true of them.
class GroupTruths {
 public:
  explicit GroupTruths(const std::vector<SessionOutcome>& outcomes) {
    for (const auto& outcome : outcomes)
      for (const auto& truth : outcome.truths) {
        auto& [sum, people] = sums_[{truth.condition, truth.measure}];
        sum += truth.value, ++people;
      }
  }
  std::optional<double> of(const std::string& condition, const std::string& measure) const {
    const auto found = sums_.find({condition, measure});
    if (found == sums_.end()) return std::nullopt;
    return found->second.first / found->second.second;
  }

 private:
  std::map<std::pair<std::string, std::string>, std::pair<double, int>> sums_;
};

/// A difference that is 0 for everybody leaves rounding errors in a mean over people.
double exact_difference(double difference, double of) {
  return std::fabs(difference) < 1e-12 * std::fabs(of) ? 0 : difference;
}

/// The findings of the report of a study, and what is true of each.
std::vector<Finding> findings_of(const report::Study& study, const GroupTruths& truths,
                                 std::map<std::pair<std::string, std::string>, double>& known) {
  std::vector<Finding> findings;
  const auto add = [&](Finding finding, const std::optional<double>& truth) {
    if (truth) known[{finding.source, finding.parameter}] = *truth;
    findings.push_back(std::move(finding));
  };
  for (const auto& mean : study.means)
    if (mean.mean)
      add({source_of("mean", mean.condition), mean.measure, mean.unit, mean.mean->value, mean.mean->interval},
          truths.of(mean.condition, mean.measure));
  for (const auto& effect : study.effects) {
    if (!effect.difference) continue;
    const auto first = truths.of(effect.first, effect.measure),
               second = truths.of(effect.second, effect.measure);
    const auto& interval = effect.difference->interval;
    const bool claimed =
        effect.corrected_p ? *effect.corrected_p < 0.05 : interval.low > 0 || interval.high < 0;
    add({effect.second + " - " + effect.first, effect.measure, effect.unit, effect.difference->value,
         interval, claimed},
        first && second ? std::optional(exact_difference(*second - *first, *first)) : std::nullopt);
  }
  return findings;
}

std::vector<Recovery> recover_studies(const protocol::Protocol& protocol, const PowerOptions& options,
                                      const std::vector<SessionOutcome>& outcomes) {
  const GroupTruths truths(outcomes);
  std::map<std::pair<std::string, std::string>, double> known;
  std::vector<std::vector<Finding>> studies;
  const auto people = static_cast<std::size_t>(options.people);
  for (std::size_t first = 0; first + people <= outcomes.size(); first += people) {
    report::Study study;
    study.settings = outcomes.front().settings;
    study.groups_of_conditions = protocol::groups_of_conditions(protocol);
    for (std::size_t i = first; i < first + people; ++i) {
      auto& person = study.persons.emplace_back(*outcomes[i].person);
      person.person = std::to_string(i);
      for (auto& measure : person.measures) measure.person = person.person;
    }
    report::finish_study(study);
    studies.push_back(findings_of(study, truths, known));
  }
  return recover(studies, static_cast<int>(studies.size()),
                 [&known](const Recovery& entry) -> std::optional<double> {
                   const auto found = known.find({entry.source, entry.parameter});
                   return found == known.end() ? std::nullopt : std::optional(found->second);
                 });
}

std::vector<Recovery> recover_sessions(const protocol::Protocol& protocol, const PowerOptions& options,
                                       const std::vector<SessionOutcome>& outcomes) {
  const Truths truths(protocol, options, outcomes);
  std::vector<std::vector<Finding>> sessions;
  for (const auto& outcome : outcomes) sessions.push_back(outcome.findings);
  return recover(sessions, options.interval_sessions,
                 [&truths](const Recovery& entry) { return truths.find(entry); });
}

}  // namespace

Measures true_measures(const SessionOutcome& outcome, const simulation::Observer& observer,
                       const report::SessionData& settings) {
  Measures truths;
  auto conditions = settings.conditions;
  if (conditions.empty()) conditions.emplace_back();
  const auto& generating = outcome.generating;
  const auto add = [&](const std::string& condition, const char* measure,
                       const std::optional<double>& value) {
    if (value) truths.push_back({"", condition, measure, "", *value});
  };
  for (const auto& condition : conditions) {
    if (const auto model = report::scale_model(settings.design, settings.function))
      for (const auto& [measure, value] : generating.scale(condition, *model, settings.level_unit))
        add(condition, measure.c_str(), value);
    add(condition, analysis::kCorrect, generating.share_correct(condition));
    add(condition, analysis::kBoundary, generating.boundary(condition, observer));
    add(condition, analysis::kDrift, generating.drift(condition));
    if (observer.parameters().residual_range_s == 0)
      add(condition, analysis::kNondecision, observer.nondecision_s());
    if (const auto curve = generating.curve(condition)) {
      add(condition, kAsymptote, (*curve)[0]);
      add(condition, kRate, (*curve)[1]);
      add(condition, kIntercept, (*curve)[2]);
    }
  }
  if (!settings.parts.empty()) return truths;  // thresholds of several factors have other names
  for (const auto& [condition, options] : outcome.fits) {
    const auto truth = generating.fit(condition, options, observer);
    add(condition, options.guess == analysis::Guess::tied_to_lapse ? "PSE" : "threshold", truth.threshold);
    add(condition, spread_name(options), truth.slope);
  }
  return truths;
}

int sessions_of(const Part& part, int observers) { return (observers - part.number) / part.of + 1; }

Power power_of(const protocol::Protocol& whole, const PowerOptions& asked,
               const std::vector<SessionOutcome>& outcomes) {
  auto options = asked;
  const auto& protocol = protocol::of_task(whole, options.task);
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
  int checked = 0, misfits = 0, compared = 0, separated = 0;
  for (const auto& outcome : outcomes) {
    if (outcome.model_p) ++checked, misfits += *outcome.model_p < 0.05;
    if (outcome.separated) ++compared, separated += *outcome.separated;
  }
  if (checked > 0) power.misfits = proportion_of(misfits, checked);
  if (compared > 0) power.separated = proportion_of(separated, compared);
  power.people = options.people;
  power.recoveries = options.people > 0 ? recover_studies(report::by_group(protocol), options, outcomes)
                                        : recover_sessions(protocol, options, outcomes);
  return power;
}

Power power(const protocol::Protocol& protocol, const PowerOptions& options) {
  return power_of(protocol, options, simulate_sessions(protocol, options));
}

}  // namespace turnpoint::rehearsal
