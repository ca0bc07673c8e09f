#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "station/audio/amplifier.hpp"
#include "station/io/simulated_lines.hpp"
#include "station/rig/rig.hpp"
#include "station/session/self_test.hpp"
#include "station/session/stage.hpp"

namespace turnpoint::session {

/// A button that somebody is asked to press and release during the self-test.
struct Request {
  enum class Kind { press_stop, release_stop, press_button };
  Kind kind = Kind::press_stop;
  int button = 0;    ///< index of the response button
  std::string name;  ///< name of the response button
};
/// Puts a request to the operator. The self-test then waits until it is fulfilled.
using AskOperator = std::function<void(const Request&)>;

/// The parts of the station that the self-test uses. Everything that the pointers refer to must outlive the
/// SelfTestRig.
struct SelfTestParts {
  const rig::Rig* rig = nullptr;
  Stage* stage = nullptr;                 ///< the stage under test; it must run in real time
  audio::Amplifier* amplifier = nullptr;  ///< the amplifier of the stage; null if the stage simulates it
  /// The stage with which tones are played and captured: `stage` itself or, in a simulated rig, a stage whose
  /// output goes through a simulated plate back to its capture. Null if the rig captures nothing.
  Stage* room = nullptr;
  std::optional<CaptureSetup> capture;  ///< what `room` captures; empty if it captures nothing
  /// asks the operator; empty if nobody is there, and then no button is tested
  AskOperator ask;
  std::string data_folder;
  std::function<system::Clocks()> clocks = system::read_clocks;
  std::string sensors = "/sys/class/hwmon";
  double longest_press_s = kLongestPress_s;
  /// Receives inputs that the self-test does not use, such as a request to stop the session; may be empty.
  std::function<void(Input)> other = {};
};

/// Makes a SelfTestRig that uses these parts. The amplifier is armed if it is not yet, so call this only if
/// an operator has asked for the self-test. The surface vibrates quietly; nobody should touch it meanwhile.
/// Afterwards the amplifier is off, and still armed unless somebody has disarmed it.
std::unique_ptr<SelfTestRig> self_test_rig(SelfTestParts parts);

/// Opens the rig's devices, runs the self-test on them and closes them. Without an `ask`, no button is
/// tested. Throws what open_devices() and real_stage() throw.
std::vector<Check> self_test(const rig::Rig& rig, const AskOperator& ask, const std::string& data_folder);

/// Faults of a simulated rig, for tests. Each function changes one part before the self-test.
struct SimulatedFaults {
  std::function<void(io::SimulatedAmplifierLines&)> lines;
  std::function<void(SimulatedRoom&)> room;
  std::function<void(simulation::Setup&)> laboratory;
  bool stop_disconnected = false, button_disconnected = false;
  std::function<system::Clocks()> clocks = system::read_clocks;
  std::string sensors = "/sys/class/hwmon";
  double longest_press_s = kLongestPress_s;
};

/// Runs the self-test on a rig with a simulated amplifier. A script presses the buttons. Real devices of the
/// rig are not opened.
std::vector<Check> simulated_self_test(const rig::Rig& rig, const std::string& data_folder,
                                       const SimulatedFaults& faults = {});

}  // namespace turnpoint::session
