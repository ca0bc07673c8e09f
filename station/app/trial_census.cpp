#include "station/app/trial_census.hpp"

#include <algorithm>

#include "station/app/parallel.hpp"
#include "station/observer/observer.hpp"
#include "station/protocol/sources.hpp"
#include "station/session/rows.hpp"

namespace turnpoint::app {

namespace {

constexpr int most_trials_of_a_block = 20'000, batch = 21, most_sessions = 630;

bool is_known_to(double standard_error, const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value, squares += value * value;
  return squares / n - sum / n * sum / n <= standard_error * standard_error * n;
}

void count_session(const protocol::Protocol& protocol, std::uint64_t seed, TrialCensus& census) {
  const observer::Observer participant{observer::Parameters{}};
  session::Director director(protocol, 0, seed);
  while (const auto* block = director.block()) {
    int trials = 0;
    while (const auto trial = director.next()) {
      census.add(*block, *trial);
      const auto reply = participant.answer(session::question_of(*trial, protocol, seed));
      const bool answered = reply.choice && reply.response_time_s <= trial->deadline_s;
      session::TrialEnd end;
      end.outcome = answered ? terms::Outcome::answered : terms::Outcome::timeout;
      if (answered) end.response = reply.choice;
      if (answered && trial->correct) end.correct = reply.choice == trial->correct;
      if (block->practice) end.correct = true;  // who does not pass practice never sees the other blocks
      director.record(end);
      if (++trials > most_trials_of_a_block) return;
    }
    director.finish_block();
  }
}

}  // namespace

TrialCensus::TrialCensus(const protocol::Protocol& protocol) : protocol_(&protocol) {
  const auto used = protocol::factors_used(protocol);
  for (const auto& factor : protocol.factors)
    if (used.count(factor.name)) relevant_.push_back(&factor);
}

// The director draws what neither the block, nor the level, nor the procedure's balance sets.
bool TrialCensus::is_drawn(const protocol::Factor& factor, const protocol::Block& block,
                           const session::TrialSpec& trial) const {
  if (factor.levels.empty() || block.fixed.count(factor.name)) return false;
  if (trial.type == terms::TrialType::catch_trial) return factor.name != block.catch_trials->factor;
  const auto* spec = protocol::find_procedure(*protocol_, trial.procedure);
  if (spec == nullptr) return factor.name != block.level;
  const auto& balance = spec->balance;
  return factor.name != spec->level &&
         std::find(balance.begin(), balance.end(), factor.name) == balance.end();
}

void TrialCensus::add(const protocol::Block& block, const session::TrialSpec& trial) {
  if (block.practice || trial.type == terms::TrialType::practice || trial.type == terms::TrialType::warmup)
    return;
  protocol::Factors known;
  for (const auto* factor : relevant_) {
    const auto found = trial.factors.find(factor->name);
    if (found != trial.factors.end() && !is_drawn(*factor, block, trial)) known.insert(*found);
  }
  counts_[std::move(known)] += 1;
  if (trial.correct) scored_ += 1, first_right_ += *trial.correct == 0 ? 1 : 0;
  if (const auto share = share_of_range(trial)) levels_ += *share;
  total_ += 1;
}

void TrialCensus::add(const TrialCensus& other) {
  for (const auto& [known, count] : other.counts_) counts_[known] += count;
  total_ += other.total_;
  first_shares_.insert(first_shares_.end(), other.first_shares_.begin(), other.first_shares_.end());
  mean_levels_.insert(mean_levels_.end(), other.mean_levels_.begin(), other.mean_levels_.end());
  if (other.scored_ > 0) first_shares_.push_back(other.first_right_ / other.scored_);
  if (other.total_ > 0) mean_levels_.push_back(other.levels_ / other.total_);
}

// Where the level follows the answers: how far up its range it lies.
std::optional<double> TrialCensus::share_of_range(const session::TrialSpec& trial) const {
  const auto* spec = protocol::find_procedure(*protocol_, trial.procedure);
  if (!spec || spec->kind == procedure::Kind::constant_stimuli || !trial.level) return std::nullopt;
  for (const auto& factor : protocol_->factors)
    if (factor.name == spec->level && factor.range)
      return (*trial.level - factor.range->first) / (factor.range->second - factor.range->first);
  return std::nullopt;
}

bool TrialCensus::is_settled() const {
  return is_known_to(0.006, first_shares_) && is_known_to(0.008, mean_levels_);
}

void TrialCensus::settle(int sessions_added) {
  int sessions = sessions_added;
  while ((total_ == 0 && sessions <= sessions_added) ||
         (sessions < most_sessions && !first_shares_.empty() && !is_settled())) {
    std::vector<TrialCensus> more(batch, TrialCensus(*protocol_));
    in_parallel(batch, processors(), {}, [&](int i) {
      count_session(*protocol_, static_cast<std::uint64_t>(sessions + i), more[static_cast<std::size_t>(i)]);
    });
    for (const auto& census : more) add(census);
    sessions += batch;
  }
}

std::vector<TrialKind> TrialCensus::kinds() const {
  std::map<protocol::Factors, double> shares;
  for (const auto& [known, count] : counts_) {
    std::vector<TrialKind> product{{known, count / total_}};
    for (const auto* factor : relevant_) {
      if (known.count(factor->name)) continue;
      std::vector<TrialKind> next;
      for (const auto& kind : product)
        for (const auto& level : factor->levels) {
          next.push_back({kind.factors, kind.share / static_cast<double>(factor->levels.size())});
          next.back().factors[factor->name] = level;
        }
      product = std::move(next);
    }
    for (auto& kind : product) shares[std::move(kind.factors)] += kind.share;
  }
  std::vector<TrialKind> kinds;
  for (const auto& [factors, share] : shares) kinds.push_back({factors, share});
  return kinds;
}

TrialCensus census_of(const protocol::Protocol& protocol) {
  TrialCensus census(protocol);
  census.settle(0);
  return census;
}

}  // namespace turnpoint::app
