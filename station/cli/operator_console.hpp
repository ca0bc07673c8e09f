#pragma once
#include <iosfwd>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "station/cli/command.hpp"
#include "station/rig/rig.hpp"
#include "station/session/inputs.hpp"
#include "station/session/page.hpp"
#include "station/session/session.hpp"

namespace turnpoint::cli {

/// The operator's console of a session without a screen. It prints events line by line. Lines typed on
/// standard input are commands: arm, disarm, next, pause, repeat, stop, note TEXT. With simulated buttons and
/// contact there are also left, right, third, finger on and finger off.
class OperatorConsole : public session::Display {
 public:
  /// Starts reading standard input. Both references must outlive this object.
  OperatorConsole(const rig::Rig& rig, session::Inputs& inputs, std::ostream& messages);

  void show(const session::Page& page) override;

 private:
  void run(const std::stop_token& stop);
  void take(const std::string& line);
  std::optional<session::input::Any> simulated(const std::string& line) const;
  void say(const std::string& text);

  bool buttons_simulated_, contact_simulated_;
  session::Inputs& inputs_;
  std::ostream& messages_;
  std::mutex writing_;
  std::string last_;  ///< last message printed about a page; used by the session thread only
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread reader_;
};

/// Runs a session without a screen, with a person or a simulated observer, to its end and prints its summary.
/// The first SIGTERM, SIGINT or SIGHUP ends the session like the operator's stop (a simulated session at its
/// next trial). A second signal of the same kind ends the process at once.
void run_without_screen(Context& context, const session::Setup& setup);

}  // namespace turnpoint::cli
