#include "station/procedure/constant_stimuli.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

using Levels = std::vector<std::vector<std::size_t>>;

/// Largest number of combinations of levels. Larger numbers are reduced to it, to avoid overflow; no design
/// needs so many repeats of a value.
constexpr std::size_t kMost = 1'000'000;

/// Returns the number of combinations of these factors' levels, at most kMost.
std::size_t crossed(const Levels& factors) {
  std::size_t cells = 1;
  for (const auto& levels : factors) cells = std::min(cells * levels.size(), kMost);
  return cells;
}

/// Returns the level of each balanced factor for the repeat with this number (from 0) of a value. After any
/// number of repeats, the counts of any two combinations differ by at most one, and so do the counts of any
/// two levels of a factor. Every factor advances by one level with each repeat. Before a factor and the
/// factors before it would go through the same combinations again, that factor advances by one more level.
std::vector<std::size_t> combination(const Levels& factors, std::size_t repeat) {
  std::vector<std::size_t> result;
  std::size_t before = 1;
  for (const auto& levels : factors) {
    const auto cells = std::min(before * levels.size(), kMost), at = repeat % cells;
    result.push_back(levels[(at + at / std::lcm(before, levels.size())) % levels.size()]);
    before = cells;
  }
  return result;
}

}  // namespace

/// Whether an order is found depends on the draws. A protocol is checked with the list that these give, which
/// a session therefore takes if its own draws give none.
constexpr core::DrawKey kSureOrder{0, core::Stream::level_order, 0, 0, 0};

ConstantStimuli::ConstantStimuli(const Spec& spec, const Context& context, const core::DrawKey& key)
    : spec_(spec), context_(context), key_(key) {
  core::Draws draws({key.seed, core::Stream::level_order, key.block, key.attempt, 0});
  queue_ = items(spec_, context_, draws);
  if (spec_.rules.empty())
    shuffle(queue_, draws);
  else if (!order_by_rules(spec_, queue_, draws).problem.empty())
    queue_ = sure_order(spec_, context_);
  for (const auto& item : queue_) ++left_[kind_of(item)];
  total_ = static_cast<int>(queue_.size());
}

std::vector<ConstantStimuli::Item> ConstantStimuli::sure_order(const Spec& spec, const Context& context) {
  core::Draws draws(kSureOrder);
  auto list = items(spec, context, draws);
  if (auto found = order_by_rules(spec, list, draws); !found.problem.empty()) throw NoOrder(std::move(found));
  return list;
}

std::vector<ConstantStimuli::Item> ConstantStimuli::items(const Spec& spec, const Context& context,
                                                          core::Draws& draws) {
  const auto repeats = static_cast<std::size_t>(spec.repeats);
  std::vector<Item> all(repeats * spec.values.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i].value = i % spec.values.size(), all[i].repeat = i / spec.values.size();
  Levels shuffled;
  for (const auto& factor : spec.balance) shuffled.emplace_back(context.factor_levels.at(factor));
  const auto cells = crossed(shuffled);
  for (std::size_t value = 0; value < spec.values.size(); ++value)
    for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
      if (repeat % cells == 0)
        for (auto& levels : shuffled) {
          std::iota(levels.begin(), levels.end(), 0);
          draws.shuffle(levels);
        }
      all[repeat * spec.values.size() + value].balance = combination(shuffled, repeat);
    }
  return all;
}

ListOrder ConstantStimuli::order_by_rules(const Spec& spec, std::vector<Item>& items, core::Draws& draws) {
  std::vector<OrderedItem> list;
  for (const auto& item : items) {
    const auto first = std::ranges::find(spec.values, spec.values[item.value]) - spec.values.begin();
    list.push_back(
        {{static_cast<std::size_t>(first)}, spec.shuffle == Shuffle::within_repeat ? item.repeat : 0});
    list.back().values.insert(list.back().values.end(), item.balance.begin(), item.balance.end());
  }
  auto found = in_order(list, spec.rules, draws);
  std::vector<Item> ordered;
  for (const auto at : found.items) ordered.push_back(items[at]);
  items = std::move(ordered);
  return found;
}

