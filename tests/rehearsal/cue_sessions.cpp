#include "tests/rehearsal/cue_sessions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace turnpoint::tests {

using trial::TrialSpec;

namespace {

constexpr std::size_t judged_sessions = 600, most_judged_sessions = 12'000, judged_trials = 25'000;
constexpr std::uint64_t judged_seed = 50'000, tried_seed = 90'000;
constexpr std::size_t compared_trials = 4000;  // two rules that answer so many trials alike count as one

double guess(const protocol::Protocol& protocol) {
  return 1.0 / static_cast<double>(protocol.task.choices.size());
}

/// Returns by how much the accuracy in these sessions exceeds that of guessing or, if `key` is given, of
/// always pressing this key.
OwnSessions gain_over(const std::vector<Count>& each, std::optional<std::size_t> key, double guess) {
  Count all;
  for (const auto& count : each) all.add(count);
  const auto more = [&](const Count& c) { return c.right - (key ? c.keys[*key] : guess * c.trials); };
  OwnSessions own{more(all) / all.trials, 0};
  double squares = 0;
  for (const auto& count : each) squares += std::pow(more(count) - own.gain * count.trials, 2);
  own.error = std::sqrt(squares) / all.trials;
  own.gain = std::max(own.gain, 0.0);
  return own;
}

/// The gain of an observer with a cue over guessing or over always pressing the same key, whichever is
/// better in its sessions.
OwnSessions gain_of(const std::vector<Count>& each, double guess) {
  Count all;
  for (const auto& count : each) all.add(count);
  const auto key =
      static_cast<std::size_t>(std::max_element(all.keys.begin(), all.keys.end()) - all.keys.begin());
  return all.keys[key] > guess * all.trials ? gain_over(each, key, guess) : gain_over(each, {}, guess);
}

std::vector<Count> judging_sessions(const protocol::Protocol& protocol, World& world,
                                    const Candidate& candidate) {
  std::vector<Count> each;
  double trials = 0;
  while (each.size() < judged_sessions || trials < judged_trials) {
    do_sessions(each, protocol, world, candidate, each.size() + 1, judged_seed);
    trials += each.back().trials;
  }
  return each;
}

}  // namespace

void Count::add(const Count& other) {
  trials += other.trials, right += other.right;
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] += other.keys[i];
}

void do_sessions(std::vector<Count>& each, const protocol::Protocol& protocol, World& world,
                 const Candidate& candidate, std::size_t count, std::uint64_t first_seed) {
  while (each.size() < count) {
    Count session;
    const auto seed = first_seed + each.size();
    std::minstd_rand random(static_cast<unsigned>(seed));
    run_session(protocol, seed, [&](const TrialSpec& trial) -> std::optional<int> {
      const auto answers =
          candidate.strategy(seen_numbers(world.look(trial), candidate.cue, candidate.feature));
      const int answer = answers.size() > 1 ? answers[random() % answers.size()] : answers.front();
      if (trial.type != core::TrialType::practice && trial.correct) {
        session.trials += 1, session.right += answer == *trial.correct ? 1 : 0;
        session.keys[static_cast<std::size_t>(*trial.correct)] += 1;
      }
      return answer;
    });
    each.push_back(session);
  }
}

OwnSessions judged_gain(const protocol::Protocol& protocol, World& world, const Candidate& candidate) {
  auto each = judging_sessions(protocol, world, candidate);
  const double more = std::pow(gain_of(each, guess(protocol)).error / 0.004, 2);
  const auto wanted = std::min(static_cast<std::size_t>(judged_sessions * more), most_judged_sessions);
  do_sessions(each, protocol, world, candidate, wanted, judged_seed);
  return gain_of(each, guess(protocol));
}

OwnSessions gain_of_keys(const protocol::Protocol& protocol, World& world) {
  OwnSessions best;
  for (int key = 0; key < static_cast<int>(protocol.task.choices.size()); ++key) {
    const Candidate press{0, 0, [key](const std::vector<double>&) { return std::vector<int>{key}; }};
    const auto own = gain_over(judging_sessions(protocol, world, press), {}, guess(protocol));
    if (own.gain > best.gain) best = own;
  }
  return best;
}

Tournament::Tournament(const protocol::Protocol& protocol, World& world, const std::vector<Seen>& seen)
    : protocol_(protocol), world_(world) {
  const std::size_t step = 1 + seen.size() / compared_trials;
  for (std::size_t i = 0; i < seen.size(); i += step) seen_.push_back(seen[i]);
}

/// Adds a candidate unless another gives the same answers. One that would be right in few trials, if both
/// answers were right equally often, is added only if `also_if_bad` is set.
void Tournament::enter(std::vector<Entrant>& field, Candidate candidate, bool also_if_bad) {
  std::vector<bool> answers;
  std::array<double, 2> right{}, all{};
  for (const auto& trial : seen_) {
    const auto given =
        candidate.strategy(seen_numbers(trial.intervals, candidate.cue, candidate.feature)).front();
    answers.push_back(given == 1);
    const auto key = static_cast<std::size_t>(trial.correct);
    all[key] += 1, right[key] += given == trial.correct ? 1 : 0;
  }
  if (!also_if_bad && right[0] / all[0] + right[1] / all[1] < 0.75) return;
  const auto& same = tried_.try_emplace(std::move(answers)).first->first;
  if (std::none_of(field.begin(), field.end(), [&](const Entrant& one) { return one.answers == &same; }))
    field.push_back({std::move(candidate), &same, 0});
}

void Tournament::enter_all(std::vector<Entrant>& field, std::size_t cue, int feature) {
  std::array<double, 2> all{};
  for (const auto& trial : seen_) all[static_cast<std::size_t>(trial.correct)] += 1;
  std::vector<double> values;
  std::vector<std::pair<double, double>> weighted;
  for (const auto& trial : seen_) {
    values.push_back(seen_number(trial.intervals.front(), cue, feature));
    weighted.emplace_back(values.back(), 1 / all[static_cast<std::size_t>(trial.correct)]);
  }
  const auto cuts = cuts_of(std::move(weighted), grain_of(cue, values), 22);
  for (std::size_t i = 0; i < cuts.size(); ++i)
    for (std::size_t j = i + 1; j < cuts.size(); ++j)
      for (const int inside : {0, 1})
        enter(field, {cue, feature, band(cuts[i], cuts[j], inside, false)}, false);
}

/// Keeps the entrants that do best in this many sessions.
void Tournament::play(std::vector<Entrant>& field, std::size_t sessions, std::size_t kept) {
  for (auto& one : field) {
    auto& each = tried_.at(*one.answers);
    do_sessions(each, protocol_, world_, one.candidate, sessions, tried_seed);
    one.gain = gain_of(each, guess(protocol_)).gain;
  }
  std::stable_sort(field.begin(), field.end(),
                   [](const Entrant& a, const Entrant& b) { return a.gain > b.gain; });
  if (field.size() > kept) field.resize(kept);
}

OwnSessions Tournament::best_gain(std::size_t cue, int features, const std::vector<Candidate>& others) {
  std::vector<Entrant> field;
  for (const auto& one : others) enter(field, one, true);
  for (int feature = 0; feature < features; ++feature) enter_all(field, cue, feature);
  play(field, 4, 256);
  play(field, 12, 48);
  play(field, 50, 12);
  play(field, 200, 4);
  play(field, 600, 1);
  const auto& winner = field.front();
  const auto [known, is_new] = judged_.try_emplace(*winner.answers);
  if (is_new) known->second = judged_gain(protocol_, world_, winner.candidate);
  return known->second;
}

}  // namespace turnpoint::tests
