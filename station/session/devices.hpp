#pragma once
#include <functional>
#include <memory>

#include "station/drive/alsa_capture.hpp"
#include "station/drive/amplifier.hpp"
#include "station/drive/engine.hpp"
#include "station/iio/converter.hpp"
#include "station/lines/buttons.hpp"
#include "station/lines/sync_line.hpp"
#include "station/lines/trigger_lines.hpp"
#include "station/rig/rig.hpp"
#include "station/session/inputs.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::session {

/// The devices of a real session. `buttons` is null if the rig has neither buttons nor contact. Tests may
/// replace the stream, the capture, the converter of the force cells and the clocks.
struct Devices {
  std::unique_ptr<drive::Amplifier> amplifier;
  std::unique_ptr<lines::Buttons> buttons;
  std::unique_ptr<lines::TriggerLines> triggers;  ///< null if the rig has no lines for trigger codes
  std::unique_ptr<lines::SyncLine> sync;          ///< null if the rig has no line for pulses of other devices
  std::function<std::unique_ptr<drive::Stream>(const drive::StreamConfig&)> open_stream =
      drive::open_realtime;
  std::function<std::unique_ptr<drive::Capture>(const drive::OutputConfig&)> open_capture =
      drive::open_capture;
  std::function<std::unique_ptr<iio::Converter>(const iio::Config&)> open_cells = iio::open;
  std::function<system::Clocks()> clocks = system::read_clocks;
};

/// Opens the rig's devices. Lines are found by name; the amplifier is disarmed and off. If the rig's
/// amplifier is `sim:`, the same guard works on lines that exist only in memory. Throws lines::LineError,
/// std::system_error or terms::UsageError.
Devices open_devices(const rig::Rig& rig, Inputs& inputs);

/// Returns handlers that pass presses, contacts and faults of the buttons to a session, with the kernel's
/// time. `inputs` must outlive the buttons.
lines::ButtonsHandlers handlers_for(Inputs& inputs);

}  // namespace turnpoint::session
