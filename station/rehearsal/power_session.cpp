#include "station/rehearsal/power_session.hpp"

#include <algorithm>
#include <stdexcept>

#include "station/analysis/trade.hpp"
#include "station/core/number.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/protocol/visits.hpp"
#include "station/rehearsal/parallel.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/report/stored_estimates.hpp"
#include "station/report/stored_trials.hpp"
#include "station/report/study.hpp"
#include "station/report/summary.hpp"
#include "station/trial/earlier_trials.hpp"
#include "station/trial/rows.hpp"

namespace turnpoint::rehearsal {

namespace {

std::optional<analysis::Interval> interval_of(const std::optional<analysis::ParameterInterval>& found) {
  return found ? std::optional(found->interval) : std::nullopt;
}

/// Adds the procedures' own threshold estimates; of the method of limits also those of each direction. Of a
/// procedure with a second dimension or a criterion, which no fit has, adds the estimates of all parameters.
void add_estimates(const Rehearsal& rehearsal, const protocol::Protocol& protocol, const std::string& session,
                   std::vector<Finding>& findings) {
  for (const auto& estimate : rehearsal.estimates) {
    const auto* spec = protocol::find_procedure(protocol, estimate.procedure);
    if (!spec || (!estimate.parameter.starts_with("threshold") && !has_parameters_of_its_own(*spec)))
      continue;
    std::optional<analysis::Interval> interval;
    if (estimate.interval) interval = {estimate.interval->first, estimate.interval->second, 0.95};
    findings.push_back({"procedure " + estimate.procedure + session, estimate.parameter,
                        report::unit_of(estimate.parameter, *spec), estimate.mean, interval});
  }
}

/// The seeds of one participant's sessions differ by multiples of this number. It is larger than any number
/// of observers, so sessions of different participants never have the same seed.
constexpr std::uint64_t kSeedStep = std::uint64_t{1} << 40U;

/// The blocks of all sessions of one participant, numbered as if they were one session.
std::vector<core::BlockRecord> joined(const std::vector<Rehearsal>& sessions) {
  std::vector<core::BlockRecord> blocks;
  int first_block = 0, first_trial = 0;
  for (const auto& session : sessions) {
    int last_block = first_block;
    for (auto block : session.blocks) {
      block.start.block_index += first_block;
      last_block = std::max(last_block, block.start.block_index);
      for (auto& row : block.trials) row.trial_index += first_trial;
      blocks.push_back(std::move(block));
    }
    first_block = last_block + 1, first_trial += session.trials;
  }
  return blocks;
}

std::string slope_unit(const analysis::FitOptions& options, const std::string& level_unit) {
  switch (options.function) {
    case core::Function::normal:
      return level_unit;
    case core::Function::logistic:
      return level_unit.empty() ? "" : "1/" + level_unit;
    case core::Function::weibull:
      break;
  }
  return "exponent";
}

void add_fits(const report::SessionData& data, const std::string& unit, SessionOutcome& outcome) {
  for (const auto& judged : report::judgements_of(data))
    if (judged.exponent)
      outcome.findings.push_back({source_of("numbers", judged.condition), "exponent", "",
                                  judged.exponent->value, judged.exponent->interval});
  for (const auto& scale : report::scales_of(data, 0)) {
    outcome.separated = outcome.separated.value_or(false) || (scale.fit && scale.fit->separated);
    if (!scale.fit) continue;
    const auto add = [&](const std::string& parameter, const char* of, const analysis::Estimate& found) {
      outcome.findings.push_back(
          {source_of("scale", scale.condition), parameter, of, found.value, found.interval});
    };
    for (const auto& [stimulus, place] : report::places_of(scale))
      add(report::place_name(stimulus, unit), report::scale_unit(scale.model), place);
    if (const auto& noise = scale.fit->noise) add(report::kScaleNoise, "", *noise);
    if (const auto& tendency = scale.fit->favours_second)
      add(report::kFavoursSecond, report::tendency_unit(scale.model), *tendency);
  }
  if (report::judges(data.design) || report::scales(data.design)) return;
  if (data.design == report::Design::adjustment) {
    for (const auto& settings : analysis::settings(data.trials, data.conditions))
      if (settings.mean)
        outcome.findings.push_back({source_of(source_of("settings", settings.procedure), settings.condition),
                                    "PSE", unit, settings.mean->value, settings.mean->interval});
    return;
  }
  if (data.design == report::Design::categories) {
    for (const auto& confusion :
         analysis::confusions(data.trials, data.conditions, static_cast<int>(data.choices.size())))
      if (confusion.right)
        outcome.findings.push_back({source_of("answers", confusion.condition), analysis::kCorrect, "",
                                    confusion.right->value, confusion.right->interval});
    return;
  }
  for (const auto& named : report::fits_of(data)) {
    outcome.fits.emplace_back(named.name, named.fit.options);
    if (!named.fit.parameters) continue;
    const auto& p = *named.fit.parameters;
    const auto source = source_of("fit", named.name);
    const auto& part = report::analysis_of(named, data);
    const auto& own = part.level_unit;
    const bool two_sided = part.design == report::Design::two_sided;
    auto& findings = outcome.findings;
    findings.push_back(
        {source, two_sided ? "PSE" : "threshold", own, p.threshold, interval_of(named.intervals.threshold)});
    const bool posterior = named.intervals.method == analysis::IntervalMethod::posterior;
    if (!posterior || report::slope_estimated(named))
      findings.push_back({source, spread_name(named.fit.options), slope_unit(named.fit.options, own), p.slope,
                          interval_of(named.intervals.slope)});
    const auto level_75 =
        posterior ? named.intervals.level_75
                  : analysis::level_at(named.fit.options.function, named.fit.options.scale, p, 0.75);
    if (level_75)
      findings.push_back({source, "75 % point", own, *level_75, interval_of(named.intervals.interval_75)});
  }
}

/// Adds the estimates of d' for each condition: over all trials and, if the levels are fixed, at each level.
void add_discriminations(const protocol::Protocol& protocol, const report::SessionData& data,
                         std::vector<Finding>& findings) {
  if (data.deciding.empty() || !report::shows(data, "dprime")) return;
  const bool fixed = std::none_of(protocol.procedures.begin(), protocol.procedures.end(),
                                  [](const auto& spec) { return procedure::follows_answers(spec); });
  for (const auto& entry :
       analysis::discriminate(data.trials, data.conditions, data.deciding, data.alternatives)) {
    if (entry.level && !fixed) continue;
    for (const auto& [model, estimate] : entry.d_primes)
      findings.push_back({source_of("answers", entry.condition),
                          d_prime_name(model, entry.level, data.level_unit), "SD", estimate.value,
                          estimate.interval});
  }
}

bool excludes(const analysis::Interval& interval, double value) {
  return interval.low > value || interval.high < value;
}

/// What the report shows of speed and accuracy, with its intervals.
void add_trade(const report::SessionData& data, SessionOutcome& outcome) {
  const auto trade = report::trade_of(data, report::trade_options(data));
  outcome.model_p = trade.model_p;
  auto& findings = outcome.findings;
  for (const auto& entry : trade.instructions) {
    const auto add = [&](const char* parameter, const char* unit, const auto& found) {
      if (found)
        findings.push_back(
            {source_of("diffusion", entry.instruction), parameter, unit, found->value, found->interval});
    };
    add(analysis::kBoundary, "s = 0.1", entry.boundary);
    add(analysis::kNondecision, "s", entry.nondecision_s);
    add(analysis::kDrift, "s = 0.1", entry.drift);
  }
  for (const auto& difference : trade.differences) {
    if (!difference.estimate) continue;
    const auto& interval = difference.estimate->interval;
    findings.push_back({difference.second + " - " + difference.first, difference.measure, difference.unit,
                        difference.estimate->value, interval,
                        difference.corrected_p ? *difference.corrected_p < 0.05 : excludes(interval, 0)});
  }
}

/// The curves at a response signal and their differences. A difference is claimed if its nested model is
/// rejected.
void add_curves(const report::SessionData& data, std::vector<Finding>& findings) {
  const auto curves = report::curves_of(data);
  for (const auto& curve : curves) {
    const auto add = [&](const char* parameter, const char* unit, const auto& found) {
      if (found)
        findings.push_back(
            {source_of("signal", curve.condition), parameter, unit, found->value, found->interval});
    };
    add(kAsymptote, "SD", curve.asymptote);
    add(kRate, "1/s", curve.rate_per_s);
    add(kIntercept, "s", curve.intercept_s);
  }
  for (const auto& pair : report::curve_differences_of(data, curves)) {
    const auto add = [&](const char* parameter, const char* unit, const auto& found, std::size_t which) {
      const auto& p = pair.corrected_p[which] ? pair.corrected_p[which] : pair.p[which];
      if (found)
        findings.push_back({pair.second + " - " + pair.first, parameter, unit, found->value, found->interval,
                            p ? std::optional(*p < 0.05) : std::nullopt});
    };
    add(kAsymptote, "SD", pair.asymptote, 0);
    add(kRateRatio, "ratio", pair.rate_ratio, 1);
    add(kIntercept, "s", pair.intercept_s, 2);
  }
}

void require_possible(const protocol::Protocol& protocol, const PowerOptions& options) {
  if (options.observers < 1 || options.interval_sessions < 0 || options.replicates < 40 ||
      options.threads < 1)
    throw std::invalid_argument(
        "power: there must be at least 1 observer, 1 thread and 40 replicates, and the number of sessions "
        "with intervals must not be negative");
  if (options.people < 0 || (options.people > 0 && options.observers % options.people != 0))
    throw std::invalid_argument("power: the observers must make whole studies");
  if (options.part.number < 1 || options.part.number > options.part.of || options.part.of > options.observers)
    throw std::invalid_argument("power: each part must have at least one session");
  if (const auto& task = protocol::of_task(protocol, options.task).task;
      protocol::judges(task) && !(task.value && task.value->typed))
    throw core::UsageError(protocol.path +
                           ": ratings have no threshold, so there is nothing to estimate; simulate sessions "
                           "with `turnpoint run --observer sim` and analyse their export");
  // A study simulates thousands of sessions at once, and would have to start a program for each of their
  // blocks.
  std::vector<core::Problem> problems;
  for (const auto& spec : protocol.procedures)
    if (spec.kind == procedure::Kind::program)
      problems.push_back(
          {spec.program.place,
           core::plain("procedure \"" + spec.name +
                       "\" is a separate program, which a power study does not run"),
           core::plain("use a procedure of another kind for the study, or simulate sessions with "
                       "`turnpoint run --observer sim` and analyse their export")});
  if (!problems.empty()) throw core::BadInput(problems);
}

}  // namespace

std::string source_of(const std::string& what, const std::string& instruction) {
  return instruction.empty() ? what : what + " " + instruction;
}

std::string session_suffix(const protocol::Protocol& protocol, int number) {
  return protocol.sessions ? ", session " + std::to_string(number) : "";
}

std::string d_prime_name(analysis::Deciding model, const std::optional<double>& level,
                         const std::string& unit) {
  std::string name = std::string("d', ") + analysis::name(model);
  return level ? name + ", at " + core::number(*level, 4) + (unit.empty() ? "" : " ") + unit : name;
}

const char* spread_name(const analysis::FitOptions& options) {
  return options.function == core::Function::normal ? "spread" : "slope";
}

namespace {

/// The person who sits in this session.
simulation::Parameters person_in(const PowerOptions& options, int session) {
  if (options.people == 0) return options.observer;
  core::Draws draws({options.seed, core::Stream::observer, -1, 0, session});
  return simulation::draw_person(options.observer, options.between, draws);
}

/// Adds the participant's part of the report of a study.
void add_person(const protocol::Protocol& protocol, const report::SessionData& data,
                SessionOutcome& outcome) {
  outcome.person = report::study_person(data, protocol.exclusion.value_or(protocol::Exclusion{}), false);
  for (const auto& named : outcome.person->fits) outcome.fits.emplace_back(named.name, named.fit.options);
  if (report::scales(data.design))
    outcome.separated = std::ranges::any_of(outcome.person->scale_remarks, [](const auto& remark) {
      return remark.second.code == analysis::kSeparated;
    });
  outcome.person->fits.clear();  // a fit of all people together would take longer than all the rest
}

/// The cautions of the blocks of a session, in the participant's order; empty without any cautions.
std::vector<std::optional<double>> cautions_in(const protocol::Protocol& protocol,
                                               const PowerOptions& options, const protocol::Visit& visit) {
  std::vector<std::optional<double>> cautions;
  if (options.cautions.empty()) return cautions;
  for (const auto& label : block_labels(protocol, visit)) {
    const auto found = options.cautions.find(label);
    cautions.push_back(found == options.cautions.end() ? std::nullopt : std::optional(found->second));
  }
  return cautions;
}

}  // namespace

std::vector<std::string> block_labels(const protocol::Protocol& protocol, const protocol::Visit& visit) {
  std::vector<std::string> labels;
  procedure::StandIns programs;
  const trial::Director director(protocol, visit, 0, &programs);  // the seed does not change the blocks
  for (const auto& block : director.all_blocks()) {
    auto& label = labels.emplace_back(block.name);
    for (const auto& [factor, value] : block.fixed) label += ", " + protocol::level_in_words(factor, value);
  }
  return labels;
}

std::vector<Rehearsal> planned_sessions(const protocol::Protocol& protocol, std::uint64_t seed,
                                        int participant, const simulation::Observer& observer,
                                        const VisitAnswerer& answer) {
  std::vector<Rehearsal> sessions;
  procedure::EarlierTrials earlier;
  auto sits = rehearser(observer);
  for (int number = 1; number <= protocol::session_count(protocol); ++number) {
    const protocol::Visit visit{participant, number};
    sits.answer = [&](const trial::TrialSpec& trial, const simulation::Question& question) {
      return answer(visit, trial, question);
    };
    const auto own_seed =
        seed + static_cast<std::uint64_t>(participant) + static_cast<std::uint64_t>(number - 1) * kSeedStep;
    sessions.push_back(rehearse(protocol, visit, own_seed, sits, earlier));
    trial::add_earlier_trials(protocol, sessions.back().blocks, earlier);
  }
  return sessions;
}

SessionOutcome simulate_session(const protocol::Protocol& protocol, const PowerOptions& options,
                                int session) {
  const simulation::Observer observer(person_in(options, session));
  const auto& of_task = protocol::of_task(protocol, options.task);
  SessionOutcome outcome;
  std::map<int, std::vector<std::optional<double>>> cautions;  // by the visit's number
  const auto answer = [&](const protocol::Visit& visit, const trial::TrialSpec& trial,
                          simulation::Question question) {
    auto [entry, is_new] = cautions.try_emplace(visit.session);
    if (is_new) entry->second = cautions_in(protocol, options, visit);
    const auto block = static_cast<std::size_t>(trial.block_index);
    if (block < entry->second.size()) question.caution = entry->second[block];
    if (protocol.by_task.empty() || trial.task == options.task)
      outcome.generating.add(of_task, trial, question, observer);
    return observer.answer(question);
  };
  report::SessionData data;
  data.seed = options.seed + static_cast<std::uint64_t>(session);
  const auto sessions = planned_sessions(protocol, options.seed, session, observer, answer);
  auto blocks = joined(sessions);
  if (options.people > 0) report::add_other_trials(blocks, protocol, options.task, data);
  report::add_trials(report::of_task(std::move(blocks), protocol, options.task), of_task, data);
  const auto& unit = data.level_unit;
  for (const auto& one : sessions) outcome.presented += one.trials, outcome.duration_s += one.duration_s;
  outcome.design = data.design;
  for (const auto& trial : data.trials)
    if (trial.type == core::TrialType::experimental && trial.correct)
      ++outcome.scored, outcome.right += *trial.correct ? 1 : 0;
  if (options.people > 0) {
    data.replicates = options.replicates;
    add_person(protocol, data, outcome);
  } else {
    data.replicates = session < options.interval_sessions ? options.replicates : 0;
    for (std::size_t i = 0; i < sessions.size(); ++i)
      add_estimates(sessions[i], of_task, session_suffix(protocol, static_cast<int>(i) + 1),
                    outcome.findings);
    add_fits(data, unit, outcome);
    add_discriminations(of_task, data, outcome.findings);
    if (data.replicates > 0) {
      add_trade(data, outcome);
      add_curves(data, outcome.findings);
    }
  }
  if (options.people == 0) return outcome;
  data.trials = {}, data.other_trials = {}, data.finger = {};
  outcome.truths = true_measures(outcome, observer, data);
  if (session == 0) outcome.settings = std::move(data);
  return outcome;
}

std::vector<SessionOutcome> simulate_sessions(const protocol::Protocol& given, const PowerOptions& options) {
  require_possible(given, options);
  // the report of a study analyses groups of participants apart
  const auto protocol = options.people > 0 ? report::by_group(given) : given;
  const auto& [number, of] = options.part;
  const int count = sessions_of(options.part, options.observers);
  std::vector<SessionOutcome> outcomes(static_cast<std::size_t>(count));
  const int done = in_parallel(
      count, options.threads, options.progress,
      [&, number = number, of = of](int i) {
        outcomes[static_cast<std::size_t>(i)] = simulate_session(protocol, options, number - 1 + i * of);
      },
      options.stop);
  outcomes.resize(static_cast<std::size_t>(done));
  return outcomes;
}

void complete(const protocol::Protocol& given, const PowerOptions& options,
              std::vector<SessionOutcome>& outcomes) {
  const auto protocol = options.people > 0 ? report::by_group(given) : given;
  auto quick = options;
  quick.interval_sessions = 0;
  GeneratingValues known;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    if (i > 0 && known.has_all_of(outcomes[i].generating)) continue;
    const auto again = simulate_session(protocol, quick, static_cast<int>(i));
    outcomes[i].generating.take_questions(again.generating);
    if (i == 0)
      outcomes[i].fits = again.fits, outcomes[i].design = again.design, outcomes[i].settings = again.settings;
    known.add(again.generating);
  }
}

}  // namespace turnpoint::rehearsal
