#include <algorithm>
#include <tuple>
#include <utility>

#include "station/core/number.hpp"
#include "station/trial/director_state.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::trial {

namespace {

/// Draws of a trial's factors that are tried before a run becomes too long.
constexpr int kMostRedraws = 16;

bool same(const IntervalOrder& a, const IntervalOrder& b) {
  return a.intervals == b.intervals && a.correct == b.correct;
}

}  // namespace

/// A limit holds in the whole block, whichever of its procedures has it; of several, the smallest.
void Director::State::set_limits_of_runs() {
  for (const auto* spec : specs)
    for (const auto& [key, limit] : spec->max_run) {
      auto& run = runs[key];
      run.limit = run.limit == 0 ? limit : std::min(run.limit, limit);
    }
}

/// Returns the trial whose order of intervals this trial presents.
int Director::State::order_key(int of_trial) const {
  const auto swapped = swapped_orders.find(of_trial);
  return swapped == swapped_orders.end() ? of_trial : swapped->second;
}

/// Returns "" for a trial that has no such value; it ends a run.
std::string Director::State::value_of(const std::string& key, const TrialSpec& spec) const {
  if (key == procedure::kRightAnswer) return spec.correct ? std::to_string(*spec.correct) : "";
  const auto found = spec.factors.find(key);
  if (found == spec.factors.end()) return "";
  const auto* number = std::get_if<double>(&found->second);
  return number ? core::exact(*number) : std::get<std::string>(found->second);
}

/// Returns how many runs would become too long.
int Director::State::too_long(const TrialSpec& spec) const {
  return static_cast<int>(std::ranges::count_if(runs, [&](const auto& rule) {
    const auto& [key, run] = rule;
    return run.length >= run.limit && !run.value.empty() && value_of(key, spec) == run.value;
  }));
}

/// True if trials with these values, which come this many times, can follow `spec` in some order, with runs
/// that are by `spare` shorter than allowed: no value may be left more often than the others can separate.
bool Director::State::can_follow(const std::map<std::string, int>& left, const std::string& key,
                                 const TrialSpec& spec, int spare) const {
  const auto& run = runs.at(key);
  const int limit = std::max(1, run.limit - spare);
  const auto now_value = value_of(key, spec);
  const int length = now_value == run.value ? run.length + 1 : 1;
  int all = 0;
  for (const auto& [value, count] : left) all += count;
  return std::ranges::all_of(left, [&](const auto& entry) {
    const auto& [value, count] = entry;
    const int begun = value == now_value ? length : 0;
    return value.empty() || count <= std::max(0, limit - begun) + limit * (all - count);
  });
}

/// True if the rest of the orders of intervals, and of the lists of the procedures that may come next, can
/// still be presented without too long runs if `spec` comes next.
bool Director::State::leaves_order(const TrialSpec& spec, int spare) {
  return std::ranges::all_of(runs, [&](const auto& rule) {
    const auto& key = rule.first;
    if (key != procedure::kRightAnswer || orders().size() == 1) return leaves_lists(spec, key, spare);
    std::map<std::string, int> left;
    const int end = trial - trial % run_of_orders() + run_of_orders();
    for (int other = trial; other < end && orders().front().correct; ++other)
      if (other != deviation.order_of.value_or(trial))
        ++left[std::to_string(*presented_order(order_key(other)).correct)];
    return can_follow(left, key, spec, spare);
  });
}

/// Counts the values in the lists of the procedures that may come next: those of their present repeats, and
/// all. Only procedures whose lists set the factor with this key count.
const Director::State::Left& Director::State::lists_left(const TrialSpec& spec, const std::string& key) {
  const bool mixed = now()->interleave != protocol::Interleave::none;
  const auto [found, is_new] = left_of_lists.try_emplace({mixed ? no_procedure : current_procedure, key});
  auto& [soon, all] = found->second;
  for (std::size_t i = 0; is_new && i < procedures.size(); ++i) {
    const auto& from = *specs[i];
    if (!mixed && current_procedure != no_procedure && static_cast<int>(i) != current_procedure) continue;
    if (!mixed && !all.empty()) break;
    if (!lists(from, key)) continue;
    TrialSpec other;
    other.factors = spec.factors;
    for (const auto& candidate : procedures[i]->candidates()) {
      set_proposal(candidate.proposal, from, other.factors);
      other.correct = correct_choice(seen_by(block_task).task, other.factors, orders().front().intervals);
      const auto value = value_of(key, other);
      all[value] += candidate.in_all;
      if (candidate.in_repeat > 0) soon[value] += candidate.in_repeat;
    }
  }
  return found->second;
}

bool Director::State::lists(const procedure::Spec& from, const std::string& key) {
  return key == procedure::kRightAnswer || key == from.level ||
         std::ranges::find(from.balance, key) != from.balance.end();
}

bool Director::State::leaves_lists(const TrialSpec& spec, const std::string& key, int spare) {
  auto [soon, all] = lists_left(spec, key);
  if (current_procedure != no_procedure && lists(*specs[static_cast<std::size_t>(current_procedure)], key)) {
    const auto value = value_of(key, spec);
    for (auto* counts : {&soon, &all})
      if (auto& count = (*counts)[value]; count > 0) --count;
  }
  return can_follow(all, key, spec, spare) &&
         (key != procedure::kRightAnswer || can_follow(soon, key, spec, spare));
}

