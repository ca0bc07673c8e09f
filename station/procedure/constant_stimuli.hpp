#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// Where an unanswered trial of a list comes again, counted in the trials that are left: at a random place,
/// but not as the very next one; as the last if none is left. `repetitions` is the number of those before.
std::size_t place_of_repetition(const core::DrawKey& key, int repetitions, std::size_t left);

/// Presents every value `repeats` times. Combinations of the balanced factors occur equally often, as far as
/// possible. The order is shuffled.
/// Unanswered trials are repeated later; with rules of the order (Spec::rules), at once. Ends early if enough
/// of the last answers were right (Stop::right, Stop::of_last).
class ConstantStimuli : public Procedure {
 public:
  ConstantStimuli(const Spec& spec, const Context& context, const core::DrawKey& key);

  std::optional<Proposal> next() const override;
  std::vector<Candidate> candidates() const override;
  Proposal choice(std::size_t place) const override;
  void choose(std::size_t place) override;
  void record(Answer answer) override;
  int recorded() const override { return recorded_; }
  int expected() const override { return total_; }
  std::uint64_t state_hash() const override;

 private:
  struct Item {
    std::size_t value = 0, repeat = 0;
    std::vector<std::size_t> balance;
  };
  using Kind =
      std::pair<std::size_t, std::vector<std::size_t>>;  ///< value and levels of the balanced factors
  static Kind kind_of(const Item& item) { return {item.value, item.balance}; }
  static std::vector<Item> items(const Spec& spec, const Context& context, core::Draws& draws);
  /// Puts the items in an order that keeps the rules; or says why there is none, and leaves none.
  static ListOrder order_by_rules(const Spec& spec, std::vector<Item>& items, core::Draws& draws);
  /// The list that every session can have. Throws NoOrder.
  static std::vector<Item> sure_order(const Spec& spec, const Context& context);
  friend std::optional<Problem> order_problem(const Spec& spec, const Context& context);
  bool in_repeat(std::size_t at) const;
  void shuffle(std::vector<Item>& items, core::Draws& draws) const;

  Spec spec_;
  Context context_;
  core::DrawKey key_;
  std::vector<Item> queue_;
  std::size_t position_ = 0;
  std::map<Kind, int> left_;  ///< how many items of each kind are still to come
  /// the answers so far; kept only if the protocol sets Stop::right and Stop::of_last
  std::vector<bool> answers_;
  int recorded_ = 0, requeued_ = 0, total_ = 0;
};

/// Thrown by the constructor if no order of the list keeps Spec::rules.
struct NoOrder : std::invalid_argument {
  explicit NoOrder(ListOrder found);
  ListOrder found;
};

/// Says why no order of the list keeps Spec::rules; empty if there is one. The context needs the numbers of
/// levels.
std::optional<Problem> order_problem(const Spec& spec, const Context& context);

}  // namespace turnpoint::procedure
