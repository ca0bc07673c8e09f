#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/core/records.hpp"

namespace turnpoint::session {

/// What the participant has achieved in a block, as the pass mark of practice counts it: missed, early and
/// unsure answers count as not right. Void, warm-up and unscored trials are left out.
struct BlockScore {
  std::string block;
  bool practice = false;
  int attempt = 0, right = 0, trials = 0;
  double points = 0;
  std::vector<double> times_s;  ///< response times of the answers

  std::optional<double> accuracy() const;
  std::optional<double> median_time_s() const;
};

/// What the participant has achieved so far in the session. Of several attempts at a block, the newest
/// counts.
class Scores {
 public:
  /// Begins an attempt at a block, or goes on with the attempt that was begun last. A new attempt replaces
  /// the one before it, and the blocks after it.
  void begin(const core::BlockStart& block);
  /// Adds a trial of an attempt that was begun.
  void add(const core::BlockStart& block, const core::TrialRow& trial);
  void add(const std::vector<core::BlockRecord>& blocks);

  /// The newest attempt at a block; empty if none of its trials counts.
  BlockScore of(int block_index) const;
  /// Proportion of right answers by the name of the block. Blocks of the same name are taken together.
  std::map<std::string, double> accuracies() const;
  /// The points of all blocks that are no practice.
  double points() const;

 private:
  std::map<int, BlockScore> scores_;  ///< by the block's index
};

}  // namespace turnpoint::session
