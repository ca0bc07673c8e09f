#pragma once
#include <cstdint>
#include <vector>

#include "station/procedure/posterior.hpp"
#include "station/procedure/procedure.hpp"

namespace turnpoint::procedure {

/// QUEST+ (Watson 2017) over one or two dimensions, psi (Kontsevich & Tyler 1999; QUEST+ on threshold and
/// slope) and psi-marginal (Prins 2013; uses the entropy of the kept parameters). ZEST (King-Smith et al.
/// 1994) and best PEST (Lieberman & Pentland 1982) use the same posterior of the threshold, and place the
/// next trial at its mean and at the most likely threshold. Unanswered trials: see kRepeatsInARow.
class QuestPlus : public Procedure {
 public:
  explicit QuestPlus(const Spec& spec);

  std::optional<Proposal> next() const override;
  void record(Answer answer) override;
  int recorded() const override { return recorded_; }
  int expected() const override;
  Ended ended() const override { return ended_; }
  std::optional<core::Phrase> end() const override {
    return end_in_words(ended(), spec_.name, recorded_ + spent_);
  }
  std::map<std::string, Estimate> estimates() const override;
  std::vector<ThresholdAt> thresholds() const override { return posterior_.thresholds(); }
  std::optional<double> entropy_nats() const override { return posterior_.entropy_nats(); }
  std::uint64_t state_hash() const override;

 private:
  bool rules_met() const;
  Ended how_ended() const;
  std::size_t chosen() const;  ///< index of the stimulus to present next

  Spec spec_;
  Posterior posterior_;
  std::size_t stimulus_ = 0;
  int recorded_ = 0, unanswered_ = 0, spent_ = 0;
  std::vector<std::uint64_t> history_;  ///< index of the stimulus, and the answer, of each answered trial
  Ended ended_ = Ended::no;             ///< computed after each trial, because the rules ask the posterior
};

}  // namespace turnpoint::procedure
