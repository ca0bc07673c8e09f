#include "station/cli/operator_console.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <optional>
#include <ostream>
#include <utility>

#include "station/cli/run.hpp"
#include "station/session/programs.hpp"
#include "station/system/clocks.hpp"
#include "station/system/stop_signals.hpp"
#include "station/trial/question.hpp"

namespace turnpoint::cli {
namespace {

using session::PageKind;
namespace input = session::input;

/// What the operator has typed: a word and, after a space, the rest of the line.
std::optional<input::Any> command_of(const std::string& word, const std::string& rest) {
  if (word == "arm") return input::Arm{};
  if (word == "disarm") return input::Disarm{};
  if (word == "next") return input::Next{};
  if (word == "pause") return input::Pause{};
  if (word == "repeat") return input::Repeat{};
  if (word == "stop") return input::Stop{};
  if (word == "note") return input::Note{rest};
  return std::nullopt;
}

const char* name(PageKind kind) {
  switch (kind) {
    case PageKind::instructions:
      return "instructions: press a button or type next";
    case PageKind::cue:
      return "get ready";
    case PageKind::stimulus:
      return "stimulus";
    case PageKind::pause:
      return "gap";
    case PageKind::response:
      return "response: a button";
    case PageKind::confidence:
      return "confidence: on the screen";
    case PageKind::question:
    case PageKind::line:
    case PageKind::number:
      return "answer on the screen";
    case PageKind::explanation:
      return "explanation: read it on the screen, or type next";
    case PageKind::feedback:
      return "feedback";
    case PageKind::interval:
      return "interval";
    case PageKind::rest:
      return "rest: press a button or type next";
    case PageKind::adjust:
      return "adjust";
    case PageKind::fault:
      return "fault";
    case PageKind::paused:
      return "paused: type next or stop";
    case PageKind::end:
      return "end";
    case PageKind::failed:
      return "failed";
  }
  return "";
}

/// What the operator can type on the page of a fault.
std::string what_continues(const session::Page& page) {
  if (page.fault.kind == session::FaultKind::self_test)
    return "; note REASON continues, stop ends the session";
  if (page.fault.kind == session::FaultKind::limits) return "; next ends the session";
  return page.amplifier.empty() ? "; next continues" : "; amplifier " + page.amplifier + ": arm or stop";
}

}  // namespace

OperatorConsole::OperatorConsole(const rig::Rig& rig, session::Inputs& inputs, std::ostream& messages)
    : buttons_simulated_(rig.buttons_uri == "sim:"),
      contact_simulated_(rig.contact_uri == "sim:"),
      inputs_(inputs),
      messages_(messages) {
  say("operator, type: arm | disarm | next | pause | repeat | stop | note TEXT");
  reader_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void OperatorConsole::show(const session::Page& page) {
  std::string text = name(page.kind);
  if (page.kind == PageKind::fault) {
    text += ": " + page.text + (page.fault.detail.empty() ? "" : " (" + page.fault.detail + ")");
    text += what_continues(page);
  }
  if (page.kind == PageKind::feedback && page.correct) text += *page.correct ? ": right" : ": wrong";
  if (text == std::exchange(last_, text)) return;
  say(text);
}

void OperatorConsole::say(const std::string& text) {
  const std::lock_guard lock(writing_);
  messages_ << text << std::endl;  // flush at once: somebody may be waiting for this line
}

void OperatorConsole::run(const std::stop_token& stop) {
  std::string line;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  while (!stop.stop_requested()) {
    if (::poll(&input, 1, 100) <= 0) continue;
    char letter = 0;
    // standard input was closed, so there is no operator; the session continues
    if (::read(STDIN_FILENO, &letter, 1) != 1) return;
    if (letter == '\n')
      take(std::exchange(line, ""));
    else
      line += letter;
  }
}

std::optional<input::Any> OperatorConsole::simulated(const std::string& line) const {
  const char* const buttons[] = {"left", "right", "third"};
  for (int k = 0; k < 3 && buttons_simulated_; ++k)
    if (line == buttons[k]) return input::Button{k};
  if (contact_simulated_ && line == "finger on") return input::Contact{true, {}};
  if (contact_simulated_ && line == "finger off") return input::Contact{false, {}};
  return std::nullopt;
}

void OperatorConsole::take(const std::string& line) {
  if (line.empty()) return;
  const auto now_ns = system::monotonic_ns();
  const auto space = line.find(' ');
  auto typed =
      command_of(line.substr(0, space), space == std::string::npos ? std::string() : line.substr(space + 1));
  if (!typed) typed = simulated(line);
  if (!typed)
    return say("\"" + line + "\" is not a command; type arm, disarm, next, pause, repeat, stop or note TEXT");
  inputs_.push({now_ns, std::move(*typed)});
}

void run_without_screen(Context& context, const session::Setup& setup) {
  // Ctrl-C also ends the program that reads our messages through a pipe. If SIGPIPE were not ignored, our
  // next message would then end the session.
  ::signal(SIGPIPE, SIG_IGN);
  session::Inputs inputs;
  const system::OnStopSignal on_signal([&inputs](const std::string& signal) {
    inputs.push(
        {system::monotonic_ns(), input::Stop{"the program was stopped by a signal (" + signal + ")"}});
  });
  if (!setup.observer.empty()) {
    if (!session::is_program(setup.observer))
      for (const auto& note :
           trial::observer_notes(setup.protocol, simulation::Observer{simulation::parse(setup.observer)}))
        fmt::print(context.err, "note: {}\n", core::format(note));
    return show_summary(context, session::run(setup, nullptr, inputs));
  }
  OperatorConsole console(setup.rig, inputs, context.err);
  show_summary(context, session::run(setup, &console, inputs), " --headless");
}

}  // namespace turnpoint::cli