void ConstantStimuli::shuffle(std::vector<Item>& items, core::Draws& draws) const {
  if (spec_.shuffle == Shuffle::none) return;
  const auto n = spec_.shuffle == Shuffle::within_repeat ? spec_.values.size() : items.size();
  for (std::size_t first = 0; first < items.size(); first += n) {
    std::vector<Item> part(items.begin() + static_cast<std::ptrdiff_t>(first),
                           items.begin() + static_cast<std::ptrdiff_t>(first + n));
    draws.shuffle(part);
    std::copy(part.begin(), part.end(), items.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

bool ConstantStimuli::in_repeat(std::size_t at) const {
  return spec_.shuffle == Shuffle::within_block || queue_[at].repeat == queue_[position_].repeat;
}

std::vector<Candidate> ConstantStimuli::candidates() const {
  if (!next()) return {};
  if (spec_.shuffle == Shuffle::none || !spec_.rules.empty()) return {{choice(0)}};
  // This is called for each trial, and a list may be long: the search ends once all kinds of items are known.
  std::vector<Candidate> all;
  std::map<Kind, std::size_t> known;
  const auto look = [&](std::size_t at) -> Candidate& {
    const auto [found, is_new] = known.try_emplace(kind_of(queue_[at]), all.size());
    if (is_new) all.push_back({choice(at - position_), at - position_, 0, left_.at(found->first)});
    return all[found->second];
  };
  const bool in_block = spec_.shuffle == Shuffle::within_block;
  std::vector<bool> soon(spec_.values.size());  // the values that the present repeat still has
  auto at = position_;
  for (; at < queue_.size() && in_repeat(at) && known.size() < (in_block ? left_.size() : queue_.size());
       ++at) {
    ++look(at).in_repeat;
    soon[queue_[at].value] = true;
  }
  if (in_block)
    for (auto& candidate : all) candidate.in_repeat = candidate.in_all;
  const auto kinds = static_cast<std::size_t>(
      std::ranges::count_if(left_, [&](const auto& left) { return soon[left.first.first]; }));
  for (; at < queue_.size() && known.size() < kinds; ++at)
    if (soon[queue_[at].value]) look(at);
  return all;
}

Proposal ConstantStimuli::choice(std::size_t place) const {
  const auto& item = queue_.at(position_ + place);
  Proposal proposal{spec_.values[item.value], {}};
  for (std::size_t i = 0; i < spec_.balance.size(); ++i)
    proposal.balanced.emplace_back(spec_.balance[i], item.balance[i]);
  return proposal;
}

void ConstantStimuli::choose(std::size_t place) {
  auto at = position_ + place;
  if (!in_repeat(at)) {
    const auto later = at;
    at = position_;
    while (queue_.at(at).value != queue_[later].value) ++at;
    std::swap(queue_[at].balance, queue_[later].balance);
  }
  std::swap(queue_.at(position_), queue_.at(at));
}

std::optional<Proposal> ConstantStimuli::next() const {
  if (position_ >= queue_.size()) return std::nullopt;
  if (enough_right(spec_.stop, answers_.size(), [this](std::size_t i) { return answers_[i]; }))
    return std::nullopt;
  return choice(0);
}

std::size_t place_of_repetition(const core::DrawKey& key, int repetitions, std::size_t left) {
  core::Draws draws({key.seed, core::Stream::level_order, key.block, key.attempt, 1 + repetitions});
  return left == 0 ? 0 : 1 + draws.below(left);
}

void ConstantStimuli::record(Answer answer) {
  if (answer == Answer::none && !context_.unanswered_are_data && !spec_.rules.empty()) {
    ++requeued_;
    return;
  }
  auto item = queue_[position_++];
  if (const auto left = left_.find(kind_of(item)); --left->second == 0) left_.erase(left);
  if (spec_.stop.right && answer != Answer::none) answers_.push_back(answer == Answer::one);
  if (answer != Answer::none || context_.unanswered_are_data) {
    ++recorded_;
    return;
  }
  const auto left = queue_.size() - position_;
  const auto offset = place_of_repetition(key_, requeued_++, left);
  if (left > 0) item.repeat = queue_[position_ + offset - 1].repeat;
  ++left_[kind_of(item)];
  queue_.insert(queue_.begin() + static_cast<std::ptrdiff_t>(position_ + offset), item);
}

std::uint64_t ConstantStimuli::state_hash() const {
  StateHash hash;
  hash.add(position_);
  hash.add(static_cast<std::uint64_t>(recorded_));
  for (const bool right : answers_) hash.add(right ? 1 : 0);
  for (std::size_t i = position_; i < queue_.size(); ++i) hash.add(queue_[i].value);
  return hash.value();
}

NoOrder::NoOrder(ListOrder order)
    : std::invalid_argument(core::say(order.problem, "en")), found(std::move(order)) {}

std::optional<Problem> order_problem(const Spec& spec, const Context& context) {
  try {
    ConstantStimuli::sure_order(spec, context);
  } catch (const NoOrder& none) {
    return Problem{"order", none.found.problem, none.found.allowed};
  }
  return std::nullopt;
}

extern const Description constant_stimuli{
    "constant-stimuli",
    Choice::listed,
    [] {
      using namespace core::key;
      core::Keys keys{numbers("values", any_level, "the levels").required()};
      keys.and_also(list_keys());
      return keys.and_also({table("stop", right_of_last_keys(), "when it ends before all trials")});
    },
    [](core::TableReader& reader, Spec& spec) {
      spec.values = reader.numbers("values");
      read_list(reader, spec);
      if (const auto* stop = reader.maybe_table("stop")) {
        core::TableReader inner(*stop, reader.path("stop"), reader.findings(), reader.keys("stop"));
        read_right_of_last(inner, spec);
        if (!inner.has("right") && !inner.has("of_last"))
          reader.problem("stop", phrase("\"stop\" does not contain a rule"),
                         plain("stop = { right = 8, of_last = 10 }"));
        inner.finish();
      }
    },
    [](const Spec& spec, std::vector<Problem>& problems) {
      if (spec.values.empty())
        problems.push_back({"values", plain("missing"), phrase("list one or more levels")});
      if (spec.repeats < 1)
        problems.push_back({"repeats", phrase("below 1"), phrase("write a whole number of 1 or more")});
    },
    [](const Spec& spec, const Context& context, const core::DrawKey& key) -> std::unique_ptr<Procedure> {
      return std::make_unique<ConstantStimuli>(spec, context, key);
    },
    [](const Spec&, double, double) -> std::optional<double> { return std::nullopt; },
};

}  // namespace turnpoint::procedure
