#include "station/maintenance/panel_latency.hpp"

#include <filesystem>
#include <utility>

#include "station/core/texts.hpp"
#include "station/io/buttons.hpp"
#include "station/io/touch_reader.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/rig/apply.hpp"
#include "station/session/open_touch.hpp"

namespace turnpoint::maintenance {

using core::phrase;

namespace {

std::optional<rig::Calibration> in_force(const rig::Rig& rig, const std::string& path) {
  if (path.empty()) return std::nullopt;
  auto newest = rig::load_calibration(path);
  return rig::problems(newest, rig.sha256, rig::today()).empty() ? std::optional(newest) : std::nullopt;
}

}  // namespace

LatencyDevices::LatencyDevices(const rig::Rig& rig, OnEdge on_edge) {
  if (!rig.buttons_uri || *rig.buttons_uri == "sim:")
    throw core::Refusal(
        phrase("refusal.no_button_lines",
               {rig.buttons_uri ? core::plain(*rig.buttons_uri) : phrase("refusal.buttons_absent")}));
  touch_ = session::open_touch(rig, [](io::TouchPanelState) {});
  io::ButtonsHandlers handlers;
  handlers.press = [edge = std::move(on_edge)](const io::Press& press) { edge(press.time_ns); };
  buttons_ = io::open_buttons(io::ButtonsConfig{*rig.buttons_uri}, std::nullopt, std::move(handlers));
}

LatencyDevices::~LatencyDevices() = default;

std::optional<std::int64_t> LatencyDevices::claim(double x, double y, std::int64_t seen_ns) {
  return touch_ ? touch_->claim(x, y, seen_ns) : std::nullopt;
}

rig::Calibration known_calibration(const rig::Rig& rig, const std::string& out) {
  const bool continued = !out.empty() && std::filesystem::exists(out);
  const auto found = in_force(rig, continued ? out : rig::newest_for(rig.path));
  if (continued && !found) throw core::Refusal(phrase("refusal.other_calibration", {core::plain(out)}));
  auto made = found.value_or(rig::Calibration{});
  if (made.rig_sha256.empty()) {
    made.rig_name = rig.name;
    made.rig_sha256 = rig.sha256;
    made.made_on = rig::today();
  }
  return made;
}

rig::Calibration with_panel(const rig::Rig& rig, const rig::PanelLatency& measured, const std::string& out) {
  auto made = known_calibration(rig, out);
  auto panel = measured;
  panel.made_on = rig::today();
  if (made.panel && made.panel->quality == panel.quality) {
    if (!panel.touch) panel.touch = made.panel->touch;
    if (!panel.flash) panel.flash = made.panel->flash;
  }
  made.panel = panel;
  return made;
}

std::string keep_panel(const rig::Rig& rig, const rig::PanelLatency& measured) {
  const auto file = rig::file_for(rig.path, rig::today());
  write_calibration(with_panel(rig, measured), rig, file);
  return file;
}

void keep_devices(const rig::Rig& rig, rig::Calibration& made, const std::string& out) {
  const auto known = known_calibration(rig, out);
  made.panel = known.panel;
  made.pick_ups = known.pick_ups;
  made.forces = known.forces;
  if (!made.pick_ups.empty() || made.forces) made.mixer = known.mixer;
}

}  // namespace turnpoint::maintenance
