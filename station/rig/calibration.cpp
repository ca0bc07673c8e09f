#include "station/rig/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/core/usage_error.hpp"
#include "station/rig/csv.hpp"

namespace turnpoint::rig {
namespace {

std::optional<std::chrono::sys_days> parsed_date(const std::string& text) {
  int year = 0, month = 0, day = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2d%c", &year, &month, &day, &rest) != 3) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date);
}

}  // namespace

Calibration fit_measurements(const Measurements& measurements, const Rig& rig) {
  core::Findings findings;
  const auto table = [&](const std::string& path, const std::vector<std::string>& columns) {
    return path.empty() ? std::vector<std::vector<double>>{}
                        : rig::read_table(path, columns, {path, 0, 0}, findings);
  };
  Calibration calibration;
  std::vector<std::vector<ResponsePoint>> sweeps;
  for (const auto& sweep : measurements.sweeps) {
    if (!(sweep.full_scale > 0 && sweep.full_scale <= 1))
      throw core::UsageError(fmt::format(
          "the sweep was measured at {} of full scale; it must be above 0 and at most 1", sweep.full_scale));
    sweeps.emplace_back();
    for (const auto& row : table(sweep.csv, {"frequency_Hz", "displacement_um", "phase_deg"}))
      sweeps.back().push_back({row[0], row[1] * 1e-6 / sweep.full_scale, row[2] * kDegree_rad});
  }
  std::vector<BoundaryPoint> boundaries;
  for (const auto& row : table(measurements.boundaries_csv, {"frequency_Hz", "boundary_mm", "sd_mm"}))
    boundaries.push_back({row[0], row[1] * 1e-3, row[2] * 1e-3});
  std::vector<FrictionPoint> friction;
  for (const auto& row : table(measurements.friction_csv, {"displacement_um", "relative_friction"}))
    friction.push_back({row[0] * 1e-6, row[1]});
  for (const auto& row : table(measurements.sound_csv, {"frequency_Hz", "level_dB"}))
    calibration.sound.push_back({row[0], row[1]});
  findings.throw_if_any();
  for (const auto& point : calibration.sound)
    if (!(point.frequency_Hz > 0 && point.frequency_Hz <= 1e6 && std::abs(point.level_dB - 50) <= 150))
      throw core::Refusal(core::phrase(
          "series.sound_point",
          {core::plain(core::number(point.level_dB)), core::plain(core::number(point.frequency_Hz))}));
  std::vector<Resonance> resonances;
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    calibration.transducers.push_back({measurements.sweeps[k].transducer, fit_response(sweeps[k])});
    for (const Resonance& resonance : find_resonances(sweeps[k])) resonances.push_back(resonance);
  }
  calibration.quality_factor = quality_of(resonances);
  if (!measurements.boundaries_csv.empty()) {
    auto lossy = rig;
    if (calibration.quality_factor) lossy.surface.quality_factor = *calibration.quality_factor;
    calibration.boundary = fit_boundaries(lossy, measurements.edge, std::move(boundaries));
  }
  if (!measurements.friction_csv.empty()) calibration.friction = fit_friction(friction);
  std::sort(calibration.sound.begin(), calibration.sound.end(),
            [](const SoundPoint& a, const SoundPoint& b) { return a.frequency_Hz < b.frequency_Hz; });
  return calibration;
}

int days_left(const Calibration& calibration, const std::string& today) {
  const auto made = parsed_date(calibration.made_on), now = parsed_date(today);
  if (!made || !now)
    throw core::UsageError("dates '" + calibration.made_on + "' and '" + today +
                           "'; dates must have the form YYYY-MM-DD");
  return calibration.valid_days - static_cast<int>((*now - *made).count());
}

std::vector<core::Phrase> problems(const Calibration& calibration, const std::string& rig_sha256,
                                   const std::string& today) {
  using core::phrase, core::plain;
  std::vector<core::Phrase> found;
  if (calibration.rig_sha256 != rig_sha256)
    found.push_back(phrase("refusal.other_rig", {plain(calibration.rig_name)}));
  const int left = days_left(calibration, today);
  if (left < 0) found.push_back(phrase("refusal.expired", {plain(calibration.made_on), plain(-left)}));
  if (left > calibration.valid_days) found.push_back(phrase("refusal.future", {plain(calibration.made_on)}));
  if (calibration.transducers.empty() && !calibration.panel && !calibration.boundary &&
      !calibration.friction && calibration.sound.empty() && calibration.pick_ups.empty() &&
      !calibration.forces)
    found.push_back(phrase("refusal.empty"));
  return found;
}

}  // namespace turnpoint::rig
