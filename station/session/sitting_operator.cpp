#include <algorithm>
#include <utility>

#include "station/session/rows.hpp"
#include "station/session/sitting.hpp"
#include "station/store/error.hpp"

namespace turnpoint::session {

namespace {

/// The answer that a button chooses: the one of its name, else left is the first, right the second.
std::optional<int> answer_of(const std::string& button, const protocol::Task& task) {
  const auto& choices = task.choices;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].id == button) return static_cast<int>(i);
  const int place = button == "left" ? 0 : button == "right" ? 1 : button == "third" ? 2 : -1;
  return place >= 0 && place < static_cast<int>(choices.size()) ? std::optional(place) : std::nullopt;
}

}  // namespace

/// Does what the operator asks and logs what came of it; a button comes back as the answer that it chooses,
/// or as a mere touch.
Input Sitting::received(Input input) {
  if (input.kind == InputKind::arm) {
    auto refusal = stage_->clear();
    if (!refusal) refusal = stage_->arm();
    input.text = refusal ? "refused: " + terms::describe(*refusal) : "armed";
  }
  if (input.kind == InputKind::disarm) {
    stage_->disarm();
    input.text = "disarmed";
  }
  log(input);
  if (input.kind == InputKind::note && !input.text.empty()) keep([&] { log_.annotate(input.text); });
  if (input.kind != InputKind::button) return input;
  const auto& names = stage_->buttons();
  const auto index = static_cast<std::size_t>(input.value);
  const auto answer = setup_.protocol.task.device != protocol::Device::touch && index < names.size()
                          ? answer_of(names[index], setup_.protocol.task)
                          : std::nullopt;
  input.kind = answer ? InputKind::answer : InputKind::touch_down;
  input.value = answer.value_or(0);
  return input;
}

/// Remembers what has to be acted on once the trial or page is over.
void Sitting::note(const Input& input) {
  switch (input.kind) {
    case InputKind::stop:
      stop_asked_ = true;
      stop_reason_ = input.text.empty() ? "stopped by the participant or the operator" : input.text;
      break;
    case InputKind::failure:
      stop_asked_ = true;
      stop_reason_ = input.text;
      break;
    case InputKind::pause:
      pause_asked_ = true;
      break;
    case InputKind::fault:
      fault_ = Fault{input.fault, input.text};
      break;
    case InputKind::disarm:
      fault_ = Fault{FaultKind::disarmed, ""};
      break;
    default:
      break;
  }
}

/// Makes rows durable before the session goes on. On a full disk the screen says so, nothing sounds, and the
/// same rows are written once there is space; what the operator does meanwhile is kept in memory.
void Sitting::keep(const std::function<void()>& write) {
  for (;;) {
    std::string detail;
    try {
      return write();
    } catch (const store::StoreError& error) {
      // Nobody stands before a simulated session who could make space.
      if (error.fault() != store::Fault::disk_full || !setup_.observer.empty()) throw;
      detail = error.what();
    }
    if (!space_again(detail)) throw store::StoreError(store::Fault::disk_full, detail);
  }
}

/// Until somebody says that there is space again (true), or gives up (false).
bool Sitting::space_again(const std::string& detail) {
  stage_->close_amplifier();
  show(pages_.fault(FaultKind::disk_full, detail, director_));
  while (auto input = stage_->wait_until(kForever)) {
    log(*input);
    note(*input);
    if (input->kind == InputKind::stop || input->kind == InputKind::failure) return false;
    if (input->kind == InputKind::next) return true;
  }
  return false;
}

bool Sitting::armed() const {
  const auto state = stage_->amplifier();
  return state == drive::AmplifierState::armed || state == drive::AmplifierState::enabled;
}

/// Holds until the operator has armed the amplifier; nothing sounds before.
Sitting::Flow Sitting::until_armed(const Fault& why) {
  auto page = pages_.fault(why.kind, why.detail, director_);
  while (!armed()) {
    page.amplifier = drive::name(stage_->amplifier());
    show(page);
    auto waited = stage_->wait_until(kForever);
    if (!waited) continue;
    const auto input = received(std::move(*waited));
    note(input);
    if (stop_asked_) return Flow::stop;
    if (input.kind == InputKind::fault) page = pages_.fault(input.fault, input.text, director_);
    if (input.kind == InputKind::arm && !armed()) page.detail = input.text;
  }
  fault_.reset();  // whatever came meanwhile was on the page
  return Flow::go_on;
}

/// After a fault: the screen says what happened; the operator mends it, clears and arms; then it goes on. Who
/// goes on too early sees what is still missing.
Sitting::Flow Sitting::recover() {
  stage_->close_amplifier();
  while (const auto what = std::exchange(fault_, std::nullopt)) {
    auto page = pages_.fault(what->kind, what->detail, director_);
    if (!armed()) {
      if (until_armed(*what) == Flow::stop) return Flow::stop;
      page = pages_.paused(director_);
    }
    if (show_and_wait(page, 0) == Flow::stop) return Flow::stop;
    if (const auto missing = stage_->missing(); !missing.empty())
      fault_ = Fault{FaultKind::lines_gone, missing};
  }
  return Flow::go_on;
}

/// A limit of the rig ends the session. The page says which one before the summary is shown.
Sitting::Flow Sitting::end_at_limit(const std::string& what) {
  stage_->close_amplifier();
  Input fault;
  fault.time_ns = stage_->now_ns();
  fault.kind = InputKind::fault;
  fault.fault = FaultKind::limits;
  fault.text = what;
  log(fault);
  show(pages_.fault(FaultKind::limits, what, director_));
  for (auto over = false; !over;) {
    const auto input = stage_->wait_until(kForever);
    if (!input) continue;
    log(*input);
    over =
        input->kind == InputKind::next || input->kind == InputKind::stop || input->kind == InputKind::failure;
  }
  stop_asked_ = true;
  stop_reason_ = what;
  return Flow::stop;
}

void Sitting::log(const Input& input) {
  if (input.kind != InputKind::heard) log_.event(event_row(input, trial_index_));
}

}  // namespace turnpoint::session
