#include "station/session/devices.hpp"

#include <fmt/format.h>

#include <utility>

#include "station/io/amplifier.hpp"
#include "station/io/guard.hpp"

namespace turnpoint::session {

static_assert(2e9 * rig::longest_period_s <= static_cast<double>(io::Guard::Config{}.audio_timeout_ns),
              "the guard must wait for at least two of the longest periods that a rig may have");

io::ButtonsHandlers handlers_for(Inputs& inputs) {
  constexpr auto kernel = TimeQuality::kernel;
  io::ButtonsHandlers handlers;
  handlers.press = [&inputs](const io::Press& press) {
    inputs.push({press.time_ns, input::Button{press.button}, kernel});
  };
  handlers.contact = [&inputs](const io::Contact& contact) {
    inputs.push({contact.time_ns, input::Contact{contact.on, contact.position}, kernel});
  };
  handlers.glitch = [&inputs](const io::Glitch& glitch) {
    auto what = fmt::format("{}: {} edges within {:.3f} ms", glitch.line, glitch.edges,
                            1e-6 * static_cast<double>(glitch.length_ns));
    if (glitch.untold > 0) what += fmt::format("; {} earlier glitches were not reported", glitch.untold);
    inputs.push({glitch.time_ns, input::Glitch{std::move(what)}, kernel});
  };
  handlers.fault = [&inputs](const io::ButtonsFault& fault) {
    const bool gone = fault.kind == io::ButtonsFault::Kind::gone;
    inputs.push({fault.time_ns,
                 Fault{gone ? FaultKind::lines_gone : FaultKind::other, "panel: " + fault.what}, kernel});
  };
  handlers.back = [&inputs](std::int64_t time_ns) {
    inputs.push({time_ns, input::Notice{"panel: the lost device is connected again"}, kernel});
  };
  return handlers;
}

Devices open_devices(const rig::Rig& rig, Inputs& inputs) {
  Devices devices;
  devices.amplifier = io::open_amplifier(rig.amplifier_uri);
  if (rig.trigger_lines_uri) devices.triggers = io::open_trigger_lines(*rig.trigger_lines_uri);
  if (rig.sync && !rig.sync->channel) {
    const auto pulse = [&inputs](std::int64_t time_ns) {
      inputs.push({time_ns, input::Sync{}, TimeQuality::kernel});
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
