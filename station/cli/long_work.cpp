#include "station/cli/long_work.hpp"

namespace turnpoint::cli {

void add_progress(Command& command, bool& target) {
  command.add_flag("--progress", target, "Show the progress on standard error even if it is not a terminal");
}

LongWork::LongWork(bool show_progress)
    : progress_(show_progress ? system::ShowProgress::always : system::ShowProgress::on_terminal),
      on_signal_([this](const std::string&) { stop_.request_stop(); }) {}

std::string LongWork::end(Context& context) {
  progress_.clear();
  if (!stop_.stop_requested()) return "";
  context.exit_code = system::StopSignals::exit_status();
  return system::StopSignals::told();
}

}  // namespace turnpoint::cli
