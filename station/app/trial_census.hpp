#pragma once
#include <map>
#include <optional>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/session/director.hpp"

namespace turnpoint::app {

/// Trials with the same factors, and the share of all counted trials that they are.
struct TrialKind {
  protocol::Factors factors;  ///< all on which the task's scenes and its right answers depend
  double share = 0;
};

/// Counts which trials a session contains. Practice and warm-up are left out; catch trials are in. A factor
/// that the director draws afresh in each trial is not counted by what was drawn: kinds() takes each of its
/// levels as equally likely, which is exact.
class TrialCensus {
 public:
  explicit TrialCensus(const protocol::Protocol& protocol);

  void add(const protocol::Block& block, const session::TrialSpec& trial);
  void add(const TrialCensus& other);
  /// Simulates more sessions, after so many that were added, until the share of trials with the first answer
  /// right is known to 0.6 %, and the mean level to 0.8 % of its range where levels follow the answers; at most
  /// 630 sessions in all.
  void settle(int sessions_added);
  /// Shares sum to 1. Empty where nothing was counted.
  std::vector<TrialKind> kinds() const;

 private:
  bool is_settled() const;
  std::optional<double> share_of_range(const session::TrialSpec& trial) const;
  bool is_drawn(const protocol::Factor& factor, const protocol::Block& block,
                const session::TrialSpec& trial) const;

  const protocol::Protocol* protocol_;
  std::vector<const protocol::Factor*> relevant_;
  std::map<protocol::Factors, double> counts_;  ///< by the factors that were not drawn
  double total_ = 0;
  double first_right_ = 0, scored_ = 0, levels_ = 0;  ///< of the session that is being counted
  std::vector<double> first_shares_, mean_levels_;    ///< of the sessions before it
};

/// The trials of sessions of the simulated participant with default parameters, settled.
TrialCensus census_of(const protocol::Protocol& protocol);

}  // namespace turnpoint::app
