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

/// One trial as it shall be presented, complete before anything sounds.
struct TrialSpec {
  int block_index = 0, attempt = 0;
  int trial_in_block = 0;  ///< the key of its draws; a repeated (void) trial has the same
  terms::TrialType type = terms::TrialType::experimental;
  std::string procedure;  ///< "" outside procedures
  std::optional<double> level;
  protocol::Factors factors;
  std::vector<std::vector<std::string>> intervals;  ///< scene names in the order presented
  std::vector<double> rove_dB;                      ///< one an interval
  std::optional<int> correct;                       ///< index of the right choice; none: nothing is right
  std::optional<SliderSpan> slider;                 ///< adjustment only
  double iti_s = 0, foreperiod_s = 0;
  double deadline_s = 0;
  bool timeouts_are_data = false;  ///< the deadline belongs to the design (instructions)
};

/// What came of it, as far as the next trial depends on it.
struct TrialEnd {
  terms::Outcome outcome = terms::Outcome::answered;
  std::optional<int> response;
  std::optional<bool> correct;
  std::optional<double> setting = {};  ///< of an adjustment that was answered
};

struct ProcedureEstimate {
  std::string procedure, parameter;
  double mean = 0;
  std::optional<double> sd;  ///< as in procedure::Estimate
  std::string basis;
};
/// `-12.3 (SD 1.25, reversals 5 to 12 of 12)`: what there is of it.
std::string in_words(const ProcedureEstimate& estimate);

/// Decides what comes next: blocks in the participant's order, practice with its pass criterion, procedures
/// and their interleaving, catch trials, orders of intervals, roving and intervals in time. Pure: the same
/// protocol, sequence index, seed and ends give the same trials, whatever was void in between; resume replays
/// it.
class Director {
 public:
  Director(const protocol::Protocol& protocol, int sequence_index, std::uint64_t seed);
  ~Director();
  Director(Director&&) noexcept;

  /// The block that runs now; none when the session is over or was ended (see ended_because()).
  const protocol::Block* block() const;
  int block_index() const;
  int attempt() const;
  int blocks() const;

  /// The next trial of this block, the same again after a void one; none when the block is done.
  std::optional<TrialSpec> next();
  /// What came of the trial last given.
  void record(const TrialEnd& end);
  /// Closes a block that is done: on to the next, or again if practice was not passed.
  void finish_block();
  /// Leaves the block and starts it afresh as another attempt.
  void restart_block();
  /// Starts from the first block again, as another attempt at every block.
  void restart_session();
  /// So many warm-up trials before the next one, with rows and draws of their own.
  void warm_up(int trials);

  /// "" or why the session ends before its last block.
  const std::string& ended_because() const;
  /// Trials that count done so far and expected in all (an estimate where procedures stop by themselves).
  int trials_done() const;
  int trials_expected() const;
  /// Of the block's procedures that estimate something.
  std::vector<ProcedureEstimate> estimates() const;
  /// Threshold (or PSE) estimate and its SD of the procedure that gave the last trial, where there is one.
  std::optional<std::pair<double, std::optional<double>>> threshold() const;
  /// A hash of all discrete state: equal after a replay, or something differs.
  std::uint64_t state_hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::trial
