#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::simulation {

/// Gives the answer of a trial. The TrialSpec is complete, and the reply's time counts from response_zero.
using Answerer = std::function<observer::Reply(const trial::TrialSpec&, const observer::Question&)>;
/// Sets a slider; times count from its onset.
using Adjuster = std::function<observer::Setting(const trial::TrialSpec&, const observer::Adjustment&)>;

/// The participant of a rehearsal. `adjust` is called only in an adjustment, `answer` in every other task.
struct Rehearser {
  Answerer answer;
  Adjuster adjust;
};

/// A simulated session without a drive: the rows that `run` would have stored, without tones.
struct Rehearsal {
  std::vector<records::BlockRecord> blocks;         ///< every attempt at every block, in order
  std::vector<trial::ProcedureEstimate> estimates;  ///< at the end of each block
  int trials = 0;
  double duration_s = 0;
};

/// Simulates a whole session in memory. Director, trial machine and scoring are those of `run`; only drive,
/// screen and database are missing, so a trial takes microseconds. Levels, answers and response times equal
/// those of `run --observer` with the same seed and sequence index. Thread-safe for a shared protocol.
Rehearsal rehearse(const protocol::Protocol& protocol, int sequence_index, std::uint64_t seed,
                   const Rehearser& rehearser);

/// The simulated observer that `run --observer` uses.
Rehearser rehearser(const observer::Observer& observer);

}  // namespace turnpoint::simulation
