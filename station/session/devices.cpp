#include "station/session/devices.hpp"

#include <fmt/format.h>

#include <utility>

#include "station/io/amplifier.hpp"
#include "station/io/guard.hpp"

namespace turnpoint::session {

static_assert(2e9 * rig::longest_period_s <= static_cast<double>(io::Guard::Config{}.audio_timeout_ns),
              "the guard must wait for at least two of the longest periods that a rig may have");

io::ButtonsHandlers handlers_for(Inputs& inputs) {
  const auto stamped = [](std::int64_t time_ns, InputKind kind) {
    Input input;
    input.time_ns = time_ns;
    input.kind = kind;
    input.quality = TimeQuality::kernel;
    return input;
  };
  io::ButtonsHandlers handlers;
  handlers.press = [&inputs, stamped](const io::Press& press) {
    Input input = stamped(press.time_ns, InputKind::button);
    input.value = press.button;
    inputs.push(std::move(input));
  };
  handlers.contact = [&inputs, stamped](const io::Contact& contact) {
    Input input = stamped(contact.time_ns, InputKind::contact);
    input.value = contact.on ? 1 : 0;
    input.number = contact.position.value_or(-1);
    inputs.push(std::move(input));
  };
  handlers.glitch = [&inputs, stamped](const io::Glitch& glitch) {
    Input input = stamped(glitch.time_ns, InputKind::glitch);
    input.text = fmt::format("{}: {} edges within {:.3f} ms", glitch.line, glitch.edges,
                             1e-6 * static_cast<double>(glitch.length_ns));
    if (glitch.untold > 0)
      input.text += fmt::format("; {} earlier glitches were not reported", glitch.untold);
    inputs.push(std::move(input));
  };
  handlers.fault = [&inputs, stamped](const io::ButtonsFault& fault) {
    Input input = stamped(fault.time_ns, InputKind::fault);
    if (fault.kind == io::ButtonsFault::Kind::gone) input.fault = FaultKind::lines_gone;
    input.text = "panel: " + fault.what;
    inputs.push(std::move(input));
  };
  handlers.back = [&inputs, stamped](std::int64_t time_ns) {
    Input input = stamped(time_ns, InputKind::notice);
    input.text = "panel: the lost device is connected again";
    inputs.push(std::move(input));
  };
  return handlers;
}

Devices open_devices(const rig::Rig& rig, Inputs& inputs) {
  Devices devices;
  devices.amplifier = io::open_amplifier(rig.amplifier_uri);
  if (rig.trigger_lines_uri) devices.triggers = io::open_trigger_lines(*rig.trigger_lines_uri);
  if (rig.sync && !rig.sync->channel) {
    const auto pulse = [&inputs](std::int64_t time_ns) {
      Input input;
      input.time_ns = time_ns;
      input.kind = InputKind::sync;
      input.quality = TimeQuality::kernel;
      inputs.push(std::move(input));
    };
    devices.sync = io::open_sync_line(rig.sync->uri, pulse, handlers_for(inputs));
  }
  if (!rig.buttons_uri && !rig.contact_uri) return devices;
  std::optional<io::ButtonsConfig> buttons;
  std::optional<io::ContactConfig> contact;
  if (rig.buttons_uri) buttons = io::ButtonsConfig{*rig.buttons_uri};
  if (rig.contact_uri) contact = io::ContactConfig{*rig.contact_uri};
  devices.buttons = io::open_buttons(buttons, contact, handlers_for(inputs));
  return devices;
}

}  // namespace turnpoint::session
