#include "station/session/resume.hpp"

#include <fmt/format.h>

#include <ostream>

#include "station/core/number.hpp"
#include "station/session/prepare.hpp"
#include "station/session/self_test.hpp"
#include "station/store/read.hpp"

namespace turnpoint::session {

namespace {

ResumeAt resume_at(const std::string& policy, const protocol::Resume& rules) {
  if (policy == "restart") return ResumeAt::session_start;
  if (policy == "block") return ResumeAt::block_start;
  if (policy == "resume") return ResumeAt::next_trial;
  switch (rules.incomplete) {
    case protocol::ResumePolicy::restart:
      return ResumeAt::session_start;
    case protocol::ResumePolicy::block:
      return ResumeAt::block_start;
    case protocol::ResumePolicy::ask:
    case protocol::ResumePolicy::resume:
      break;
  }
  return rules.restart_unit == "block" ? ResumeAt::block_start : ResumeAt::next_trial;
}

}  // namespace

std::optional<Setup> prepare_resume(const ResumeRequest& request, std::ostream& messages) {
  const auto found = store::interrupted_session(request.database, request.session_id);
  if (!found) return std::nullopt;
  const auto& start = found->session.start;
  Setup setup;
  setup.rig = rig::parse(start.rig_text, start.rig_path);
  setup.protocol = protocol::parse(start.protocol_text, start.protocol_path);
  if (start.calibration_id) take_calibration(start.calibration_text, "the session's calibration", setup);
  if (start.run_mode == core::RunMode::live)
    if (const auto mixer = session::read_mixer(setup.rig); !mixer.changes.empty())
      throw core::BadInput({{{start.rig_path, 0, 0}, mixer.changes.front(), core::phrase("refusal.mixer")}});
  setup.consent_version = start.consent_version;
  const double age_h = found->age_s / 3600, allowed_h = setup.protocol.resume.max_age_h;
  if (age_h < 0)
    messages << "resume: the clock was set back after the session was interrupted, so the age of the session "
                "is unknown\n";
  if (age_h > allowed_h && !request.any_age)
    throw core::BadInput({{{start.protocol_path, 0, 0},
                           core::phrase("refusal.too_old", {core::plain(found->session.session_id),
                                                            core::plain(core::number(age_h, 3))}),
                           core::phrase("refusal.resume_rule", {core::plain(core::number(allowed_h))})}});
  setup.participant = start.participant;
  setup.database = request.database;
  setup.run_mode = start.run_mode;
  setup.language = start.language;
  setup.observer = start.observer;
  setup.seed = start.seed;
  setup.conditions = start.conditions;
  setup.self_test = request.self_test && start.observer.empty();
  setup.despite = request.despite;
  setup.resume_session = found->session.session_id;
  setup.resume_at = resume_at(request.policy, setup.protocol.resume);
  messages << "resume: session " << found->session.session_id << " of participant " << start.participant
           << ", " << found->session.trials << " trials stored\n";
  return setup;
}

}  // namespace turnpoint::session
