#include <algorithm>

#include "station/text/number.hpp"
#include "station/trial/director_state.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::trial {

namespace {

/// Draws of a trial's factors that are tried before a run becomes too long.
constexpr int kMostRedraws = 64;

}  // namespace

/// A limit holds in the whole block, whichever of its procedures has it; of several, the smallest.
void Director::State::set_limits_of_runs() {
  for (const auto* spec : specs)
    for (const auto& [key, limit] : spec->max_run) {
      auto& run = runs[key];
      run.limit = run.limit == 0 ? limit : std::min(run.limit, limit);
    }
}

/// Returns "" for a trial that has no such value; it ends a run.
std::string Director::State::value_of(const std::string& key, const TrialSpec& spec) const {
  if (key == procedure::kRightAnswer) return spec.correct ? std::to_string(*spec.correct) : "";
  const auto found = spec.factors.find(key);
  if (found == spec.factors.end()) return "";
  const auto* number = std::get_if<double>(&found->second);
  return number ? text::exact(*number) : std::get<std::string>(found->second);
}

bool Director::State::fits(const TrialSpec& spec) const {
  return std::ranges::all_of(runs, [&](const auto& rule) {
    const auto& [key, run] = rule;
    return run.length < run.limit || run.value.empty() || value_of(key, spec) != run.value;
  });
}

/// True if the rest of the list of the procedure with this index can still be presented without too long
/// runs, if `spec` comes next: no value may be left more often than the others can separate.
bool Director::State::leaves_order(const TrialSpec& spec, int index) const {
  const auto& list = *procedures[static_cast<std::size_t>(index)];
  const auto& from = *specs[static_cast<std::size_t>(index)];
  for (const auto& [key, run] : runs) {
    // The right answer follows from the list only if it does not follow from the order of intervals.
    if (key == procedure::kRightAnswer && orders_of(protocol.task).size() > 1) continue;
    std::map<std::string, int> left;
    for (std::size_t place = 0; place < list.choices(); ++place) {
      auto other = spec;
      const auto proposal = list.choice(place);
      other.factors[from.level] = proposal.level;
      for (const auto& [name, level] : proposal.balanced)
        for (const auto& factor : protocol.factors)
          if (factor.name == name) other.factors[name] = factor.levels.at(level);
      if (key == procedure::kRightAnswer) other.correct = correct_choice(protocol.task, other.factors);
      ++left[value_of(key, other)];
    }
    const auto now_value = value_of(key, spec);
    const int length = now_value == run.value ? run.length + 1 : 1;
    if (--left[now_value]; left[now_value] < 0) left[now_value] = 0;
    int all = 0;
    for (const auto& [value, count] : left) all += count;
    for (const auto& [value, count] : left) {
      const int begun = value == now_value ? length : 0;
      if (!value.empty() && count > run.limit - begun + run.limit * (all - count)) return false;
    }
  }
  return true;
}

/// Returns this trial or, if it would make a run too long, another one that does not: with another item of a
/// shuffled list, another order of intervals, other draws of the factors, or of another procedure if they are
/// mixed at random. Orders of intervals and items of a list only change places, so that each still comes as
/// often as before.
TrialSpec Director::State::with_short_runs(TrialSpec spec) {
  const bool warmup = spec.type == terms::TrialType::warmup;
  const int first = current_procedure;
  std::vector<int> others{first};
  if (first != no_procedure && now()->interleave == protocol::Interleave::random)
    for (int i = 0; i < static_cast<int>(procedures.size()); ++i)
      if (i != first && procedures[static_cast<std::size_t>(i)]->next()) others.push_back(i);
  const int orders = orders_of(protocol.task).size() > 1 && !warmup ? 2 * run_of_orders() : 1;
  const auto remake = [&] {
    if (current_procedure != no_procedure) return procedure_trial(current_procedure);
    if (warmup) return warmup_trial();
    return practice_levels.empty() ? catch_trial() : *practice_trial();
  };
  // First look for a trial that leaves an order without too long runs for the rest of the list, then for one
  // that only fits here.
  for (const bool far : {true, false})
    for (const int other : others) {
      current_procedure = other;
      auto* list = other == no_procedure ? nullptr : procedures[static_cast<std::size_t>(other)].get();
      const std::size_t items = list ? list->choices() : 1;
      for (std::size_t item = 0; item < items; ++item) {
        if (list) list->choose(item);
        for (int order = trial; order < trial - trial % run_of_orders() + orders || order == trial; ++order) {
          const auto before = swapped_orders;
          const auto key_of = [&](int of) {
            const auto found = before.find(of);
            return found == before.end() ? of : found->second;
          };
          swapped_orders[trial] = key_of(order), swapped_orders[order] = key_of(trial);
          for (redraws = 0; redraws < kMostRedraws; ++redraws) {
            auto candidate = remake();
            if (fits(candidate) && (!far || !list || leaves_order(candidate, other))) {
              redraws = 0;
              return candidate;
            }
          }
          swapped_orders = before;
          redraws = 0;
        }
        if (list) list->choose(item);  // puts it back
      }
    }
  current_procedure = first;
  return remake();
}

void Director::State::count_runs(const TrialSpec& spec) {
  if (spec.strokes) return;
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
