#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/records.hpp"
#include "station/procedure/continuation.hpp"
#include "station/procedure/program.hpp"
#include "station/protocol/protocol.hpp"
#include "station/trial/slider.hpp"

namespace turnpoint::trial {

/// A trial to present. Everything about it is decided before its first stimulus.
struct TrialSpec {
  int block_index = 0, attempt = 0;
  /// part of the key of the trial's random draws; when a void trial is repeated, the key stays the same
  int trial_in_block = 0;
  core::TrialType type = core::TrialType::experimental;
  std::string procedure;  ///< name of the procedure that chose the level; "" if no procedure did
  std::size_t task = 0;   ///< which task it asks: see protocol::of_task()
  std::optional<double> level;
  protocol::Factors factors;
  std::vector<std::vector<std::string>> intervals;  ///< scene names in the order of presentation
  /// random change (roving) of the strength of each part of the intervals, in the order of parts_of(); all
  /// parts of an interval have the same share of what their scenes allow
  std::vector<double> rove_dB;
  /// true in the first trial of a block, after a break, and after an interruption, if that changes lengths
  bool fresh = false;
  /// index of the right choice; empty if no choice is right
  std::optional<int> correct;
  std::optional<SliderSpan> slider;  ///< the slider; only for an adjustment
  /// Set in a block of strokes, in which the finger strokes the surface and nothing is asked. The level of
  /// such a trial is then the displacement in um; 0 means that the surface is at rest.
  std::optional<protocol::Strokes> strokes;
  double iti_s = 0, foreperiod_s = 0;
  /// length (s) of the interval if the trial is an example; empty: the length that the task gives
  std::optional<double> length_s = {};
  double deadline_s = 0, anticipation_s = 0;
  /// time from response_zero to the response signal; empty if there is no signal
  std::optional<double> signal_s;
  /// true if the block's instruction sets the deadline; a timeout then counts as a result
  bool timeouts_are_data = false;
  bool operator==(const TrialSpec&) const = default;
};

/// The parts of a trial's result on which later trials depend.
struct TrialEnd {
  core::Outcome outcome = core::Outcome::answered;
  std::optional<int> response;
  std::optional<bool> correct;
  std::optional<double> setting = {};   ///< the setting; only for an adjustment that was answered
  std::optional<double> friction = {};  ///< measured coefficient of friction, in a block of strokes
};

struct ProcedureEstimate {
  std::string procedure, parameter;
  double mean = 0;
  std::optional<double> sd;  ///< empty if the estimate is a single number
  std::string basis = {};
  /// central 95 % credible interval, if the estimate comes from a posterior
  std::optional<std::pair<double, double>> interval = {};
};
/// Formats an estimate with its SD and basis, if known: `-12.3 (SD 1.25, reversals 5 to 12 of 12)`.
std::string in_words(const ProcedureEstimate& estimate);

/// Decides what comes next: blocks in the participant's order, practice until it is passed, procedures and
/// their interleaving, catch trials, orders of intervals, roving, and times. Pure: the same protocol,
/// visit, seed and results give the same trials, no matter how many void trials come in between. A
/// session is resumed by replaying its stored results through a director.
class Director {
 public:
  /// `programs` starts the programs of procedures that are programs; null if the protocol has none. It must
  /// outlive the director. `earlier` are the trials of the participant's earlier sessions, for procedures
  /// that continue.
  Director(const protocol::Protocol& protocol, const protocol::Visit& visit, std::uint64_t seed,
           procedure::Programs* programs = nullptr, procedure::EarlierTrials earlier = {});
  ~Director();
  Director(Director&&) noexcept;

  /// The current block; null when the session is over or was ended early (see ended_because()).
  const protocol::Block* block() const;
  int block_index() const;
  int attempt() const;
  int blocks() const;

  /// The task of the trial that next() returned last, until it is recorded; then that of the block.
  std::size_t task() const;

  /// True if next() would not wait for the program of a procedure.
  bool ready() const;
  /// Returns the next trial of this block. Waits for procedures that are programs, and throws
  /// core::ProgramFailed if one has failed; it may then be called again. After a void trial, returns the
  /// same trial again. Empty when the block is done.
  std::optional<TrialSpec> next();
  /// Records the result of the trial that next() returned last.
  void record(const TrialEnd& end);
  /// Adds the duration of the trial that was recorded last to the time of its block, which may end the block.
  /// Void trials and warm-up trials do not count. A trial that next() has already returned is given up then.
  void spend(double trial_s);
  /// Closes a finished block: advances to the next block, or repeats practice that was not passed.
  void finish_block();
  /// Starts another attempt at the current block.
  void restart_block();
  /// Restarts the session from the first block, with another attempt at every block.
  void restart_session();
  /// Inserts this number of warm-up trials before the next trial. They have their own rows and random draws.
  void warm_up(int trials);
  /// The next trial comes after a break or an interruption: its parts last for their first_s.
  void rested();

  /// why the session ends before its last block; "" if it does not
  const std::string& ended_because() const;
  /// Numbers of trials that count: done so far, and in total. The total is an estimate if procedures have
  /// stopping rules.
  int trials_done() const;
  int trials_expected() const;
  /// Returns the current estimates of the block's procedures. Procedures without an estimate are left out.
  std::vector<ProcedureEstimate> estimates() const;
  /// Says which of the block's procedures have ended, and how, if that was not by their rules.
  std::vector<core::Phrase> early_ends() const;
  /// A run of trials that was longer than the protocol allows.
  struct LongRun {
    int limit = 0, longest = 0;
  };
  /// The runs of the session so far that no order of the trials could keep within their limits, by the key of
  /// procedure::Spec::max_run.
  const std::map<std::string, LongRun>& long_runs() const;
  /// Threshold (or PSE) and its SD, as estimated by the procedure of the last trial; empty if that procedure
  /// has no estimate.
  std::optional<std::pair<double, std::optional<double>>> threshold() const;
  /// A trial of a friction table: its displacement and the measured coefficient of friction, which is empty
  /// if the trial was not valid.
  struct Stroke {
    double displacement_um = 0;
    std::optional<double> friction;
  };
  /// Returns the trials of the newest attempt at a block that measures a friction table, in the order
  /// presented. Empty for other blocks.
  const std::vector<Stroke>& strokes(int block_index) const;
  /// The blocks of the session in this participant's order.
  const std::vector<protocol::Block>& all_blocks() const;

  /// Returns a hash of all discrete state. If the hash differs after a replay, the replay did not reproduce
  /// the session.
  std::uint64_t state_hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::trial
