#include "station/session/sitting.hpp"

#include <algorithm>
#include <utility>

#include "station/session/rows.hpp"

namespace turnpoint::session {

namespace {

// A button that was pressed before anybody can have read a page does not turn it.
constexpr std::int64_t kReading_ns = 500'000'000;

}  // namespace

Sitting::Sitting(const Setup& setup, Director director, store::SessionLog log, std::unique_ptr<Stage> stage,
                 FingerAccount account, Display* display, Monitor* monitor)
    : setup_(setup),
      log_(std::move(log)),
      stage_(std::move(stage)),
      account_(std::move(account)),
      display_(display),
      monitor_(monitor),
      plans_(setup.rig, setup.protocol, log_.session().start.seed),
      director_(std::move(director)),
      pages_(setup),
      trial_index_(log_.session().trials) {
  summary_.session_id = log_.session().session_id;
  summary_.participant = setup.participant;
  summary_.protocol_id = setup.protocol.id;
  summary_.database = setup.database;
  summary_.run_mode = store::name(setup.run_mode);
  summary_.realtime_rights = stage_->realtime_rights();
  summary_.seed = log_.session().start.seed;
}

Summary Sitting::run() {
  started_ns_ = stage_->now_ns();
  // A pilot without an amplifier has nothing that an operator could arm.
  if (setup_.run_mode != terms::RunMode::live && setup_.rig.amplifier_uri == "sim:")
    static_cast<void>(stage_->arm());  // a refusal shows below: it is not armed
  if (until_armed({FaultKind::disarmed, ""}) == Flow::go_on)
    while (director_.block() != nullptr)
      if (run_block() == Flow::stop) break;
  if (stop_asked_)
    finish(store::SessionStatus::interrupted, stop_reason_);
  else if (!director_.ended_because().empty())
    finish(store::SessionStatus::stopped, director_.ended_because());
  else
    finish(store::SessionStatus::completed, "");
  show(pages_.end(summary_, director_));
  stage_->finish();
  return summary_;
}

Sitting::Flow Sitting::run_block() {
  const auto block = *director_.block();
  keep([&] { log_.begin_block(block_start(block, director_.block_index(), director_.attempt())); });
  const auto first = director_.next();
  if (first) plans_.begin(*first);
  auto page = director_.attempt() > 0 && block.practice ? pages_.practice_again(block, director_)
                                                        : pages_.instructions(block, director_);
  if (first) pages_.add_mark(page, *first);
  if (show_and_wait(std::move(page), 0) == Flow::stop) return Flow::stop;
  int trials = 0;
  while (const auto spec = director_.next()) {
    if (run_trial(*spec) == Flow::stop) return Flow::stop;
    ++trials;
    if (rest_if_due(trials) == Flow::stop) return Flow::stop;
  }
  for (auto& e : director_.estimates()) summary_.estimates.push_back(std::move(e));
  ++summary_.blocks;
  director_.finish_block();
  return Flow::go_on;
}

Sitting::Flow Sitting::rest_if_due(int trials) {
  const auto& block = *director_.block();
  if (!block.break_after || trials % block.break_after->trials != 0) return Flow::go_on;
  if (!director_.next()) return Flow::go_on;  // nothing follows that a break could divide
  return show_and_wait(pages_.rest(block, block.break_after->min_s, director_), block.break_after->min_s);
}

Sitting::Flow Sitting::show_and_wait(Page page, double at_least_s) {
  const auto earliest = stage_->now_ns() + static_cast<std::int64_t>(at_least_s * 1e9);
  show(page);
  while (stage_->now_ns() < earliest)
    if (auto waited = stage_->wait_until(earliest)) {
      const auto input = received(std::move(*waited));
      if (handle_on_page(input) == Flow::stop) return Flow::stop;
      if (input.kind != InputKind::fault && input.kind != InputKind::disarm) continue;
      page.remaining_s = std::max(0.0, 1e-9 * static_cast<double>(earliest - stage_->now_ns()));
      show(page);
    }
  if (at_least_s > 0) {
    page.remaining_s = 0;
    show(page);
  }
  const bool buttons_turn = page.kind == PageKind::instructions || page.kind == PageKind::rest;
  const auto read_ns = stage_->now_ns() + kReading_ns;
  while (auto waited = stage_->wait_until(kForever)) {
    const auto input = received(std::move(*waited));
    if (handle_on_page(input) == Flow::stop) return Flow::stop;
    if (input.kind == InputKind::next) return Flow::go_on;
    if (buttons_turn && input.kind == InputKind::answer && input.time_ns >= read_ns) return Flow::go_on;
    if (input.kind != InputKind::fault && input.kind != InputKind::disarm) continue;
    // It has been mended, and whoever did so has pressed Continue: for the fault before it too.
    if (page.kind == PageKind::fault || page.kind == PageKind::paused) return Flow::go_on;
    show(page);
  }
  return Flow::go_on;
}

/// What concerns every page: somebody stops, or something fails and the operator has to mend it.
Sitting::Flow Sitting::handle_on_page(const Input& input) {
  note(input);
  if (stop_asked_) return Flow::stop;
  return fault_ ? recover() : Flow::go_on;
}

void Sitting::show(const Page& page) {
  if (display_ != nullptr) display_->show(page);
}

void Sitting::finish(store::SessionStatus status, const std::string& reason) {
  summary_.status = status;
  summary_.reason = reason;
  summary_.duration_s = static_cast<double>(stage_->now_ns() - started_ns_) * 1e-9;
  if (scored_ > 0) summary_.accuracy = static_cast<double>(right_) / scored_;
  keep([&] { log_.finish(status, reason); });
  summary_.checksum = log_.session().checksum;
}

}  // namespace turnpoint::session
