#include "station/session/replay.hpp"

#include <cmath>
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

/// Half of a session by one simulated observer and half by another would be neither's. Sliders are left out:
/// their row has no answer of the observer.
void check_observer(const Setup& setup, const store::StoredSession& stored, const TrialSpec& spec,
                    const store::TrialRow& trial) {
  constexpr double tolerance_s = 1e-3;
  if (trial.outcome != terms::Outcome::answered || !trial.response_time_s || spec.slider) return;
  const observer::Observer observer(observer::parse(setup.observer));
  const auto reply = observer.answer(question_of(spec, setup.protocol, stored.session.start.seed));
  const auto& choices = setup.protocol.task.choices;
  if (reply.choice && choices[static_cast<std::size_t>(*reply.choice)].id == trial.response &&
      std::fabs(reply.response_time_s - *trial.response_time_s) < tolerance_s)
    return;
  throw std::runtime_error(
      "resume: trial " + std::to_string(trial.trial_index) + " was not answered by \"" + setup.observer +
      "\" as this program simulates it; an earlier program did, and only that one can go "
      "on with the session");
}

}  // namespace

Director replayed(const Setup& setup, const store::StoredSession& stored) {
  Director director(setup.protocol, stored.session.sequence_index, stored.session.start.seed);
  for (const auto& block : stored.blocks) {
    enter_stored(director, block.start);
    for (const auto& trial : block.trials)
      if (trial.type != terms::TrialType::warmup) {
        const auto spec = director.next();
        replay(director, trial, setup.protocol);
        if (spec && !setup.observer.empty()) check_observer(setup, stored, *spec, trial);
      }
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
