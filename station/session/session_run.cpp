#include "station/session/session_run.hpp"

#include <utility>

#include "station/text/number.hpp"
#include "station/trial/rows.hpp"

namespace turnpoint::session {

SessionRun::SessionRun(const Setup& setup, trial::Director director, store::SessionLog log,
                       const Earlier& earlier, std::unique_ptr<Stage> stage, limits::FingerAccount account,
                       Display* display, Monitor* monitor, programs::Programs* programs)
    : setup_(setup),
      log_(std::move(log)),
      stage_(std::move(stage)),
      account_(std::move(account)),
      display_(display),
      monitor_(monitor),
      programs_(programs),
      plans_(setup.rig, setup.protocol, log_.session().start.seed),
      director_(std::move(director)),
      pages_(setup),
      gate_(setup, pages_, director_, *stage_, log_, display),
      interludes_(setup, pages_, director_, gate_, *stage_, log_,
                  [this](const protocol::Example& example, Page page) {
                    return play_example(example, std::move(page));
                  }),
      guide_(setup.protocol.sensing) {
  interludes_.restore(earlier);
  summary_.session_id = log_.session().session_id;
  summary_.participant = setup.participant;
  summary_.protocol_id = setup.protocol.id;
  summary_.database = setup.database;
  summary_.run_mode = store::name(setup.run_mode);
  summary_.realtime_rights = stage_->realtime_rights();
  summary_.seed = log_.session().start.seed;
  use_measured_friction();
}

Summary SessionRun::run() {
  started_ns_ = stage_->now_ns();
  begin_drift();
  const auto& signal = setup_.protocol.timing.signal;
  if (signal && signal->by == protocol::ResponseSignal::By::flash && setup_.display_latency_s)
    log_.event({started_ns_, records::kDisplayLatencyEvent, text::number(*setup_.display_latency_s, 4), {}});
  // In a pilot session without a real amplifier, nobody has to arm it.
  if (setup_.run_mode != terms::RunMode::live && setup_.rig.amplifier_uri == "sim:")
    // if arming is refused, until_armed() below shows a page
    static_cast<void>(stage_->arm());
  if (gate_.until_armed({FaultKind::disarmed, ""}) == Flow::go_on && pass_self_test() == Flow::go_on)
    static_cast<void>(run_parts());  // the code below finds out why the session ended
  if (!interludes_.ended_because().empty())
    finish(records::SessionStatus::stopped, interludes_.ended_because());
  else if (gate_.stop_asked())
    finish(records::SessionStatus::interrupted, gate_.stop_reason());
  else if (!director_.ended_because().empty())
    finish(records::SessionStatus::stopped, director_.ended_because());
  else
    finish(records::SessionStatus::completed, "");
  gate_.show(pages_.end(summary_, director_));
  stage_->finish();
  return summary_;
}

/// Runs all blocks and all interludes.
Flow SessionRun::run_parts() {
  while (director_.block() != nullptr) {
    // after a block's last trial, a resumed session only has to leave the block
    const bool resumed_at_end = !next_trial();
    if (gate_.stop_asked()) return Flow::stop;
    if (!resumed_at_end && interludes_.before(director_.block_index()) == Flow::stop) return Flow::stop;
    if (run_block() == Flow::stop) return Flow::stop;
  }
  return director_.ended_because().empty() ? interludes_.before(director_.blocks()) : Flow::stop;
}

Flow SessionRun::run_block() {
  const auto block = *director_.block();
  gate_.keep(
      [&] { log_.begin_block(trial::block_start(block, director_.block_index(), director_.attempt())); });
  const auto first = next_trial();
  if (!first) return gate_.stop_asked() ? Flow::stop : leave_block();
  plans_.begin(*first);
  auto page = director_.attempt() > 0 && block.practice ? pages_.practice_again(block, director_)
                                                        : pages_.instructions(block, director_);
  pages_.add_mark(page, *first);
  if (gate_.show_and_wait(std::move(page), 0) == Flow::stop) return Flow::stop;
  int trials = 0;
  while (const auto spec = next_trial()) {
    if (run_trial(*spec) == Flow::stop) return Flow::stop;
    ++trials;
    if (rest_if_due(trials) == Flow::stop) return Flow::stop;
  }
  return gate_.stop_asked() ? Flow::stop : leave_block();
}

Flow SessionRun::leave_block() {
  log_estimates();
  for (auto& e : director_.estimates()) summary_.estimates.push_back(std::move(e));
  for (auto& end : director_.early_ends()) {
    log_.event({stage_->now_ns(), records::kEndedEarlyEvent, texts::say(end, "en"), {}});
    summary_.early_ends.push_back(std::move(end));
  }
  if (director_.block()->kind == protocol::BlockKind::friction_table && finish_friction_table() == Flow::stop)
    return Flow::stop;
  ++summary_.blocks;
  director_.finish_block();
  return Flow::go_on;
}

Flow SessionRun::rest_if_due(int trials) {
  const auto& block = *director_.block();
  if (!block.break_after || trials % block.break_after->trials != 0) return Flow::go_on;
  if (!next_trial()) return Flow::go_on;  // a block's last trial is not followed by a break
  return gate_.show_and_wait(pages_.rest(block, block.break_after->min_s, director_),
                             block.break_after->min_s);
}

void SessionRun::finish(records::SessionStatus status, const std::string& reason) {
  summary_.status = status;
  summary_.reason = reason;
  finish_triggers();
  summary_.duration_s = static_cast<double>(stage_->now_ns() - started_ns_) * 1e-9;
  if (scored_ > 0) summary_.accuracy = static_cast<double>(right_) / scored_;
  gate_.keep([&] { log_.finish(status, reason); });
  summary_.checksum = log_.session().checksum;
}

}  // namespace turnpoint::session
