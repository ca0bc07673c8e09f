#include "station/session/devices.hpp"

#include <fmt/format.h>

#include <utility>

#include "station/panel/amplifier.hpp"
#include "station/panel/guard.hpp"

namespace turnpoint::session {

static_assert(2e9 * rig::longest_period_s <= static_cast<double>(panel::Guard::Config{}.audio_timeout_ns),
              "the guard must not miss the sign of a period that a rig may have");

panel::PanelHandlers handlers_for(Inputs& inputs) {
  const auto stamped = [](std::int64_t time_ns, InputKind kind) {
    Input input;
    input.time_ns = time_ns;
    input.kind = kind;
    input.quality = TimeQuality::kernel;
    return input;
  };
  panel::PanelHandlers handlers;
  handlers.press = [&inputs, stamped](const panel::Press& press) {
    Input input = stamped(press.time_ns, InputKind::button);
    input.value = press.button;
    inputs.push(std::move(input));
  };
  handlers.touch = [&inputs, stamped](const panel::Touch& touch) {
    Input input = stamped(touch.time_ns, InputKind::contact);
    input.value = touch.on ? 1 : 0;
    input.number = touch.position.value_or(-1);
    inputs.push(std::move(input));
  };
  handlers.glitch = [&inputs, stamped](const panel::Glitch& glitch) {
    Input input = stamped(glitch.time_ns, InputKind::glitch);
    input.text = fmt::format("{}: edges {}, over {:.3f} ms", glitch.line, glitch.edges,
                             1e-6 * static_cast<double>(glitch.length_ns));
    if (glitch.untold > 0) input.text += fmt::format("; {} more before it", glitch.untold);
    inputs.push(std::move(input));
  };
  handlers.fault = [&inputs, stamped](const panel::PanelFault& fault) {
    Input input = stamped(fault.time_ns, InputKind::fault);
    if (fault.kind == panel::PanelFault::Kind::gone) input.fault = FaultKind::lines_gone;
    input.text = "panel: " + fault.what;
    inputs.push(std::move(input));
  };
  handlers.back = [&inputs, stamped](std::int64_t time_ns) {
    Input input = stamped(time_ns, InputKind::notice);
    input.text = "panel: what had gone is back";
    inputs.push(std::move(input));
  };
  return handlers;
}

Devices open_devices(const rig::Rig& rig, Inputs& inputs) {
  Devices devices;
  devices.amplifier = panel::open_amplifier(rig.amplifier_uri);
  if (!rig.buttons_uri && !rig.contact_uri) return devices;
  std::optional<panel::ButtonsConfig> buttons;
  std::optional<panel::ContactConfig> contact;
  if (rig.buttons_uri) buttons = panel::ButtonsConfig{*rig.buttons_uri};
  if (rig.contact_uri) contact = panel::ContactConfig{*rig.contact_uri};
  devices.panel = panel::open_panel(buttons, contact, handlers_for(inputs));
  return devices;
}

}  // namespace turnpoint::session
