#include "station/session/scores.hpp"

#include <utility>

#include "station/core/median.hpp"

namespace turnpoint::session {

std::optional<double> BlockScore::accuracy() const {
  return trials > 0 ? std::optional(static_cast<double>(right) / trials) : std::nullopt;
}

std::optional<double> BlockScore::median_time_s() const {
  if (times_s.empty()) return std::nullopt;
  return core::median(times_s);
}

void Scores::begin(const core::BlockStart& block) {
  const auto found = scores_.find(block.block_index);
  if (found != scores_.end() && found->second.attempt == block.attempt) return;
  // if a session starts again, so do the blocks after this one
  scores_.erase(scores_.lower_bound(block.block_index), scores_.end());
  auto& score = scores_[block.block_index];
  score.block = block.name, score.practice = block.practice, score.attempt = block.attempt;
}

void Scores::add(const core::BlockStart& block, const core::TrialRow& trial) {
  const bool missed = trial.outcome == core::Outcome::timeout || trial.outcome == core::Outcome::anticipation;
  const bool judged = trial.correct_response && (missed || trial.outcome == core::Outcome::answered);
  if (trial.type == core::TrialType::warmup || (!judged && !trial.given.points)) return;
  auto& score = scores_.at(block.block_index);
  score.points += trial.given.points.value_or(0);
  if (!judged) return;
  ++score.trials;
  score.right += trial.given.correct.value_or(false) ? 1 : 0;
  if (trial.timing.response_time_s) score.times_s.push_back(*trial.timing.response_time_s);
}

void Scores::add(const std::vector<core::BlockRecord>& blocks) {
  for (const auto& block : blocks) {
    begin(block.start);
    for (const auto& trial : block.trials) add(block.start, trial);
  }
}

BlockScore Scores::of(int block_index) const {
  const auto found = scores_.find(block_index);
  return found == scores_.end() ? BlockScore{} : found->second;
}

std::map<std::string, double> Scores::accuracies() const {
  std::map<std::string, std::pair<int, int>> sums;
  for (const auto& [index, score] : scores_) {
    auto& [right, trials] = sums[score.block];
    right += score.right, trials += score.trials;
  }
  std::map<std::string, double> all;
  for (const auto& [block, sum] : sums)
    if (sum.second > 0) all[block] = static_cast<double>(sum.first) / sum.second;
  return all;
}

double Scores::points() const {
  double sum = 0;
  for (const auto& [index, score] : scores_) sum += score.practice ? 0 : score.points;
  return sum;
}

}  // namespace turnpoint::session
