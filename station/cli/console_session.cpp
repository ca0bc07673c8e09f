#include "station/cli/console_session.hpp"

#include <signal.h>

#include <thread>
#include <utility>

#include "station/cli/operator_console.hpp"
#include "station/cli/run.hpp"
#include "station/system/clocks.hpp"
#include "station/system/stop_signals.hpp"

namespace turnpoint::cli {

namespace {

/// While this object exists, the first termination signal stops the session instead of the program.
class StopOnSignal {
 public:
  explicit StopOnSignal(session::Inputs& inputs) {
    signals_.take_over();
    waiter_ = std::jthread([this, &inputs] { stop(inputs, signals_.wait()); });
  }
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;
  ~StopOnSignal() { signals_.release(); }

 private:
  static void stop(session::Inputs& inputs, const std::string& signal) {
    if (signal.empty()) return;
    session::Input input;
    input.time_ns = system::monotonic_ns();
    input.kind = session::InputKind::stop;
    input.text = "the program was stopped by a signal (" + signal + ")";
    inputs.push(std::move(input));
  }

  system::StopSignals signals_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread waiter_;
};

}  // namespace

void run_without_screen(Context& context, const session::Setup& setup) {
  // Ctrl-C also ends the program that reads our messages through a pipe. If SIGPIPE were not ignored, our
  // next message would then end the session.
  ::signal(SIGPIPE, SIG_IGN);
  session::Inputs inputs;
  const StopOnSignal stop(inputs);
  if (!setup.observer.empty()) return show_summary(context, session::run(setup, nullptr, inputs));
  OperatorConsole console(setup.rig, inputs, context.err);
  show_summary(context, session::run(setup, &console, inputs), " --headless");
}

}  // namespace turnpoint::cli
