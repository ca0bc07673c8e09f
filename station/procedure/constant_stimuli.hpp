#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// Presents every value `repeats` times. Combinations of the balanced factors occur as equally often as
/// possible. The order is shuffled so that at most max_run trials in a row have the same right answer.
/// Unanswered trials are repeated later. Ends early if Stop::right is met.
class ConstantStimuli : public Procedure {
 public:
  ConstantStimuli(const Spec& spec, const Context& context, const random::Key& key);

  std::optional<Proposal> next() const override;
  void record(Answer answer) override;
  int recorded() const override { return recorded_; }
  int expected() const override { return total_; }
  std::uint64_t state_hash() const override;

 private:
  struct Item {
    std::size_t value = 0;
    std::vector<std::size_t> balance;
  };
  std::vector<Item> items(random::Draws& draws) const;
  void order(std::vector<Item>& items, random::Draws& draws) const;
  bool runs_too_long(const std::vector<Item>& items, std::size_t from) const;
  void break_runs(std::vector<Item>& items, random::Draws& draws) const;

  Spec spec_;
  Context context_;
  random::Key key_;
  std::vector<Item> queue_;
  std::size_t position_ = 0;
  std::vector<bool> answers_;  ///< kept only for the rule "right of the last"
  int recorded_ = 0, requeued_ = 0, total_ = 0;
};

}  // namespace turnpoint::procedure
