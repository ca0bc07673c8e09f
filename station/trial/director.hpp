#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/trial/slider.hpp"

namespace turnpoint::trial {

/// A trial to present, completely decided before anything sounds.
struct TrialSpec {
  int block_index = 0, attempt = 0;
  int trial_in_block = 0;  ///< key of the trial's random draws; repeating a void trial uses the same key
  terms::TrialType type = terms::TrialType::experimental;
  std::string procedure;  ///< name of the procedure; "" for trials outside procedures
  std::optional<double> level;
  protocol::Factors factors;
  std::vector<std::vector<std::string>> intervals;  ///< scene names in the order of presentation
  std::vector<double> rove_dB;                      ///< roving of each interval
  /// index of the right choice; empty if no answer is right
  std::optional<int> correct;
  std::optional<SliderSpan> slider;  ///< the slider; only for an adjustment
  double iti_s = 0, foreperiod_s = 0;
  double deadline_s = 0;
  /// true if the deadline is part of the design (instructions), so that a timeout counts as a result
  bool timeouts_are_data = false;
};

/// The result of a trial, as far as the next trials depend on it.
struct TrialEnd {
  terms::Outcome outcome = terms::Outcome::answered;
  std::optional<int> response;
  std::optional<bool> correct;
  std::optional<double> setting = {};  ///< the setting; only for an adjustment that was answered
};

struct ProcedureEstimate {
  std::string procedure, parameter;
  double mean = 0;
  std::optional<double> sd;  ///< see procedure::Estimate
  std::string basis;
};
/// Formats an estimate with everything that is known of it: `-12.3 (SD 1.25, reversals 5 to 12 of 12)`.
std::string in_words(const ProcedureEstimate& estimate);

/// Decides what comes next: blocks in the participant's order, practice with its pass criterion, procedures
/// and their interleaving, catch trials, orders of intervals, roving, and times. Pure: the same protocol,
/// sequence index, seed and results give the same trials, regardless of void trials in between. Resuming a
/// session replays it.
class Director {
 public:
  Director(const protocol::Protocol& protocol, int sequence_index, std::uint64_t seed);
  ~Director();
  Director(Director&&) noexcept;

  /// The current block; null when the session is over or was ended (see ended_because()).
  const protocol::Block* block() const;
  int block_index() const;
  int attempt() const;
  int blocks() const;

  /// The next trial of this block; the same one again after a void trial. Empty when the block is done.
  std::optional<TrialSpec> next();
  /// Records the result of the trial that next() returned last.
  void record(const TrialEnd& end);
  /// Closes a finished block: advances to the next one, or repeats practice that was not passed.
  void finish_block();
  /// Restarts the current block as another attempt.
  void restart_block();
  /// Restarts the session from the first block, as another attempt at every block.
  void restart_session();
  /// Inserts this number of warm-up trials before the next trial. They have their own rows and draws.
  void warm_up(int trials);

  /// why the session ends before its last block; otherwise ""
  const std::string& ended_because() const;
  /// Number of counted trials done so far, and in all (an estimate if procedures stop by themselves).
  int trials_done() const;
  int trials_expected() const;
  /// Estimates of those of the block's procedures that estimate something.
  std::vector<ProcedureEstimate> estimates() const;
  /// The threshold (or PSE) and its SD, estimated by the procedure of the last trial, if there is one.
  std::optional<std::pair<double, std::optional<double>>> threshold() const;
  /// A hash of all discrete state. If it differs after a replay, the session was not reproduced.
  std::uint64_t state_hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::trial
