#include <utility>

#include "station/protocol/sources.hpp"
#include "station/session/session_run.hpp"
#include "station/terms/program_failed.hpp"

namespace turnpoint::session {

// The part of SessionRun for procedures and observers that are separate programs.

/// Returns the next trial, after waiting for the program that chooses its level. If the program fails, the
/// session pauses: the page of the fault stands until the operator has pressed Continue, which starts the
/// program again. Nobody could do that in a simulated session, so it is interrupted. Returns nothing if the
/// block is done or the session is to stop.
std::optional<trial::TrialSpec> SessionRun::next_trial() {
  while (!gate_.stop_asked()) {
    stage_->wait_for([this] { return director_.ready(); });
    try {
      if (const auto failed = std::exchange(failed_program_, std::nullopt))
        throw terms::ProgramFailed(*failed);
      auto spec = director_.next();
      log_programs();
      return spec;
    } catch (const terms::ProgramFailed& failed) {
      records::EventRow event;
      event.time_ns = stage_->now_ns();
      event.kind = "fault";
      event.value = terms::name(FaultKind::program) + std::string(": ") + failed.what();
      log_.event(event);
      log_programs();
      if (!setup_.observer.empty()) {
        gate_.stop(failed.what());
        continue;
      }
      gate_.set_fault(Fault{FaultKind::program, failed.what()});
      static_cast<void>(gate_.recover());  // the loop ends if somebody stops the session instead
    }
  }
  return std::nullopt;
}

/// Starts to plan the next trial, unless the program that chooses its level has not replied yet.
void SessionRun::plan_ahead() {
  if (failed_program_ || !director_.ready()) return;
  try {
    if (const auto next = director_.next()) plans_.begin(*next);
  } catch (const terms::ProgramFailed& failed) {
    failed_program_ = failed.what();
  }
}

/// Stores which programs were started.
void SessionRun::log_programs() {
  if (programs_ == nullptr) return;
  auto started = programs_->take_started();
  if (started.empty()) return;
  records::EventRow event;
  event.time_ns = stage_->now_ns();
  event.kind = records::kProgramEvent;
  event.value = started.front().program;
  event.programs = std::move(started);
  log_.event(event);
}

/// Stores what the programs of the block have estimated.
void SessionRun::log_estimates() {
  records::EventRow event;
  for (const auto& found : director_.estimates())
    if (protocol::is_program(setup_.protocol, found.procedure))
      event.estimates.push_back({director_.block_index(), director_.attempt(), found.procedure,
                                 found.parameter, found.mean, found.sd, found.basis});
  if (event.estimates.empty()) return;
  event.time_ns = stage_->now_ns();
  event.kind = records::kEstimatesEvent;
  event.value = director_.block()->name;
  log_.event(event);
}

}  // namespace turnpoint::session
