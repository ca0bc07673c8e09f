#include "station/procedure/quest_plus.hpp"

#include <algorithm>

#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

namespace {

constexpr int kUnansweredInARow = 3;

}  // namespace

QuestPlus::QuestPlus(const Spec& spec)
    : spec_(spec), posterior_(spec), stimulus_(posterior_.best_stimulus()) {}

bool QuestPlus::done() const {
  const auto& stop = spec_.stop;
  const int trials = recorded_ + spent_;
  const bool by_trials = stop.trials && trials >= *stop.trials;
  if (by_trials && stop.rule == StopRule::any) return true;
  if (stop.min_trials && trials < *stop.min_trials) return false;
  const bool by_sd = stop.threshold_sd && posterior_.estimate(Posterior::threshold).sd <= *stop.threshold_sd;
  const bool by_entropy = stop.entropy_nats && posterior_.entropy_nats() <= *stop.entropy_nats;
  if (stop.rule == StopRule::any) return by_trials || by_sd || by_entropy;
  return (!stop.trials || by_trials) && (!stop.threshold_sd || by_sd) && (!stop.entropy_nats || by_entropy);
}

std::optional<Proposal> QuestPlus::next() const {
  if (done()) return std::nullopt;
  return Proposal{posterior_.stimuli()[stimulus_], {}};
}

void QuestPlus::record(Answer answer) {
  if (answer == Answer::none) {
    if (++unanswered_ > kUnansweredInARow) unanswered_ = 0, ++spent_;
    return;
  }
  unanswered_ = 0;
  ++recorded_;
  const bool one = answer == Answer::one;
  posterior_.update(stimulus_, one);
  history_.push_back(2 * stimulus_ + (one ? 1 : 0));
  stimulus_ = posterior_.best_stimulus();
}

int QuestPlus::expected() const { return std::max(spec_.stop.trials.value_or(60), recorded_ + spent_); }

std::map<std::string, Estimate> QuestPlus::estimates() const {
  std::map<std::string, Estimate> all;
  all["threshold"] = posterior_.estimate(Posterior::threshold);
  if (posterior_.varies(Posterior::slope)) all["slope"] = posterior_.estimate(Posterior::slope);
  if (posterior_.varies(Posterior::guess)) all["guess"] = posterior_.estimate(Posterior::guess);
  if (posterior_.varies(Posterior::lapse)) all["lapse"] = posterior_.estimate(Posterior::lapse);
  return all;
}

std::uint64_t QuestPlus::state_hash() const {
  StateHash hash;
  for (const auto word : history_) hash.add(word);
  hash.add(stimulus_);
  hash.add(static_cast<std::uint64_t>(unanswered_));
  return hash.value();
}

}  // namespace turnpoint::procedure
