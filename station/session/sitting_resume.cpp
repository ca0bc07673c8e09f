#include <stdexcept>
#include <string>

#include "station/session/rows.hpp"
#include "station/session/sitting.hpp"

namespace turnpoint::session {

void Sitting::replay_stored_blocks() {
  const auto& stored = log_.stored_blocks();
  if (setup_.resume_session.empty()) return;
  for (const auto& block : stored) {
    enter_stored(block.start);
    for (const auto& trial : block.trials) {
      ++trial_index_;
      if (trial.type != store::TrialType::warmup) replay(director_, trial, setup_.protocol);
    }
  }
  switch (setup_.resume_at) {
    case ResumeAt::next_trial:
      if (director_.trials_done() > 0) director_.warm_up(setup_.protocol.resume.warmup);
      break;
    case ResumeAt::block_start:
      director_.restart_block();
      break;
    case ResumeAt::session_start:
      director_.restart_session();
      break;
  }
}

/// Takes the director to a block that the log holds: by finishing what is done, or by the restart that made
/// it.
void Sitting::enter_stored(const store::BlockStart& block) {
  const auto here = [&] {
    return director_.block_index() == block.block_index && director_.attempt() == block.attempt;
  };
  if (!here() && director_.block() != nullptr && !director_.next()) director_.finish_block();
  if (!here() && block.block_index == 0 && block.attempt > director_.attempt()) director_.restart_session();
  while (!here() && director_.block_index() == block.block_index && director_.attempt() < block.attempt)
    director_.restart_block();
  if (!here())
    throw std::runtime_error("resume: the log's block " + std::to_string(block.block_index) +
                             " is not the one that the protocol runs next; they do not belong together");
}

}  // namespace turnpoint::session
