#include "station/rig/apply.hpp"

#include <time.h>

#include <algorithm>
#include <filesystem>

#include "station/core/number.hpp"
#include "station/core/texts.hpp"

namespace turnpoint::rig {

using core::phrase, core::plain, core::Refusal;

namespace {

void apply(const Calibration::Transducer& measured, Rig& rig) {
  const auto found = std::find_if(rig.transducers.begin(), rig.transducers.end(),
                                  [&](const auto& t) { return t.name == measured.name; });
  if (found == rig.transducers.end()) throw Refusal(phrase("applied.no_transducer", {plain(measured.name)}));
  found->m_per_full_scale.reset();
  found->response.clear();
  for (const auto& point : measured.response.points)
    found->response.push_back({point.frequency_Hz, point.m_per_full_scale, point.phase_rad});
  found->low_Hz = std::max(found->low_Hz, measured.response.low_Hz);
  found->high_Hz = std::min(found->high_Hz, measured.response.high_Hz);
  if (!(found->low_Hz < found->high_Hz))
    throw Refusal(phrase("applied.outside_band",
                         {plain(measured.name), plain(core::number(measured.response.low_Hz * 1e-3)),
                          plain(core::number(measured.response.high_Hz * 1e-3))}));
}

void apply(const PickUpResponse& measured, Rig& rig) {
  auto& capture = rig.capture;
  if (!capture || std::find(capture->pick_ups.begin(), capture->pick_ups.end(), measured.channel) ==
                      capture->pick_ups.end())
    throw Refusal(phrase("applied.no_pick_up", {plain(measured.channel)}));
  if (std::any_of(capture->responses.begin(), capture->responses.end(), [&](const auto& other) {
        return other.channel == measured.channel && other.drive_channel == measured.drive_channel;
      }))
    throw Refusal(phrase("applied.two_responses", {plain(measured.channel), plain(measured.drive_channel)}));
  capture->responses.push_back(measured);
}

void apply(const ForceCells& measured, Rig& rig) {
  if (!rig::has_force_cells(rig)) throw Refusal(phrase("applied.no_force_cells"));
  const bool own_clock = measured.carrier_Hz == 0;
  if (own_clock != rig.capture->converter.has_value())
    throw Refusal(phrase(own_clock ? "applied.forces_by_card" : "applied.forces_by_converter"));
  rig.capture->forces = measured;
}

std::string stem_of(const std::string& rig_path) {
  const std::filesystem::path path(rig_path);
  return (path.parent_path() / path.stem()).string() + ".calibration-";
}

}  // namespace

Rig applied(const Calibration& calibration, Rig rig) {
  for (const auto& transducer : calibration.transducers) apply(transducer, rig);
  for (const auto& pick_up : calibration.pick_ups) apply(pick_up.response, rig);
  if (calibration.forces) apply(*calibration.forces, rig);
  rig.mixer = calibration.mixer;
  if (calibration.quality_factor) {
    // resonances differ as much as the stated value was expected to, in proportion
    rig.surface.quality_factor_sd *= *calibration.quality_factor / rig.surface.quality_factor;
    rig.surface.quality_factor = *calibration.quality_factor;
  }
  if (calibration.boundary) rig.surface.fit = calibration.boundary->surface;
  if (!calibration.friction) return rig;
  rig.friction.stated = rig.friction.measured = true;
  rig.friction.table.clear();
  for (const auto& point : calibration.friction->points)
    rig.friction.table.emplace_back(point.displacement_m, point.relative_friction);
  return rig;
}

std::string file_for(const std::string& rig_path, const std::string& date) {
  return stem_of(rig_path) + date + ".toml";
}

std::string newest_for(const std::string& rig_path) {
  const auto stem = std::filesystem::path(stem_of(rig_path));
  const auto folder = stem.parent_path().empty() ? std::filesystem::path(".") : stem.parent_path();
  const auto begins = stem.filename().string();
  std::string newest;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(folder, unreadable)) {
    const auto name = entry.path().filename().string();
    // Dates of the form YYYY-MM-DD sort in the order of time.
    if (name.starts_with(begins) && name.ends_with(".toml") && name.size() == begins.size() + 15)
      newest = std::max(newest, name);
  }
  return newest.empty() ? "" : (stem.parent_path() / newest).string();
}

std::string today() {
  const auto now = ::time(nullptr);
  tm parts{};
  ::localtime_r(&now, &parts);
  char text[16];
  ::strftime(text, sizeof text, "%Y-%m-%d", &parts);
  return text;
}

}  // namespace turnpoint::rig