/// True if other draws can give a trial of the current procedure, or a catch trial, factors with other runs.
bool Director::State::draws_factors(const TrialSpec& spec) const {
  if (current_procedure == no_procedure) return true;
  const bool decides = runs.count(procedure::kRightAnswer) && !orders().front().correct;
  const auto& from = *specs[static_cast<std::size_t>(current_procedure)];
  const auto sets = [&](const std::string& name) {
    return name == from.level || (from.second && name == from.second->level) ||
           std::ranges::find(from.against, name) != from.against.end() || from.with.count(name) ||
           now()->fixed.count(name) || std::ranges::find(from.balance, name) != from.balance.end();
  };
  return std::ranges::any_of(protocol.factors, [&](const auto& factor) {
    return (decides || runs.count(factor.name)) && !sets(factor.name) &&
           factor.draw != protocol::FactorDraw::without_repetition && spec.factors.count(factor.name);
  });
}

/// Returns this trial or, if it would make a run too long, another one that does not: with another item of a
/// shuffled list, another order of intervals or other draws of the factors, or of another procedure if they
/// are mixed at random. Orders of intervals and items of a list only change places, so that each still comes
/// as often as before. `deviation` then says how the trial was made; record() applies it.
std::optional<TrialSpec> Director::State::with_short_runs(const TrialSpec& first) {
  const int first_procedure = current_procedure;
  const auto remake = [&] {
    return current_procedure == no_procedure ? catch_trial() : procedure_trial(current_procedure);
  };
  std::vector<int> others{first_procedure};
  const auto interleave = now()->interleave;
  if (first_procedure != no_procedure && interleave == protocol::Interleave::random)
    for (int i = 0; i < static_cast<int>(procedures.size()); ++i)
      if (i != first_procedure && procedures[static_cast<std::size_t>(i)]->next()) others.push_back(i);
  if (first_procedure != no_procedure && interleave == protocol::Interleave::passes)
    for (const int i : pass)
      if (i != first_procedure) others.push_back(i);
  // the first trials of this run of orders, or of the next one, that have different orders
  std::vector<int> places{trial};
  if (orders().size() > 1)
    for (int other = trial + 1; other < trial - trial % run_of_orders() + 2 * run_of_orders(); ++other) {
      const auto& its = presented_order(order_key(other));
      if (std::ranges::none_of(places, [&](int of) { return same(presented_order(order_key(of)), its); }))
        places.push_back(other);
    }
  const int draws = draws_factors(first) ? kMostRedraws : 1;
  int fewest = static_cast<int>(runs.size()) + 1;
  TrialSpec best;
  std::pair<int, Deviation> best_way;
  // First look for a trial after which runs that are shorter than allowed by one could still be kept, because
  // some trials may come again; then for one after which the allowed runs can be kept, and then for one that
  // only fits here. A catch trial can be put off instead.
  for (const int spare : {1, 0, -1}) {
    if (spare < 0 && first_procedure == no_procedure) return std::nullopt;
    if (spare < 0 && fewest > 0) break;
    const auto good = [&](const TrialSpec& candidate) {
      const int found = too_long(candidate);
      if (found < fewest) fewest = found, best = candidate, best_way = {current_procedure, deviation};
      return found == 0 && (spare < 0 || leaves_order(candidate, spare));
    };
    current_procedure = first_procedure, deviation = {};
    if (good(first)) return first;
    for (const int other : others) {
      current_procedure = other;
      std::vector<procedure::Candidate> items{{}};
      if (other != no_procedure) items = procedures[static_cast<std::size_t>(other)]->candidates();
      for (int redraws = 0; redraws < draws; ++redraws)
        for (const auto& item : items)
          for (const int order : places) {
            deviation = {item.place, order, redraws};
            auto candidate = remake();
            if (good(candidate)) return candidate;
          }
    }
  }
  std::tie(current_procedure, deviation) = best_way;
  return best;
}

/// Carries out what made the current trial different, once it has been presented.
void Director::State::apply_deviation() {
  if (current_procedure != no_procedure)
    procedures[static_cast<std::size_t>(current_procedure)]->choose(deviation.place);
  if (const auto other = deviation.order_of; other && *other != trial) {
    const int mine = order_key(trial), its = order_key(*other);
    swapped_orders[trial] = its, swapped_orders[*other] = mine;
  }
  catches_owed += deviation.catches;
  deviation = {};
}

void Director::State::count_runs(const TrialSpec& spec) {
  if (spec.strokes || spec.type == core::TrialType::warmup) return;
  for (auto& [key, run] : runs) {
    const auto value = value_of(key, spec);
    run.length = value == run.value ? run.length + 1 : 1;
    run.value = value;
    if (run.length <= run.limit || value.empty()) continue;
    auto& longest = long_runs[key];
    longest.limit = longest.limit == 0 ? run.limit : std::min(longest.limit, run.limit);
    longest.longest = std::max(longest.longest, run.length);
  }
}

}  // namespace turnpoint::trial
