#include <filesystem>
#include <utility>

#include "station/session/self_test_rig.hpp"
#include "station/session/session_run.hpp"

namespace turnpoint::session {
namespace {

/// Returns the names of the failed checks, with what they found.
std::string failures(const std::vector<CheckRow>& checks) {
  std::string text;
  for (const auto& check : checks)
    if (check.verdict == Verdict::failed) text += (text.empty() ? "" : "; ") + check.name + ": " + check.what;
  return text;
}

}  // namespace

/// Runs the self-test, if the session has one, and stores it. If a check failed, the session continues only
/// with the operator's reason, which is stored too.
Flow SessionRun::pass_self_test() {
  if (!setup_.self_test) return Flow::go_on;
  SelfTestParts parts;
  parts.rig = &setup_.rig;
  parts.stage = stage_.get();
  parts.amplifier = stage_->guarded_amplifier();
  parts.capture = stage_->capture();
  const auto card = card_capture_of(setup_.rig);
  if (card && parts.amplifier != nullptr) parts.capture = card->setup;
  if (parts.capture) parts.room = stage_.get();
  parts.data_folder = std::filesystem::absolute(setup_.database).parent_path().string();
  parts.other = [this](Input input) { gate_.note(gate_.received(std::move(input))); };
  records::EventRow event{stage_->now_ns(), "self_test", "passed", std::nullopt};
  const auto checks = self_test(*self_test_rig(std::move(parts)));
  for (const auto& check : checks) event.checks.push_back(row_of(check));
  if (passed(checks)) {
    log_.event(std::move(event));
    return gate_.stop_asked() ? Flow::stop : Flow::go_on;
  }
  const auto what = failures(event.checks);
  auto reason = setup_.despite;
  if (reason.empty() && !gate_.stop_asked()) reason = gate_.reason_to_continue({FaultKind::self_test, what});
  event.value = reason.empty() ? "failed" : "failed; continued: " + reason;
  log_.event(std::move(event));
  if (reason.empty() && !gate_.stop_asked()) gate_.stop("the self-test failed: " + what);
  return gate_.stop_asked() ? Flow::stop : Flow::go_on;
}

}  // namespace turnpoint::session
