#include "station/cli/console_session.hpp"

#include <signal.h>

#include <utility>

#include "station/cli/operator_console.hpp"
#include "station/cli/run.hpp"
#include "station/system/clocks.hpp"
#include "station/system/on_stop_signal.hpp"

namespace turnpoint::cli {

namespace {

void stop(session::Inputs& inputs, const std::string& signal) {
  session::Input input;
  input.time_ns = system::monotonic_ns();
  input.kind = session::InputKind::stop;
  input.text = "the program was stopped by a signal (" + signal + ")";
  inputs.push(std::move(input));
}

}  // namespace

void run_without_screen(Context& context, const session::Setup& setup) {
  // Ctrl-C also ends the program that reads our messages through a pipe. If SIGPIPE were not ignored, our
  // next message would then end the session.
  ::signal(SIGPIPE, SIG_IGN);
  session::Inputs inputs;
  const system::OnStopSignal on_signal([&inputs](const std::string& signal) { stop(inputs, signal); });
  if (!setup.observer.empty()) return show_summary(context, session::run(setup, nullptr, inputs));
  OperatorConsole console(setup.rig, inputs, context.err);
  show_summary(context, session::run(setup, &console, inputs), " --headless");
}

}  // namespace turnpoint::cli
