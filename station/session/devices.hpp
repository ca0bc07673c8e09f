#pragma once
#include <functional>
#include <memory>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/amplifier.hpp"
#include "station/audio/engine.hpp"
#include "station/io/buttons.hpp"
#include "station/io/converter.hpp"
#include "station/io/sync_line.hpp"
#include "station/io/trigger_lines.hpp"
#include "station/rig/rig.hpp"
#include "station/session/inputs.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::session {

/// The devices of a real session. `buttons` is null if the rig has neither buttons nor contact. Tests may
/// replace the stream, the capture, the converter of the force cells and the clocks.
struct Devices {
  std::unique_ptr<audio::Amplifier> amplifier;
  std::unique_ptr<io::Buttons> buttons;
  std::unique_ptr<io::TriggerLines> triggers;  ///< null if the rig has no lines for trigger codes
  std::unique_ptr<io::SyncLine> sync;          ///< null if the rig has no line for pulses of other devices
  std::function<std::unique_ptr<audio::Stream>(const audio::StreamConfig&)> open_stream =
      audio::open_realtime;
  std::function<std::unique_ptr<audio::Capture>(const audio::OutputConfig&)> open_capture =
      audio::open_capture;
  std::function<std::unique_ptr<io::Converter>(const io::Config&)> open_cells = io::open;
  std::function<system::Clocks()> clocks = system::read_clocks;
};

/// Opens the rig's devices. Lines are found by name; the amplifier is disarmed and off. If the rig's
/// amplifier is `sim:`, the same guard works on lines that exist only in memory. Throws io::LineError,
/// std::system_error or core::UsageError.
Devices open_devices(const rig::Rig& rig, Inputs& inputs);

/// Returns handlers that pass presses, contacts and faults of the buttons to a session, with the kernel's
/// time. `inputs` must outlive the buttons.
io::ButtonsHandlers handlers_for(Inputs& inputs);

}  // namespace turnpoint::session
