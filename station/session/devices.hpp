#pragma once
#include <memory>

#include "station/drive/amplifier.hpp"
#include "station/panel/buttons.hpp"
#include "station/rig/rig.hpp"
#include "station/session/inputs.hpp"

namespace turnpoint::session {

/// What a real session has beside its stream. The panel may be null (no buttons, no contact).
struct Devices {
  std::unique_ptr<drive::Amplifier> amplifier;
  std::unique_ptr<panel::Panel> panel;
};

/// Opens what the rig names: lines by name, the amplifier disarmed and off. `sim:` has the same guard on
/// lines that exist in memory only. Throws panel::LineError, std::system_error, std::invalid_argument.
Devices open_devices(const rig::Rig& rig, Inputs& inputs);

/// Presses, contacts and faults of a panel as inputs of a session, with the kernel's time; `inputs` must
/// outlive the panel.
panel::PanelHandlers handlers_for(Inputs& inputs);

}  // namespace turnpoint::session
