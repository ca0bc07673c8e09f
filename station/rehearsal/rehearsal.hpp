#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "station/core/records.hpp"
#include "station/protocol/protocol.hpp"
#include "station/simulation/observer.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::rehearsal {

/// Returns the observer's answer to a trial whose TrialSpec is complete. The time of the reply counts from
/// response zero.
using Answerer = std::function<simulation::Reply(const trial::TrialSpec&, const simulation::Question&)>;
/// Returns how the observer moves the slider in an adjustment.
using Adjuster = std::function<simulation::Setting(const trial::TrialSpec&, const simulation::Adjustment&)>;

/// The participant of a rehearsal. `adjust` is called only in adjustment tasks, `answer` in all other tasks.
struct Rehearser {
  Answerer answer;
  Adjuster adjust;
};

/// A simulated session: the rows that `run` would have stored, except those of tones.
struct Rehearsal {
  std::vector<core::BlockRecord> blocks;            ///< every attempt at every block, in order
  std::vector<double> block_s;                      ///< how long each of them took
  std::vector<trial::ProcedureEstimate> estimates;  ///< estimates of the procedures at the end of each block
  /// by how much runs of trials were longer than the protocol allows
  std::map<std::string, trial::Director::LongRun> long_runs;
  int trials = 0;
  double duration_s = 0;
};

/// Simulates a whole session in memory, with the director, trial machine and scoring of `run` but without
/// drive, screen and database. A trial takes microseconds. Levels, answers and response times equal those of
/// `run --observer` with the same seed and visit. Only the last trial of a block of a fixed time may be in
/// one of them alone, because a trial of a session lasts whole frames. Separate programs are not started:
/// procedure::StandIns take the place of their procedures. `earlier` are the trials of the participant's
/// earlier sessions. Several threads may use the same protocol at once.
Rehearsal rehearse(const protocol::Protocol& protocol, const protocol::Visit& visit, std::uint64_t seed,
                   const Rehearser& rehearser, const procedure::EarlierTrials& earlier = {});

/// The simulated observer that `run --observer` uses.
Rehearser rehearser(const simulation::Observer& observer);

}  // namespace turnpoint::rehearsal
