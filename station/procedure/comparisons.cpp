#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "station/procedure/constant_stimuli.hpp"
#include "station/procedure/description.hpp"
#include "station/procedure/keys.hpp"
#include "station/procedure/state_hash.hpp"

namespace turnpoint::procedure {

using core::phrase, core::plain;

namespace {

/// All choices of so many of `n` stimuli, each in ascending order.
std::vector<std::vector<std::size_t>> choices_of(std::size_t n, std::size_t so_many) {
  std::vector<std::vector<std::size_t>> all;
  std::vector<std::size_t> at(so_many);
  std::iota(at.begin(), at.end(), std::size_t{0});
  if (so_many > n) return all;
  for (;;) {
    all.push_back(at);
    auto last = so_many;
    while (last > 0 && at[last - 1] == n - so_many + last - 1) --last;
    if (last == 0) return all;
    ++at[last - 1];
    for (auto next = last; next < so_many; ++next) at[next] = at[next - 1] + 1;
  }
}

/// The forms in which a choice of stimuli can be presented: a pair and a triad forth and back, two pairs in
/// either order, with the lower stimulus of each first or last.
std::vector<std::vector<std::size_t>> forms_of(const std::vector<std::size_t>& s) {
  if (s.size() < 4) return {s, {s.rbegin(), s.rend()}};
  return {s, {s[2], s[3], s[0], s[1]}, {s[3], s[2], s[1], s[0]}, {s[1], s[0], s[3], s[2]}};
}

/// Presents all pairs, triads or quadruples of the values. Every repeat has each of them once, in one of its
/// forms, but a pair in both orders. Each form comes equally often, as far as possible. Unanswered trials are
/// repeated later.
class Comparisons : public Procedure {
 public:
  Comparisons(const Spec& spec, const Context& context, const core::DrawKey& key)
      : spec_(spec), context_(context), key_(key) {
    std::ranges::sort(spec_.values);
    core::Draws draws({key.seed, core::Stream::level_order, key.block, key.attempt, 0});
    const auto chosen = choices_of(spec.values.size(), 1 + spec.against.size());
    std::vector<std::size_t> first_form(chosen.size());
    std::iota(first_form.begin(), first_form.end(), std::size_t{0});
    draws.shuffle(first_form);
    for (std::size_t repeat = 0; repeat < static_cast<std::size_t>(spec.repeats); ++repeat) {
      std::vector<std::vector<std::size_t>> part;
      for (std::size_t i = 0; i < chosen.size(); ++i) {
        const auto forms = forms_of(chosen[i]);
        if (forms.front().size() == 2)
          part.insert(part.end(), forms.begin(), forms.end());
        else
          part.push_back(forms[(first_form[i] + repeat) % forms.size()]);
      }
      draws.shuffle(part);
      queue_.insert(queue_.end(), part.begin(), part.end());
    }
    total_ = static_cast<int>(queue_.size());
  }

  std::optional<Proposal> next() const override {
    if (position_ >= queue_.size()) return std::nullopt;
    const auto& stimuli = queue_[position_];
    Proposal proposal{spec_.values[stimuli.front()]};
    for (std::size_t i = 1; i < stimuli.size(); ++i) proposal.against.push_back(spec_.values[stimuli[i]]);
    return proposal;
  }

  void record(Answer answer) override {
    const auto stimuli = queue_[position_++];
    if (answer != Answer::none || context_.unanswered_are_data) {
      ++recorded_;
      return;
    }
    const auto offset = place_of_repetition(key_, requeued_++, queue_.size() - position_);
    queue_.insert(queue_.begin() + static_cast<std::ptrdiff_t>(position_ + offset), stimuli);
  }

  int recorded() const override { return recorded_; }
  int expected() const override { return total_; }

  std::uint64_t state_hash() const override {
    StateHash hash;
    hash.add(position_);
    hash.add(static_cast<std::uint64_t>(recorded_));
    for (std::size_t i = position_; i < queue_.size(); ++i)
      for (const auto stimulus : queue_[i]) hash.add(stimulus);
    return hash.value();
  }

 private:
  Spec spec_;
  Context context_;
  core::DrawKey key_;
  std::vector<std::vector<std::size_t>>
      queue_;  ///< places of each trial's stimuli among all, in ascending order
  std::size_t position_ = 0;
  int recorded_ = 0, requeued_ = 0, total_ = 0;
};

/// A scale of so many stimuli takes seconds to compute, and grows with the third power of their number.
constexpr std::size_t kMostStimuli = 50, kMostTrials = 10000;

/// The largest number of stimuli that leaves a procedure within both limits; 0 if none does.
std::size_t most_stimuli(Spec spec) {
  spec.values.resize(kMostStimuli);
  while (list_trials(spec) > kMostTrials) spec.values.pop_back();
  return list_trials(spec) > 0 ? spec.values.size() : 0;
}

void validate_comparisons(const Spec& spec, std::vector<Problem>& problems) {
  const auto together = 1 + spec.against.size();
  const auto needed = together == 2 ? 2 : together + 1;
  if (spec.values.size() < needed)
    problems.push_back({"values", phrase("too few stimuli"), phrase("at least %1", {plain(needed)})});
  if (std::set<double>(spec.values.begin(), spec.values.end()).size() < spec.values.size())
    problems.push_back({"values", phrase("a value appears twice"), phrase("list each stimulus once")});
  if (spec.repeats < 1)
    problems.push_back({"repeats", phrase("below 1"), phrase("write a whole number of 1 or more")});
  if (!problems.empty()) return;
  const auto most = most_stimuli(spec);
  if (most < needed)
    problems.push_back({"repeats", phrase("too many trials: %1", {plain(list_trials(spec))}),
                        phrase("at most %1 trials: use fewer repeats", {plain(kMostTrials)})});
  else if (spec.values.size() > most)
    problems.push_back({"values", phrase("too many stimuli: %1", {plain(spec.values.size())}),
                        phrase("at most %1 with this number of repeats", {plain(most)})});
}

}  // namespace

extern const Description comparisons{
    "comparisons",
    Choice::listed,
    []() -> core::Keys {
      using namespace core::key;
      return {
          numbers("values", any_level, "the stimuli that are compared with each other").required(),
          strings("against",
                  "the factors of the other intervals, in order: one for all pairs of the values (in both "
                  "orders), two for all triads, three for all quadruples")
              .holding(1, 3)
              .required(),
          integer("repeats", 1, 10000,
                  "how often each pair is presented in each order, or each triad or quadruple")
              .required()};
    },
    [](core::TableReader& reader, Spec& spec) {
      spec.values = reader.numbers("values");
      spec.repeats = reader.integer("repeats");
      reader.require("against");
      spec.against = reader.maybe_strings("against");
    },
    validate_comparisons,
    [](const Spec& spec, const Context& context, const core::DrawKey& key) -> std::unique_ptr<Procedure> {
      return std::make_unique<Comparisons>(spec, context, key);
    },
    [](const Spec&, double, double) -> std::optional<double> { return std::nullopt; },
};

}  // namespace turnpoint::procedure
