#include "station/session/replay.hpp"

#include <stdexcept>
#include <string>

#include "station/session/rows.hpp"

namespace turnpoint::session {

namespace {

/// Takes the director to a block that the log holds: by finishing what is done, or by the restart that made
/// it.
void enter_stored(Director& director, const store::BlockStart& block) {
  const auto here = [&] {
    return director.block_index() == block.block_index && director.attempt() == block.attempt;
  };
  if (!here() && director.block() != nullptr && !director.next()) director.finish_block();
  if (!here() && block.block_index == 0 && block.attempt > director.attempt()) director.restart_session();
  while (!here() && director.block_index() == block.block_index && director.attempt() < block.attempt)
    director.restart_block();
  if (!here())
    throw std::runtime_error("resume: the log's block " + std::to_string(block.block_index) +
                             " is not the one that the protocol runs next; they do not belong together");
}

}  // namespace

Director replayed(const Setup& setup, const store::StoredSession& stored) {
  Director director(setup.protocol, stored.session.sequence_index, stored.session.start.seed);
  for (const auto& block : stored.blocks) {
    enter_stored(director, block.start);
    for (const auto& trial : block.trials)
      if (trial.type != store::TrialType::warmup) replay(director, trial, setup.protocol);
  }
  switch (setup.resume_at) {
    case ResumeAt::next_trial:
      if (director.trials_done() > 0) director.warm_up(setup.protocol.resume.warmup);
      break;
    case ResumeAt::block_start:
      director.restart_block();
      break;
    case ResumeAt::session_start:
      director.restart_session();
      break;
  }
  return director;
}

}  // namespace turnpoint::session
