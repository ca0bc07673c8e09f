#include "station/maintenance/pick_up_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "station/core/usage_error.hpp"
#include "station/maintenance/captured_sweep.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/rig/apply.hpp"
#include "station/rig/csv.hpp"
#include "station/sensing/sweep.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"

namespace turnpoint::maintenance {

namespace {

using rig::DisplacementPoint;
using rig::PickUp;

constexpr double kFirst_s = 2, kPause_s = 1;
constexpr double kOverload = 0.98;  // a sample of this fraction of full scale counts as overload
// At its best frequency, a response must be at least this many times larger than its noise. Otherwise the
// pick-up has captured nothing but noise.
constexpr double kLeastOverNoise = 20;
// If measured displacements differ from those in the rig file by more than this factor, their unit must be
// wrong.
constexpr double kMostContrast = 20;

std::vector<sensing::Sweep> sweeps_of(const rig::Rig& rig, const PickUpOptions& options) {
  if (!(options.full_scale > 0 && options.full_scale <= 1))
    throw core::UsageError(
        fmt::format("pick-ups: the amplitude of the sweep must be above 0 and at most 1 (full scale), not {}",
                    options.full_scale));
  std::vector<sensing::Sweep> sweeps;
  for (const auto& transducer : rig.transducers) {
    sensing::Sweep sweep;
    sweep.rate_Hz = rig.output.rate_Hz;
    sweep.low_Hz = std::max(options.low_Hz, transducer.low_Hz);
    sweep.high_Hz = std::min(options.high_Hz, transducer.high_Hz);
    sweep.length_s = options.length_s;
    sweep.amplitude = options.full_scale;
    sweep.channel = transducer.channel;
    if (!(sweep.high_Hz - sweep.low_Hz >= 1000))
      throw core::UsageError(fmt::format(
          "pick-ups: the band of transducer \"{}\" leaves less than 1 kHz between {} and {} Hz to sweep",
          transducer.name, options.low_Hz, options.high_Hz));
    sweeps.push_back(sweep);
  }
  return sweeps;
}

Captured captured(const rig::Rig& rig, const std::vector<sensing::Sweep>& sweeps,
                  std::vector<audio::Burst>& bursts, const PickUpOptions& options) {
  double start_s = kFirst_s;
  for (const auto& sweep : sweeps) {
    bursts.push_back(sensing::sweep_burst(sweep, std::llround(start_s * sweep.rate_Hz)));
    start_s += sweep.length_s + kPause_s;
  }
  if (session::simulates_capture(rig)) return capture_simulated(rig, bursts, options.laboratory);
  return capture_armed(rig, bursts);
}

/// Returns the part of a recording that sensing::sweep_response() needs.
std::span<const double> part_of(const Captured& recording, int channel, const sensing::Sweep& sweep,
                                const audio::Burst& burst) {
  const auto quiet = std::llround(sensing::kSweepQuiet_s * sweep.rate_Hz);
  const auto& samples = recording.channels.at(static_cast<std::size_t>(channel));
  const auto first = burst.start_frame - quiet - recording.first_frame;
  const auto count = burst.length_frames + 2 * quiet;
  if (first < 0 || first + count > std::ssize(samples))
    throw std::runtime_error("pick-ups: the recording does not cover the sweep");
  return std::span(samples).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
}

PickUp fitted(int channel, const sensing::Sweep& sweep, const sensing::SweepResponse& response) {
  if (response.largest_sample >= kOverload)
    throw core::UsageError(fmt::format(
        "the pick-up on channel {} overloads the converter; use a smaller --full-scale or less gain",
        channel));
  std::vector<rig::SweptPoint> points;
  double largest = 0;
  for (const auto& [f, value] : response.points) {
    points.push_back({f, value});
    largest = std::max(largest, std::abs(value));
  }
  if (!(largest > kLeastOverNoise * response.noise))
    throw core::UsageError(fmt::format(
        "the pick-up on channel {} captures nothing but noise while output channel {} sweeps; check its wire "
        "and the amplifier",
        channel, sweep.channel));
  return rig::fit_pick_up(channel, sweep.channel, points, response.noise);
}

/// A table of measured displacements, and the captured channel of the pick-up to which they belong.
struct ScaleTable {
  int channel = 0;
  std::string file;
  std::vector<DisplacementPoint> points;
};

std::optional<ScaleTable> scale_table(const PickUpOptions& options) {
  const bool by_vibrometer = !options.vibrometer.empty();
  if (by_vibrometer && !options.accelerometer.empty())
    throw core::UsageError("pick-ups: give either --vibrometer or --accelerometer");
  const auto& given = by_vibrometer ? options.vibrometer : options.accelerometer;
  if (given.empty()) return std::nullopt;
  const auto equals = given.find('=');
  const auto digits = given.substr(0, equals);
  if (equals == std::string::npos || equals == 0 || equals + 1 == given.size() || digits.size() > 2 ||
      digits.find_first_not_of("0123456789") != std::string::npos)
    throw core::UsageError("pick-ups: \"" + given + "\"; write CHANNEL=FILE.csv with the captured channel");
  if (!(options.table_full_scale > 0 && options.table_full_scale <= 1))
    throw core::UsageError(
        fmt::format("the table was measured at {} of full scale; it must be above 0 and at most 1",
                    options.table_full_scale));
  ScaleTable table{std::stoi(digits), given.substr(equals + 1), {}};
  core::Findings findings;
  const auto rows =
      rig::read_table(table.file, {"frequency_Hz", by_vibrometer ? "displacement_um" : "acceleration_m_s2"},
                      {table.file, 0, 0}, findings, 1);
  findings.throw_if_any();
  for (const auto& row : rows) {
    const double turn = 2 * std::numbers::pi * row[0];
    const double um = by_vibrometer ? row[1] : 1e6 * row[1] / (turn * turn);
    table.points.push_back({row[0], um / options.table_full_scale});
  }
  return table;
}

/// Throws if the displacements of a table are far from those in the rig file, because they are then probably
/// in another unit: nanometres, g, or a level in dB.
void compare(const ScaleTable& table, const rig::Transducer& transducer) {
  double stated_um = 1e6 * transducer.m_per_full_scale.value_or(0), largest_um = 0;
  for (const auto& point : transducer.response) stated_um = std::max(stated_um, 1e6 * point.m_per_full_scale);
  for (const auto& point : table.points) largest_um = std::max(largest_um, point.um_per_full_scale);
  if (stated_um > 0 && (largest_um > kMostContrast * stated_um || largest_um * kMostContrast < stated_um))
    throw core::UsageError(
        fmt::format("{}: at full scale the surface would move by {:.3g} um, but the rig file says {:.3g} um; "
                    "check the unit and --full-scale",
                    table.file, largest_um, stated_um));
}

}  // namespace

std::vector<PickUp> calibrate_pick_ups(const rig::Rig& rig, const PickUpOptions& options) {
  if (!rig.capture || rig.capture->pick_ups.empty())
    throw core::UsageError("the rig \"" + rig.name + "\" has no pick-ups; add [capture] to the rig file");
  const auto table = scale_table(options);
  const auto& channels = rig.capture->pick_ups;
  if (table && std::find(channels.begin(), channels.end(), table->channel) == channels.end())
    throw core::UsageError(fmt::format("the rig has no pick-up on captured channel {}", table->channel));
  if (table) compare(*table, rig.transducers.front());
  const auto sweeps = sweeps_of(rig, options);
  std::vector<audio::Burst> bursts;
  const auto recording = captured(rig, sweeps, bursts, options);
  std::vector<PickUp> made;
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    const auto played = rendered(rig, bursts[k], sweeps[k].channel);
    for (const int channel : channels)
      made.push_back(
          fitted(channel, sweeps[k],
                 sensing::sweep_response(sweeps[k], played, part_of(recording, channel, sweeps[k], bursts[k]),
                                         recording.delay_frames)));
  }
  if (!table) return made;
  // The table was measured with the first transducer, but the sensitivity that it gives is that of the
  // sensor, and holds for all transducers.
  const auto measured = std::find_if(made.begin(), made.end(), [&](const PickUp& pick_up) {
    return pick_up.response.channel == table->channel;
  });
  const auto scale = rig::fit_scale(*measured, options.sensor, table->points, options.instrument_sd);
  for (auto& pick_up : made)
    if (pick_up.response.channel == table->channel) pick_up.scale = scale;
  return made;
}

rig::Calibration with_pick_ups(const rig::Rig& rig, std::vector<PickUp> pick_ups, const std::string& out) {
  auto made = known_calibration(rig, out);
  made.pick_ups = std::move(pick_ups);
  return made;
}

}  // namespace turnpoint::maintenance
