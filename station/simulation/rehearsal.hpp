#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::simulation {

/// Who answers a trial; the trial is complete, and the reply's time counts from response_zero.
using Answerer = std::function<observer::Reply(const trial::TrialSpec&, const observer::Question&)>;
/// Who sets a slider; times count from its onset.
using Adjuster = std::function<observer::Setting(const trial::TrialSpec&, const observer::Adjustment&)>;

/// Who sits a rehearsal; `adjust` is asked in an adjustment alone, `answer` in every other task.
struct Rehearser {
  Answerer answer;
  Adjuster adjust;
};

/// A session that was never driven: the rows that `run` would have stored, without tones.
struct Rehearsal {
  std::vector<records::BlockRecord> blocks;         ///< every attempt at every block, in order
  std::vector<trial::ProcedureEstimate> estimates;  ///< when each block ended
  int trials = 0;
  double duration_s = 0;
};

/// Runs a whole session in memory: director, trial machine and scoring are those of `run`, only drive, screen
/// and database are missing, so that a trial takes microseconds. Levels, answers and response times equal
/// those of `run --observer` with the same seed and sequence index. Thread-safe on a shared protocol.
Rehearsal rehearse(const protocol::Protocol& protocol, int sequence_index, std::uint64_t seed,
                   const Rehearser& rehearser);

/// The simulated observer of `run --observer`.
Rehearser rehearser(const observer::Observer& observer);

}  // namespace turnpoint::simulation
