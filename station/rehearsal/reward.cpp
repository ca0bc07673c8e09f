#include "station/rehearsal/reward.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "station/core/records.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/answers.hpp"
#include "station/rehearsal/parallel.hpp"
#include "station/rehearsal/power_session.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/trial/question.hpp"

namespace turnpoint::rehearsal {

namespace {

/// Cautions that are tried: 16 from kLeastCaution to kMostCaution, each 1.28 times the one before.
constexpr int kTried = 16;
double caution_at(double place) {
  return kLeastCaution * std::pow(kMostCaution / kLeastCaution, place / (kTried - 1));
}
/// So many trials are simulated for each caution, in whole sessions. A rate is then known to about 0.5 %.
constexpr int kTrialsTried = 30'000, kMostPeople = 400;
/// The best caution is the vertex of the parabola through so many neighbours on each side of the best one: up
/// to 2.1 times more and less cautious.
constexpr int kNeighbours = 3;

/// Sums over the trials of a block.
struct Earned {
  double points = 0, duration_s = 0, response_time_s = 0;
  int valued = 0, judged = 0, right = 0, answered = 0;

  void add(const core::TrialRow& row) {
    duration_s += row.timing.duration_s;
    if (row.given.points) points += *row.given.points, ++valued;
    if (row.given.correct) ++judged, right += *row.given.correct ? 1 : 0;
    if (row.timing.response_time_s) response_time_s += *row.timing.response_time_s, ++answered;
  }
  void add(const Earned& more) {
    points += more.points, duration_s += more.duration_s, response_time_s += more.response_time_s;
    valued += more.valued, judged += more.judged, right += more.right, answered += more.answered;
  }
  /// points per minute; lowest if the block was never reached
  double rate() const {
    return duration_s > 0 ? 60 * points / duration_s : -std::numeric_limits<double>::infinity();
  }
  Trade trade() const {
    return {rate(), judged > 0 ? static_cast<double>(right) / judged : 0,
            answered > 0 ? response_time_s / answered : 0};
  }
};
using ByBlock = std::map<std::string, Earned>;

/// The caution in a block; empty for the observer's own boundaries.
using CautionOf = std::function<std::optional<double>(const std::string& block)>;

/// What all planned sessions of one participant earn, by block.
ByBlock earned_in(const protocol::Protocol& protocol, const PowerOptions& options, int participant,
                  const CautionOf& caution_of) {
  const simulation::Observer observer(options.observer);
  std::map<int, std::vector<std::string>> labels;  // of the blocks, by the visit's number
  const auto answer = [&](const protocol::Visit& visit, const trial::TrialSpec& trial,
                          simulation::Question question) {
    auto [entry, is_new] = labels.try_emplace(visit.session);
    if (is_new) entry->second = block_labels(protocol, visit);
    question.caution = caution_of(entry->second.at(static_cast<std::size_t>(trial.block_index)));
    return observer.answer(question);
  };
  ByBlock earned;
  int number = 0;
  for (const auto& session : planned_sessions(protocol, options.seed, participant, observer, answer)) {
    ++number;
    for (const auto& block : session.blocks)
      if (!block.start.practice)
        for (const auto& row : block.trials)
          earned[labels[number].at(static_cast<std::size_t>(block.start.block_index))].add(row);
  }
  return earned;
}

/// The sum over so many participants.
ByBlock earned_by(const protocol::Protocol& protocol, const PowerOptions& options, int participants,
                  const CautionOf& caution_of) {
  ByBlock sum;
  for (int i = 0; i < participants; ++i)
    for (const auto& [block, earned] : earned_in(protocol, options, i, caution_of)) sum[block].add(earned);
  return sum;
}

/// Where the parabola through rates[first] to rates[last] is highest, by least squares; the place of the
/// highest rate if it has no top.
double vertex_of(const std::vector<double>& rates, int first, int last) {
  // orthogonal polynomials of the place around the middle
  const double middle = 0.5 * (first + last), count = last - first + 1,
               mean_square = (count * count - 1) / 12;
  double slope = 0, curve = 0, of_slope = 0, of_curve = 0;
  for (int i = first; i <= last; ++i) {
    const double x = i - middle, square = x * x - mean_square, rate = rates[static_cast<std::size_t>(i)];
    slope += x * rate, of_slope += x * x;
    curve += square * rate, of_curve += square * square;
  }
  slope /= of_slope, curve /= of_curve;
  if (curve < 0) return middle - 0.5 * slope / curve;
  return static_cast<double>(std::max_element(rates.begin(), rates.end()) - rates.begin());
}

void require_possible(const protocol::Protocol& protocol) {
  if (!protocol.payoff)
    throw core::UsageError(protocol.path + ": --reward: the protocol gives no points; [payoff] does");
  if (!protocol.by_task.empty())
    throw core::UsageError(
        protocol.path + ": --reward: the protocol has several tasks, and a block can have only one boundary");
  trial::TrialSpec trial;
  trial.level = 0;
  if (!protocol.procedures.empty()) trial.procedure = protocol.procedures.front().name;
  if (protocol::judges(protocol.task) || protocol.task.kind == protocol::TaskKind::adjustment ||
      trial::question_of(trial, protocol, 0).decides == simulation::Decides::category)
    throw core::UsageError(protocol.path +
                           ": --reward: a simulated observer gives the answers of this task without decision "
                           "boundaries, so no boundary earns more than another");
}

}  // namespace

std::vector<BestReward> best_rewards(const protocol::Protocol& protocol, const PowerOptions& options) {
  require_possible(protocol);
  const CautionOf own_bound = [](const auto&) { return std::nullopt; };
  int trials = 0;
  for (const auto& [block, earned] : earned_in(protocol, options, 0, own_bound)) trials += earned.valued;
  if (trials == 0) throw core::UsageError(protocol.path + ": --reward: no trial gives points");
  const int people = std::clamp((kTrialsTried + trials - 1) / trials, 1, kMostPeople);
  std::vector<ByBlock> tried(kTried);
  in_parallel(
      kTried, options.threads, options.progress,
      [&](int i) {
        tried[static_cast<std::size_t>(i)] =
            earned_by(protocol, options, people, [i](const auto&) { return caution_at(i); });
      },
      options.stop);
  if (options.stop.stop_requested()) return {};
  std::vector<BestReward> rewards;
  for (const auto& [block, own] : earned_by(protocol, options, people, own_bound)) {
    if (own.valued == 0) continue;
    std::vector<double> rates;
    for (auto& blocks : tried) rates.push_back(blocks[block].rate());
    const auto best = static_cast<int>(std::max_element(rates.begin(), rates.end()) - rates.begin());
    BestReward& reward = rewards.emplace_back();
    reward.block = block, reward.own = own.trade();
    reward.at_end = best == 0 || best == kTried - 1;
    const int first = std::max(0, best - kNeighbours), last = std::min(kTried - 1, best + kNeighbours);
    const double place =
        reward.at_end ? best : std::clamp<double>(vertex_of(rates, first, last), first, last);
    reward.caution = caution_at(place);
  }
  const auto cautions = cautions_of(rewards);
  auto earned = earned_by(protocol, options, people, [&](const std::string& block) {
    const auto found = cautions.find(block);
    return found == cautions.end() ? std::nullopt : std::optional(found->second);
  });
  for (auto& reward : rewards) reward.best = earned[reward.block].trade();
  return rewards;
}

std::map<std::string, double> cautions_of(const std::vector<BestReward>& rewards) {
  std::map<std::string, double> cautions;
  for (const auto& reward : rewards) cautions[reward.block] = reward.caution;
  return cautions;
}

}  // namespace turnpoint::rehearsal
