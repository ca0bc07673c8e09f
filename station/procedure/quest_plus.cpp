#include "station/procedure/quest_plus.hpp"

#include <algorithm>
#include <cmath>

#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

QuestPlus::QuestPlus(const Spec& spec)
    : spec_(spec), posterior_(spec), stimulus_(chosen()), ended_(how_ended()) {}

std::size_t QuestPlus::chosen() const {
  if (spec_.kind == Kind::zest)
    return posterior_.nearest_stimulus(posterior_.mean(Posterior::threshold), spec_.scale);
  if (spec_.kind == Kind::best_pest)
    return posterior_.nearest_stimulus(posterior_.most_likely_threshold(), spec_.scale);
  return posterior_.best_stimulus();
}

bool QuestPlus::rules_met() const {
  const auto& stop = spec_.stop;
  const int trials = recorded_ + spent_;
  const bool by_trials = stop.trials && trials >= *stop.trials;
  if (by_trials && stop.rule == StopRule::any) return true;
  if (stop.min_trials && trials < *stop.min_trials) return false;
  const bool by_sd = stop.threshold_sd && posterior_.sd(Posterior::threshold) <= *stop.threshold_sd;
  const bool by_entropy = stop.entropy_nats && posterior_.entropy_nats() <= *stop.entropy_nats;
  const bool by_right =
      enough_right(stop, history_.size(), [this](std::size_t i) { return history_[i] % 2 == 1; });
  if (stop.rule == StopRule::any) return by_trials || by_sd || by_entropy || by_right;
  return (!stop.right || by_right) && (!stop.trials || by_trials) && (!stop.threshold_sd || by_sd) &&
         (!stop.entropy_nats || by_entropy);
}

Ended QuestPlus::how_ended() const {
  if (rules_met()) return Ended::rule;
  if (recorded_ + spent_ >= most_trials(spec_.stop)) return Ended::most;
  const bool counted = spec_.stop.trials && spec_.stop.rule == StopRule::any;
  return spent_ >= kSpentAtMost && !counted ? Ended::unanswered : Ended::no;
}

std::optional<Proposal> QuestPlus::next() const {
  if (ended_ != Ended::no) return std::nullopt;
  const auto& stimulus = posterior_.stimuli()[stimulus_];
  return Proposal{stimulus.level, spec_.second ? std::optional(stimulus.second) : std::nullopt, {}};
}

void QuestPlus::record(Answer answer) {
  if (answer == Answer::none) {
    if (++unanswered_ > kRepeatsInARow) unanswered_ = 0, ++spent_;
    ended_ = how_ended();
    return;
  }
  unanswered_ = 0;
  ++recorded_;
  const bool one = answer == Answer::one;
  posterior_.update(stimulus_, one);
  history_.push_back(2 * stimulus_ + (one ? 1 : 0));
  stimulus_ = chosen();
  ended_ = how_ended();
}

int QuestPlus::expected() const { return std::max(spec_.stop.trials.value_or(60), recorded_ + spent_); }

std::map<std::string, Estimate> QuestPlus::estimates() const {
  std::map<std::string, Estimate> all;
  for (std::size_t k = 0; k < kParameters.size(); ++k)
    if (const auto parameter = static_cast<Posterior::Parameter>(k);
        parameter == Posterior::threshold || posterior_.varies(parameter))
      all[kParameters[k].name] = posterior_.estimate(parameter);
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
