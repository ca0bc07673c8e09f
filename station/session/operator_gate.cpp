#include "station/session/operator_gate.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"
#include "station/session/rows.hpp"
#include "station/store/error.hpp"

namespace turnpoint::session {

namespace {

// Ignore a button press within this time after a page has appeared, because nobody can have read the page
// yet.
constexpr std::int64_t kReading_ns = 500'000'000;

/// Returns the answer that a button chooses. If an answer has the button's name, the button chooses that
/// answer. Otherwise the left button chooses the first answer, the right button the second, and the third
/// button the third.
std::optional<int> answer_of(const std::string& button, const protocol::Task& task) {
  if (const auto named = protocol::answer_index(task, button)) return named;
  const int place = button == "left" ? 0 : button == "right" ? 1 : button == "third" ? 2 : -1;
  return place >= 0 && place < protocol::answer_count(task) ? std::optional(place) : std::nullopt;
}

/// True if the button asks for the intervals again: the third one, if it is no answer.
bool asks_again(const std::string& button, const protocol::Task& task) {
  return task.again > 0 && button == "third" && !answer_of(button, task);
}

}  // namespace

OperatorGate::OperatorGate(const Setup& setup, const Pages& pages, const trial::Director& director,
                           Stage& stage, store::SessionLog& log, Display* display)
    : setup_(setup), pages_(pages), director_(director), stage_(stage), log_(log), display_(display) {}

Input OperatorGate::received(Input input) {
  if (auto* arm = std::get_if<input::Arm>(&input.content)) {
    auto refusal = stage_.clear();
    if (!refusal) refusal = stage_.arm();
    arm->result = refusal ? "refused: " + core::describe(*refusal) : "armed";
  }
  if (auto* disarm = std::get_if<input::Disarm>(&input.content)) {
    stage_.disarm();
    disarm->result = "disarmed";
  }
  log(input);
  if (const auto* note = input.as<input::Note>(); note && !note->text.empty())
    keep([&] { log_.annotate(note->text); });
  const auto* button = input.as<input::Button>();
  if (!button) return input;
  const auto& names = stage_.buttons();
  const auto index = static_cast<std::size_t>(button->index);
  const auto& task = protocol::of_task(setup_.protocol, director_.task()).task;
  const bool counts = task.device != protocol::Device::touch && index < names.size();
  const auto answer = counts ? answer_of(names[index], task) : std::nullopt;
  if (answer)
    input.content = input::Answer{*answer};
  else if (counts && asks_again(names[index], task))
    input.content = input::Again{};
  else
    input.content = input::Touch{};
  return input;
}

void OperatorGate::note(const Input& input) {
  if (const auto* stopped = input.as<input::Stop>()) {
    quitting_ = quitting_ || !stopped->by.empty();
    stop(stopped->by.empty() ? core::kStoppedReason : stopped->by);
  }
  if (const auto* failure = input.as<input::Failure>()) stop(failure->what);
  if (input.is<input::Pause>()) pause_asked_ = true;
  if (const auto* fault = input.as<Fault>()) fault_ = *fault;
  if (input.is<input::Disarm>()) fault_ = Fault{FaultKind::disarmed, ""};
}

void OperatorGate::keep(const std::function<void()>& write) {
  for (;;) {
    std::string detail;
    try {
      return write();
    } catch (const store::StoreError& error) {
      // In a simulated session nobody can free space on the disk, so end the session.
      if (error.kind() != store::ErrorKind::disk_full || !setup_.observer.empty()) throw;
      detail = error.what();
    }
    if (quitting_ || !space_again(detail))
      throw store::StoreError(
          store::ErrorKind::disk_full,
          fmt::format("{}; the session ended before there was space; trials that are stored: {}; later "
                      "answers are lost; `turnpoint resume` continues the session",
                      detail, log_.session().trials));
  }
}

/// Returns true when somebody has freed disk space and pressed Continue, and false if somebody stops the
/// session.
bool OperatorGate::space_again(const std::string& detail) {
  stage_.close_amplifier();
  show(pages_.fault({FaultKind::disk_full, detail}, director_));
  while (auto input = stage_.wait_until(kForever)) {
    log(*input);
    note(*input);
    if (input->is<input::Stop>() || input->is<input::Failure>()) return false;
    if (input->is<input::Next>()) return true;
  }
  return false;
}

bool OperatorGate::armed() const {
  const auto state = stage_.amplifier();
  return state == audio::AmplifierState::armed || state == audio::AmplifierState::enabled;
}

Flow OperatorGate::until_armed(const Fault& why) {
  auto page = pages_.fault(why, director_);
  while (!armed()) {
    page.amplifier = audio::name(stage_.amplifier());
    show(page);
    auto waited = stage_.wait_until(kForever);
    if (!waited) continue;
    const auto input = received(std::move(*waited));
    note(input);
    if (stop_asked_) return Flow::stop;
    if (const auto* fault = input.as<Fault>()) page = pages_.fault(*fault, director_);
    if (const auto* arm = input.as<input::Arm>(); arm && !armed()) page.fault.detail = arm->result;
  }
  fault_.reset();  // the page has shown all faults that occurred meanwhile, so forget them
  return Flow::go_on;
}

Flow OperatorGate::recover() {
  stage_.close_amplifier();
  while (const auto what = std::exchange(fault_, std::nullopt)) {
    auto page = pages_.fault(*what, director_);
    if (!armed()) {
      if (until_armed(*what) == Flow::stop) return Flow::stop;
      page = pages_.paused(director_);
    }
    if (show_and_wait(page, 0) == Flow::stop) return Flow::stop;
    if (const auto missing = stage_.missing(); !missing.empty())
      fault_ = Fault{FaultKind::lines_gone, missing};
  }
  return Flow::go_on;
}

std::string OperatorGate::reason_to_continue(const Fault& why) {
  if (!setup_.observer.empty()) return "";
  show(pages_.fault(why, director_));
  while (!stop_asked_) {
    auto waited = stage_.wait_until(kForever);
    if (!waited) continue;
    const auto input = received(std::move(*waited));
    if (const auto* reason = input.as<input::Note>(); reason && !reason->text.empty()) return reason->text;
    note(input);
  }
  // Clear the request: the caller ends the session with stop() and gives the reason.
  stop_asked_ = false;
  return "";
}

Flow OperatorGate::end_at_limit(const std::string& what) {
  stage_.close_amplifier();
  log({stage_.now_ns(), Fault{FaultKind::limits, what}});
  show(pages_.fault({FaultKind::limits, what}, director_));
  for (auto over = false; !over;) {
    const auto input = stage_.wait_until(kForever);
    if (!input) continue;
    log(*input);
    over = input->is<input::Next>() || input->is<input::Stop>() || input->is<input::Failure>();
  }
  stop(what);
  return Flow::stop;
}

void OperatorGate::show(const Page& page) {
  ++shows_;
  if (page.kind == PageKind::fault || page.kind == PageKind::paused) ++holds_;
  if (display_ != nullptr) display_->show(page);
}

Flow OperatorGate::show_and_wait(Page page, double at_least_s) {
  if (page.kind == PageKind::paused) pause_asked_ = false;
  auto shown_ns = stage_.now_ns();
  const auto earliest = shown_ns + static_cast<std::int64_t>(at_least_s * 1e9);
  show(page);
  while (stage_.now_ns() < earliest)
    if (auto waited = stage_.wait_until(earliest)) {
      const int shows = shows_;
      if (interrupt(page, received(std::move(*waited))) == Flow::stop) return Flow::stop;
      if (shows_ == shows) continue;
      page.remaining_s = std::max(0.0, 1e-9 * static_cast<double>(earliest - stage_.now_ns()));
      show(page);
    }
  if (at_least_s > 0) {
    page.remaining_s = 0;
    shown_ns = stage_.now_ns();
    show(page);
  }
  const bool holds = page.kind == PageKind::fault || page.kind == PageKind::paused;
  const bool buttons_turn = page.kind == PageKind::instructions || page.kind == PageKind::rest;
  while (auto waited = stage_.wait_until(kForever)) {
    const int shows = shows_;
    const auto input = received(std::move(*waited));
    if (interrupt(page, input) == Flow::stop) return Flow::stop;
    if (shows_ != shows) {
      // Another page has covered this one: a fault, which the operator has now repaired, or a pause. If this
      // page also showed a fault or a pause, it ends too, and is not shown again.
      if (holds) return Flow::go_on;
      shown_ns = stage_.now_ns();
      show(page);
      continue;
    }
    // Ignore a press that was made before this page appeared: it was meant for the previous page.
    if (input.is<input::Next>() && input.time_ns >= shown_ns) return Flow::go_on;
    if (buttons_turn && input.is<input::Answer>() && input.time_ns >= shown_ns + kReading_ns)
      return Flow::go_on;
  }
  return Flow::go_on;
}

Flow OperatorGate::handle_on_page(const Page& page, const Input& input) {
  const int shows = shows_;
  if (interrupt(page, input) == Flow::stop) return Flow::stop;
  if (shows_ != shows) show(page);
  return Flow::go_on;
}

/// Lets a stop, a pause or a fault interrupt the page that is shown.
Flow OperatorGate::interrupt(const Page& page, const Input& input) {
  const bool paused = page.kind == PageKind::paused;
  note(input);
  if (stop_asked_) return Flow::stop;
  if (paused) pause_asked_ = fault_.has_value();  // the pause continues after the fault
  if (fault_) return recover();
  return page.kind == PageKind::fault ? Flow::go_on : pause_if_asked();
}

Flow OperatorGate::until_clear() {
  while (!stop_asked_) {
    if (pause_if_asked() == Flow::stop) return Flow::stop;
    if (!fault_ && armed()) break;
    if (!fault_) fault_ = Fault{FaultKind::disarmed, ""};
    if (recover() == Flow::stop) return Flow::stop;
  }
  return stop_asked_ ? Flow::stop : Flow::go_on;
}

void OperatorGate::stop(const std::string& reason) {
  stop_asked_ = true;
  stop_reason_ = reason;
}

Flow OperatorGate::pause_if_asked() {
  while (pause_asked_)
    if (show_and_wait(pages_.paused(director_), 0) == Flow::stop) return Flow::stop;
  return Flow::go_on;
}

void OperatorGate::log(const Input& input) {
  if (!input.is<input::Heard>()) log_.event(event_row(input, log_.session().trials));
}

}  // namespace turnpoint::session
