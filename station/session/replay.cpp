#include "station/session/replay.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/session/planned_session.hpp"
#include "station/trial/question.hpp"
#include "station/trial/rows.hpp"

namespace turnpoint::session {

using core::Failure, core::phrase, core::plain;

namespace {

core::Phrase stored_level(const std::optional<double>& level) {
  return plain(core::exact(level.value_or(0)));
}

/// Advances the director to a block that the log contains. For this, finishes the director's current block,
/// or repeats a restart of the block or session that is in the log.
void enter_stored(trial::Director& director, const core::BlockStart& block) {
  const auto here = [&] {
    return director.block_index() == block.block_index && director.attempt() == block.attempt;
  };
  if (!here() && director.block() != nullptr && !director.next()) director.finish_block();
  if (!here() && block.block_index == 0 && block.attempt > director.attempt()) director.restart_session();
  while (!here() && director.block_index() == block.block_index && director.attempt() < block.attempt)
    director.restart_block();
  if (!here()) throw Failure(phrase("resume.other_block", {plain(block.block_index)}));
}

/// Refuses a session because the separate program of a procedure would not present the stored level.
[[noreturn]] void refuse_program(const std::string& procedure, const core::TrialRow& trial, core::Phrase now,
                                 const store::StoredSession& stored, const Programs& programs) {
  std::string path = procedure;
  auto change = phrase("resume.program_differs");
  for (const auto& program : programs.started()) {
    if (program.procedure != procedure) continue;
    path = program.path;
    const auto* before = as_recorded(program, stored.events);
    if (before != nullptr && before->sha256 != program.sha256)
      change = phrase("resume.program_changed", {plain(before->version), plain(before->sha256),
                                                 plain(program.version), plain(program.sha256)});
  }
  throw Failure(phrase("resume.program", {plain(trial.trial_index), plain(path), std::move(now),
                                          stored_level(trial.level), std::move(change)}));
}

/// Lets the director process a stored trial again. Throws core::Failure if the director would have
/// presented another level or has another state afterwards. In that case the log comes from a different
/// program or protocol.
void replay(trial::Director& director, const core::TrialRow& trial, const protocol::Protocol& protocol,
            const store::StoredSession& stored, const Programs& programs) {
  const auto mismatch = [&trial](const char* what, std::vector<core::Phrase> values = {}) {
    throw Failure(phrase("resume.mismatch", {plain(trial.trial_index), phrase(what, std::move(values))}));
  };
  const auto spec = director.next();
  const bool by_program = protocol::is_program(protocol, trial.procedure);
  if (!spec && by_program)
    refuse_program(trial.procedure, trial, phrase("resume.program_done"), stored, programs);
  if (!spec) mismatch("resume.ended");
  if (spec->level != trial.level && by_program && spec->procedure == trial.procedure)
    refuse_program(trial.procedure, trial, phrase("resume.program_gives", {stored_level(spec->level)}),
                   stored, programs);
  if (spec->level != trial.level)
    mismatch("resume.level", {stored_level(spec->level), stored_level(trial.level)});
  const auto again = trial::row_of(*spec, protocol, trial.trial_index);
  if (again.factors != trial.factors || again.correct_response != trial.correct_response)
    mismatch("resume.factors");
  trial::TrialEnd end;
  end.outcome = trial.outcome;
  end.correct = trial.given.correct;
  end.friction = trial.finger.mu;
  const auto& task = protocol::of_task(protocol, spec->task).task;
  if (trial.given.response) end.response = protocol::answer_index(task, *trial.given.response);
  if ((spec->slider || task.value) && trial.given.response) {
    const auto value = core::read_number(*trial.given.response);
    if (!value) mismatch("resume.no_number", {plain(*trial.given.response)});
    end.response = 0;
    if (spec->slider) end.setting = value;
  }
  director.record(end);
  if (director.state_hash() != trial.learned.state_hash) mismatch("resume.state");
  director.spend(trial.timing.duration_s);
}

/// Checks that the simulated observer gives the stored answer, because a session must not mix
/// the answers of two different observers. Adjustments are not checked, because their rows contain no answer
/// of the observer.
void check_observer(const Setup& setup, const simulation::Respondent& observer,
                    const store::StoredSession& stored, const trial::TrialSpec& spec,
                    const core::TrialRow& trial) {
  constexpr double tolerance_s = 1e-3;
  if (trial.outcome != core::Outcome::answered || !trial.timing.response_time_s || spec.slider ||
      spec.strokes)
    return;
  const auto reply = observer.answer(trial::question_of(spec, setup.protocol, stored.session.start.seed));
  const auto answer = reply.value    ? std::optional(core::exact(*reply.value))
                      : reply.choice ? std::optional(protocol::answer_id(
                                           protocol::of_task(setup.protocol, spec.task).task, *reply.choice))
                                     : std::nullopt;
  if (answer == trial.given.response && reply.confidence == trial.given.confidence &&
      std::fabs(reply.response_time_s - *trial.timing.response_time_s) < tolerance_s)
    return;
  throw Failure(phrase("resume.observer", {plain(trial.trial_index), plain(setup.observer)}));
}

}  // namespace

const core::ProgramRow* as_recorded(const core::ProgramRow& program,
                                    const std::vector<core::EventRow>& events) {
  const core::ProgramRow* last = nullptr;
  for (const auto& event : events)
    for (const auto& stored : event.programs)
      if (stored.role == program.role && stored.procedure == program.procedure) last = &stored;
  return last;
}

trial::Director replayed(const Setup& setup, const store::StoredSession& stored, Programs& programs) {
  trial::Director director(setup.protocol, visit_of(stored.session), stored.session.start.seed, &programs,
                           earlier_trials(setup.database, setup.protocol, stored.session));
  const auto observer =
      setup.observer.empty() ? std::nullopt : std::optional(programs.respondent(setup.observer));
  for (const auto& block : stored.blocks) {
    enter_stored(director, block.start);
    for (const auto& trial : block.trials)
      if (trial.type != core::TrialType::warmup) {
        const auto spec = director.next();
        replay(director, trial, setup.protocol, stored, programs);
        if (spec && observer) check_observer(setup, *observer, stored, *spec, trial);
      }
  }
  switch (setup.resume_at) {
    case ResumeAt::next_trial:
      if (director.trials_done() > 0) director.warm_up(setup.protocol.resume.warmup);
      director.rested();
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
