#include "station/rehearsal/power_truth.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "physics/root.hpp"
#include "station/analysis/diffusion.hpp"
#include "station/analysis/proportion.hpp"
#include "station/analysis/response_signal.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/conditions.hpp"
#include "station/report/summary.hpp"
#include "station/trial/question.hpp"

namespace turnpoint::rehearsal {

namespace {

/// Returns the probability of the answer that the procedure tracks, or of the right answer if it tracks none,
/// as a function of the level. Empty if this probability depends on more than the level.
std::function<double(double)> share_of_ones(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                            const simulation::Observer& observer) {
  trial::TrialSpec trial;
  trial.procedure = spec.name;
  trial.level = 0;
  const auto& timing = protocol.timing;
  if (timing.signal || (timing.deadline_s && !timing.deadline_s->is_constant())) return {};
  if (timing.deadline_s) trial.deadline_s = timing.deadline_s->constant;
  auto question = trial::question_of(trial, protocol, 0);
  int choice = 0;
  if (question.decides == simulation::Decides::right_answer) {
    if (!spec.tracks.empty()) return {};
    question.correct = 0;
  } else {
    const auto& choices = protocol.task.choices;
    const auto tracked = std::find_if(choices.begin(), choices.end(),
                                      [&](const auto& entry) { return entry.id == spec.tracks; });
    if (tracked == choices.end()) return {};
    choice = static_cast<int>(tracked - choices.begin());
  }
  return [question, choice, &observer](double level) mutable {
    question.level = level;
    return observer.share(question, choice);
  };
}

/// Returns the level between `low` and `high` at which a monotone function crosses `value`; empty if it does
/// not cross.
std::optional<double> crossing(const std::function<double(double)>& share, double low, double high,
                               double value) {
  const bool rises = share(high) > share(low);
  const auto below = [&](double level) { return (share(level) < value) == rises; };
  if (!below(low) || below(high)) return std::nullopt;
  return physics::bisect({high, low}, [&](double level) { return !below(level); }).middle();
}

/// A range of levels that is wide enough, in any unit, to reach both asymptotes of the observer's
/// psychometric function.
struct Reach {
  double low = 0, high = 0;
};
Reach reach_of(const simulation::Question& question) {
  if (question.decibel) return {-400, 400};
  return {question.decides == simulation::Decides::side ? -1e6 : 0, 1e6};
}

/// Returns 0 for a level below 1e-9 of the threshold, because bisection leaves rounding errors in the last
/// digits.
std::optional<double> without_rounding(const std::optional<double>& level, double threshold) {
  return level && std::fabs(*level) < 1e-9 * std::fabs(threshold) ? 0 : level;
}

}  // namespace

std::optional<double> settled_level(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                    const simulation::Observer& observer) {
  const auto share = share_of_ones(protocol, spec, observer);
  if (!share) return std::nullopt;
  trial::TrialSpec trial;
  trial.procedure = spec.name;
  const auto question = trial::question_of(trial, protocol, 0);
  const auto [low, high] = reach_of(question);
  const double threshold = observer.parameters().threshold.value_or(question.default_threshold);
  const auto crosses = [&, low = low, high = high](double value) {
    return without_rounding(crossing(share, low, high, value), threshold);
  };
  const auto& kind = procedure::description(spec.kind);
  // The method of limits looks for the level at which both answers are equally likely. It does not converge
  // on that level, so its bias is a property of the design.
  const auto target = kind.choice == procedure::Choice::series
                          ? std::optional(0.5)
                          : kind.settles_at(spec, share(low), share(high));
  return target ? crosses(*target) : std::nullopt;
}

bool has_parameters_of_its_own(const procedure::Spec& spec) { return spec.second || spec.signal_detection; }

std::map<std::string, double> true_parameters(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                              const simulation::Observer& observer) {
  std::map<std::string, double> truth;
  const auto& p = observer.parameters();
  auto flat = p;
  flat.gradient = 0, flat.floor.reset();
  if (const auto level = settled_level(protocol, spec, simulation::Observer(flat)))
    truth["threshold"] = *level;
  if (!has_parameters_of_its_own(spec)) return truth;
  if (spec.second) truth["gradient"] = p.gradient;
  if (p.floor) {
    flat.threshold = p.floor;
    if (const auto level = settled_level(protocol, spec, simulation::Observer(flat))) truth["floor"] = *level;
  }
  trial::TrialSpec trial;
  trial.procedure = spec.name;
  auto question = trial::question_of(trial, protocol, 0);
  const auto& deadline = protocol.timing.deadline_s;
  if (!deadline || !deadline->is_constant()) return truth;
  question.deadline_s = deadline->constant;
  const bool own_function = observer.bound(question) == p.bound && p.drift_sd == 0 && p.start_range == 0;
  if (!own_function) return truth;
  const bool weibull = question.decides == simulation::Decides::right_answer &&
                       question.finding == simulation::Finding::weibull &&
                       spec.function == procedure::Function::weibull;
  const bool presence = spec.signal_detection && question.decides == simulation::Decides::presence;
  if (weibull || presence) truth["slope"] = p.slope, truth["lapse"] = p.lapse * (1 - 1.0 / question.answers);
  if (presence) truth["criterion"] = p.criterion;
  return truth;
}

namespace {

/// The drift towards the right answer, with s = 0.1; NaN if the diffusion that the report fits does not have
/// it: it varies, or more than the drift decides.
double drift_towards(const simulation::Question& question, int correct,
                     const simulation::Observer& observer) {
  using simulation::Decides;
  const auto& p = observer.parameters();
  if (question.answers != 2 || question.rating || question.decides == Decides::category ||
      question.finding != simulation::Finding::weibull || p.drift_sd > 0 || p.start_range > 0)
    return std::nan("");
  const double drift = analysis::kDiffusionScale * observer.drift(question);
  return question.decides == Decides::right_answer || correct == question.positive ? drift : -drift;
}

/// Enters the drift of one difficulty. Two different ones make NaN.
void put_drift(double difficulty, double drift, std::map<double, double>& drifts) {
  const auto [entry, is_new] = drifts.try_emplace(difficulty, drift);
  if (!is_new && !(std::fabs(entry->second - drift) < 1e-9)) entry->second = std::nan("");
}

analysis::Detecting detecting_of(const protocol::Meaning& meaning) {
  return meaning.design == protocol::Design::yes_no      ? analysis::Detecting::presence
         : meaning.design == protocol::Design::two_sided ? analysis::Detecting::sides
                                                         : analysis::Detecting::forced_choice;
}

/// The sums at a lag with one more trial.
GeneratingValues::Lag with_trial(GeneratingValues::Lag lag, const protocol::Meaning& meaning,
                                 const simulation::Question& question, int correct,
                                 const simulation::Observer& observer) {
  const int yes = detecting_of(meaning) == analysis::Detecting::forced_choice ? 1 : question.positive;
  const std::size_t with = correct == yes ? 1 : 0;
  lag.time_s += *question.signal_s + observer.latency_s(question);
  ++lag.trials[with];
  lag.yes[with] += observer.share(question, yes);
  return lag;
}

}  // namespace

void GeneratingValues::add(const protocol::Protocol& protocol, const trial::TrialSpec& trial,
                           const simulation::Question& question, const simulation::Observer& observer) {
  if (trial.type != core::TrialType::experimental || !trial.level) return;
  std::string instruction;
  if (const auto found = trial.factors.find("instruction"); found != trial.factors.end())
    if (const auto* text = std::get_if<std::string>(&found->second)) instruction = *text;
  const auto& meaning = protocol.meanings.at(protocol::meaning_of(protocol, trial.procedure, ""));
  const auto condition =
      protocol::condition_in(meaning, protocol::condition_of(protocol, trial.factors, instruction));
  auto [entry, is_new] = conditions_.try_emplace(condition);
  auto& made = entry->second;
  if (is_new)
    made.question = question, made.sum.deadline_s = question.deadline_s, made.sum.caution = question.caution;
  auto& sum = made.sum;
  sum.one_bound = sum.one_bound && !question.signal_s && sum.deadline_s == question.deadline_s &&
                  sum.caution == question.caution;
  if (!question.compared.empty())
    if (const auto* spec = protocol::find_procedure(protocol, trial.procedure)) {
      auto& [trials, second] = sum.comparisons[protocol::compared(*spec, trial.factors)];
      ++trials, second += observer.share(question, 1);
    }
  if (!trial.correct) return;
  ++sum.trials;
  sum.correct += observer.share(question, *trial.correct);
  if (question.signal_s) {
    made.detecting = detecting_of(meaning);
    if (question.answers != 2) return;
    auto& lag = sum.lags[*question.signal_s];
    lag = with_trial(lag, meaning, question, *trial.correct, observer);
    return;
  }
  const double drift = drift_towards(question, *trial.correct, observer);
  const double difficulty = protocol.analysis.difficulty
                                ? protocol::evaluate(*protocol.analysis.difficulty, trial.factors)
                                : std::fabs(*trial.level);
  put_drift(difficulty, drift, sum.drifts);
}

void GeneratingValues::add(const Sum& more, Sum& sum) {
  sum.one_bound =
      sum.one_bound && more.one_bound && sum.deadline_s == more.deadline_s && sum.caution == more.caution;
  sum.trials += more.trials, sum.correct += more.correct;
  // with levels that follow the answers, sessions have different difficulties, so no mean drift is true of
  // all
  const bool same = sum.drifts.size() == more.drifts.size() &&
                    std::equal(sum.drifts.begin(), sum.drifts.end(), more.drifts.begin(),
                               [](const auto& a, const auto& b) { return a.first == b.first; });
  for (const auto& [difficulty, drift] : more.drifts)
    put_drift(difficulty, same ? drift : std::nan(""), sum.drifts);
  for (const auto& [stimuli, answers] : more.comparisons)
    for (std::size_t i = 0; i < 2; ++i) sum.comparisons[stimuli][i] += answers[i];
  for (const auto& [lag_s, lag] : more.lags) {
    auto& all = sum.lags[lag_s];
    all.time_s += lag.time_s;
    for (std::size_t i = 0; i < 2; ++i) all.trials[i] += lag.trials[i], all.yes[i] += lag.yes[i];
  }
}

void GeneratingValues::add(const GeneratingValues& other) {
  for (const auto& [condition, more] : other.conditions_) {
    auto [entry, is_new] = conditions_.try_emplace(condition, more);
    if (!is_new) add(more.sum, entry->second.sum);
  }
}

std::map<std::string, GeneratingValues::Sum> GeneratingValues::sums() const {
  std::map<std::string, Sum> sums;
  for (const auto& [condition, made] : conditions_) sums[condition] = made.sum;
  return sums;
}

GeneratingValues GeneratingValues::of_sums(const std::map<std::string, Sum>& sums) {
  GeneratingValues values;
  for (const auto& [condition, sum] : sums) {
    auto& made = values.conditions_[condition];
    made.sum = sum, made.question.deadline_s = sum.deadline_s, made.question.caution = sum.caution;
  }
  return values;
}

void GeneratingValues::take_questions(const GeneratingValues& other) {
  for (auto& [condition, made] : conditions_)
    if (const auto found = other.conditions_.find(condition); found != other.conditions_.end())
      made.question = found->second.question, made.detecting = found->second.detecting;
}

bool GeneratingValues::has_all_of(const GeneratingValues& other) const {
  return std::all_of(other.conditions_.begin(), other.conditions_.end(),
                     [&](const auto& entry) { return conditions_.count(entry.first) > 0; });
}

const GeneratingValues::Condition* GeneratingValues::find(const std::string& condition) const {
  const auto found = conditions_.find(condition);
  if (found != conditions_.end()) return &found->second;
  return condition.empty() && conditions_.size() == 1 ? &conditions_.begin()->second : nullptr;
}

std::optional<double> GeneratingValues::share_correct(const std::string& condition) const {
  const auto* made = find(condition);
  if (!made || made->sum.trials == 0) return std::nullopt;
  return made->sum.correct / made->sum.trials;
}

std::optional<double> GeneratingValues::share_correct_at(const std::string& condition, double level,
                                                         const simulation::Observer& observer) const {
  const auto* made = find(condition);
  if (!made || !made->sum.one_bound || made->question.decides != simulation::Decides::right_answer)
    return std::nullopt;
  auto question = made->question;
  question.level = level, question.correct = 0;
  return observer.share(question, 0);
}

std::optional<double> GeneratingValues::boundary(const std::string& condition,
                                                 const simulation::Observer& observer) const {
  const auto* made = find(condition);
  if (!made || !made->sum.one_bound) return std::nullopt;
  return 2 * analysis::kDiffusionScale * observer.bound(made->question);
}

std::optional<double> GeneratingValues::drift(const std::string& condition) const {
  const auto* made = find(condition);
  if (!made || made->sum.drifts.empty()) return std::nullopt;
  double sum = 0;
  for (const auto& [difficulty, drift] : made->sum.drifts) sum += drift;
  if (std::isnan(sum)) return std::nullopt;
  return sum / static_cast<double>(made->sum.drifts.size());
}

std::optional<std::array<double, 3>> GeneratingValues::curve(const std::string& condition) const {
  const auto* made = find(condition);
  if (!made) return std::nullopt;
  std::vector<analysis::ExpectedLag> lags;
  for (const auto& [lag_s, lag] : made->sum.lags) {
    const auto& n = lag.trials;
    if (!(n[0] > 0 && n[1] > 0)) return std::nullopt;
    lags.push_back({lag.time_s / (n[0] + n[1]), n[1], lag.yes[1] / n[1], n[0], lag.yes[0] / n[0]});
  }
  return analysis::limiting_curve(lags, made->detecting);
}

std::map<std::string, double> GeneratingValues::scale(const std::string& condition,
                                                      analysis::ScaleModel model,
                                                      const std::string& level_unit) const {
  const auto* made = find(condition);
  if (!made) return {};
  std::set<double> all;
  for (const auto& [compared, answers] : made->sum.comparisons) all.insert(compared.begin(), compared.end());
  const std::vector<double> stimuli(all.begin(), all.end());
  std::vector<analysis::ExpectedComparisons> expected;
  for (const auto& [compared, answers] : made->sum.comparisons) {
    auto& one = expected.emplace_back();
    for (const double stimulus : compared)
      one.stimuli.push_back(static_cast<int>(std::ranges::lower_bound(stimuli, stimulus) - stimuli.begin()));
    one.trials = answers[0], one.second = answers[1];
  }
  const std::size_t ends = model == analysis::ScaleModel::differences ? 1 : 0;
  if (stimuli.size() < 2 + ends) return {};
  const auto scale = analysis::limiting_scale(expected, static_cast<int>(stimuli.size()), model);
  if (!scale) return {};
  std::map<std::string, double> truths;
  for (auto i = ends; i + ends < stimuli.size(); ++i)
    truths[report::place_name(stimuli[i], level_unit)] = scale->values[i];
  if (scale->noise) truths[report::kScaleNoise] = *scale->noise;
  // Without a tendency, the fit ends within rounding errors of 0, which would be printed.
  if (scale->favours_second) truths[report::kFavoursSecond] = std::round(1e9 * *scale->favours_second) / 1e9;
  return truths;
}

FitTruth GeneratingValues::fit(const std::string& condition, const analysis::FitOptions& options,
                               const simulation::Observer& observer) const {
  const auto* made = find(condition);
  if (!made || !made->sum.one_bound) return {};
  const auto& p = observer.parameters();
  auto question = made->question;
  question.absent = false, question.correct = 0;
  const auto decides = question.decides;
  const int choice = decides == simulation::Decides::right_answer ? 0 : question.positive;
  const auto share = [&](double level) {
    question.level = level;
    return observer.share(question, choice);
  };
  const auto [low, high] = reach_of(question);
  const double threshold = p.threshold.value_or(question.default_threshold);
  const auto crosses = [&, low = low, high = high](double value) {
    return without_rounding(crossing(share, low, high, value), threshold);
  };
  FitTruth truth;
  const double way = analysis::sigmoid(options.function, 0);
  truth.threshold = decides == simulation::Decides::side
                        ? question.cut + p.bias
                        : crosses(share(low) + way * (share(high) - share(low)));
  truth.level_75 = crosses(0.75);
  const bool own_function = observer.bound(question) == p.bound && p.drift_sd == 0 && p.start_range == 0;
  if (own_function && decides == simulation::Decides::right_answer &&
      question.finding == simulation::Finding::weibull && options.function == core::Function::weibull)
    truth.slope = p.slope;
  if (own_function && decides == simulation::Decides::side && p.slope == 1 &&
      options.function == core::Function::normal && options.scale == analysis::Scale::linear)
    truth.slope = std::fabs(threshold) / analysis::normal_quantile(0.75);
  return truth;
}

}  // namespace turnpoint::rehearsal
