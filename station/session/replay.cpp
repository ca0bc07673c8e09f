#include "station/session/replay.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "station/session/planned_session.hpp"
#include "station/text/number.hpp"
#include "station/trial/question.hpp"
#include "station/trial/rows.hpp"

namespace turnpoint::session {

namespace {

/// Advances the director to a block that the log contains. Finishes its current block first, or repeats the
/// recorded restart of the block or session.
void enter_stored(trial::Director& director, const records::BlockStart& block) {
  const auto here = [&] {
    return director.block_index() == block.block_index && director.attempt() == block.attempt;
  };
  if (!here() && director.block() != nullptr && !director.next()) director.finish_block();
  if (!here() && block.block_index == 0 && block.attempt > director.attempt()) director.restart_session();
  while (!here() && director.block_index() == block.block_index && director.attempt() < block.attempt)
    director.restart_block();
  if (!here())
    throw std::runtime_error(
        "resume: the stored block " + std::to_string(block.block_index) +
        " is not the block that the protocol runs next; the session and the protocol do not belong together");
}

/// Lets the director process a stored trial again. Throws std::runtime_error if the director would have
/// presented another level or has another state afterwards. In that case the log comes from a different
/// program or protocol.
void replay(trial::Director& director, const records::TrialRow& trial, const protocol::Protocol& protocol) {
  const auto mismatch = [&trial](const std::string& what) {
    throw std::runtime_error(
        fmt::format("resume: stored trial {} cannot be replayed: {}; the database, the protocol or this "
                    "program has changed",
                    trial.trial_index, what));
  };
  const auto spec = director.next();
  if (!spec) mismatch("the session would already have ended");
  if (spec->level != trial.level)
    mismatch(fmt::format("this program would present level {}, but level {} is stored",
                         spec->level.value_or(0), trial.level.value_or(0)));
  const auto again = trial::row_of(*spec, protocol, trial.trial_index);
  if (again.factors != trial.factors || again.correct_response != trial.correct_response)
    mismatch("this program would present other values of the factors, or another answer would be right");
  trial::TrialEnd end;
  end.outcome = trial.outcome;
  end.correct = trial.correct;
  end.friction = trial.finger.mu;
  if (trial.response)
    for (std::size_t i = 0; i < protocol.task.choices.size(); ++i)
      if (protocol.task.choices[i].id == *trial.response) end.response = static_cast<int>(i);
  if ((spec->slider || protocol.task.value) && trial.response) {
    const auto value = text::read_number(*trial.response);
    if (!value) mismatch("\"" + *trial.response + "\" is not a number");
    end.response = 0;
    if (spec->slider) end.setting = value;
  }
  director.record(end);
  if (director.state_hash() != trial.state_hash) mismatch("the state of the procedures differs afterwards");
}

/// Checks that the simulated observer of this program gives the stored answer, because a session must not mix
/// the answers of two different observers. Adjustments are not checked, because their rows contain no answer
/// of the observer.
void check_observer(const Setup& setup, const store::StoredSession& stored, const trial::TrialSpec& spec,
                    const records::TrialRow& trial) {
  constexpr double tolerance_s = 1e-3;
  if (trial.outcome != terms::Outcome::answered || !trial.response_time_s || spec.slider || spec.strokes)
    return;
  const observer::Observer observer(observer::parse(setup.observer));
  const auto reply = observer.answer(trial::question_of(spec, setup.protocol, stored.session.start.seed));
  const auto& choices = setup.protocol.task.choices;
  const auto answer = reply.value    ? std::optional(text::exact(*reply.value))
                      : reply.choice ? std::optional(choices[static_cast<std::size_t>(*reply.choice)].id)
                                     : std::nullopt;
  if (answer == trial.response && reply.confidence == trial.confidence &&
      std::fabs(reply.response_time_s - *trial.response_time_s) < tolerance_s)
    return;
  throw std::runtime_error(
      "resume: trial " + std::to_string(trial.trial_index) +
      " was not answered as the simulated observer \"" + setup.observer +
      "\" of this program would answer; only the earlier version that recorded the session can continue it");
}

}  // namespace

trial::Director replayed(const Setup& setup, const store::StoredSession& stored) {
  trial::Director director(setup.protocol, visit_of(stored.session), stored.session.start.seed);
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
