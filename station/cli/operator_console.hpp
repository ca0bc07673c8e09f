#pragma once
#include <iosfwd>
#include <mutex>
#include <string>
#include <thread>

#include "station/rig/rig.hpp"
#include "station/session/inputs.hpp"
#include "station/session/page.hpp"

namespace turnpoint::cli {

/// The operator's side of a session without a screen: what happens is written line by line, and lines typed
/// on standard input act: arm, disarm, next, pause, repeat, stop, note TEXT. On simulated buttons and a
/// simulated contact so do left, right, third, finger on and finger off.
class OperatorConsole : public session::Display {
 public:
  /// Begins to read standard input; both must outlive it.
  OperatorConsole(const rig::Rig& rig, session::Inputs& inputs, std::ostream& messages);

  void show(const session::Page& page) override;

 private:
  void run(const std::stop_token& stop);
  void take(const std::string& line);
  bool simulate(const std::string& line, session::Input& input) const;
  void say(const std::string& text);

  bool buttons_simulated_, contact_simulated_;
  session::Inputs& inputs_;
  std::ostream& messages_;
  std::mutex writing_;
  std::string last_;     ///< session thread only: what was said of the page before
  std::jthread reader_;  // last: joined before what it uses goes
};

}  // namespace turnpoint::cli
