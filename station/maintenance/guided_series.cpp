#include "station/maintenance/guided_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <utility>

#include "station/audio/burst.hpp"
#include "station/core/limits.hpp"
#include "station/core/texts.hpp"
#include "station/core/usage_error.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/rig/apply.hpp"
#include "station/scene/transducer.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::maintenance {

namespace {

constexpr double kTone_s = 4, kRamp_s = 0.05, kToneRest_s = 0.5;
constexpr double kQuiet = 0.1;  // amplitude of a response or sound measurement
constexpr double kLowest_Hz = core::kAudible_Hz,
                 kHighest_Hz = 46'000;  // inaudible, and what a station can sample
constexpr double kSand_um = 1;          // enough to move sand at these frequencies
constexpr double kSand_sd_mm = 1.5;     // of the edge of sand, read by eye on a scale
constexpr int kResponsePoints = 9, kBoundaryPoints = 6, kSoundPoints = 5;
constexpr int kValidDays = 90;

double at(double low, double high, int k, int count) { return low + (high - low) * k / (count - 1); }

SeriesPoint with_displacement(const rig::Rig& rig, double frequency_Hz, double displacement_um) {
  const auto tone = scene::on_transducer(rig, {frequency_Hz, 1e-6 * displacement_um, 0});
  return {tone.transducer, frequency_Hz, tone.full_scale, displacement_um, {}, {}};
}

SeriesPoint with_amplitude(const rig::Rig& rig, const std::string& transducer, double frequency_Hz) {
  const auto tone = scene::on_transducer(rig, {frequency_Hz, 1e-6, 0});
  return {transducer.empty() ? tone.transducer : transducer,
          frequency_Hz,
          kQuiet,
          kQuiet / tone.full_scale,
          {},
          {}};
}

std::string csv_of(Series series, const std::vector<SeriesPoint>& points) {
  std::string csv = series == Series::response     ? "frequency_Hz,displacement_um,phase_deg\n"
                    : series == Series::boundaries ? "frequency_Hz,boundary_mm,sd_mm\n"
                    : series == Series::friction   ? "displacement_um,relative_friction\n0,1\n"
                                                   : "frequency_Hz,level_dB\n";
  for (const auto& point : points) {
    if (!point.value) continue;
    if (series == Series::response)
      csv += fmt::format("{:.3f},{},{}\n", point.frequency_Hz, *point.value, point.phase_deg.value_or(0));
    else if (series == Series::boundaries)
      csv += fmt::format("{:.3f},{},{}\n", point.frequency_Hz, *point.value, kSand_sd_mm);
    else if (series == Series::friction)
      csv += fmt::format("{},{}\n", point.displacement_um, *point.value);
    else
      csv += fmt::format("{:.3f},{:.2f}\n", point.frequency_Hz,
                         *point.value - 20 * std::log10(point.full_scale));
  }
  return csv;
}

const char* word(Series series) {
  constexpr const char* words[] = {"response", "boundaries", "friction", "sound"};
  return words[static_cast<std::size_t>(series)];
}

/// Beside the calibration file: RIG.boundaries-2026-03-01.csv.
std::string path_beside(const rig::Rig& rig, const std::string& what) {
  auto path = rig::file_for(rig.path, rig::today());
  path.replace(path.rfind("calibration-"), std::string("calibration").size(), what);
  return std::filesystem::path(path).replace_extension(".csv").string();
}

/// The newest valid calibration, with what was measured now in the place of what it had.
rig::Calibration merged(const rig::Rig& rig, Series series, const rig::Calibration& made) {
  auto all = known_calibration(rig);
  all.made_on = made.made_on;
  if (series == Series::response) {
    for (const auto& transducer : made.transducers) {
      std::erase_if(all.transducers, [&](const auto& old) { return old.name == transducer.name; });
      all.transducers.push_back(transducer);
    }
    if (made.quality_factor) all.quality_factor = made.quality_factor;
  } else if (series == Series::boundaries) {
    all.boundary = made.boundary;
  } else if (series == Series::friction) {
    all.friction = made.friction;
  } else {
    all.sound = made.sound;
  }
  static_cast<void>(rig::applied(all, rig));  // throws if the rig cannot use it
  return all;
}

}  // namespace

std::vector<SeriesPoint> series_points(const rig::Rig& rig, Series series) {
  std::vector<SeriesPoint> points;
  const double low_Hz = scene::lowest_frequency(rig, kLowest_Hz);
  const double high_Hz = scene::highest_frequency(rig, kHighest_Hz);
  if (series == Series::response)
    for (const auto& transducer : rig.transducers)
      for (int k = 0; k < kResponsePoints; ++k)
        points.push_back(with_amplitude(rig, transducer.name,
                                        at(std::max(transducer.low_Hz, low_Hz),
                                           std::min(transducer.high_Hz, high_Hz), k, kResponsePoints)));
  if (series == Series::boundaries)
    for (int k = 0; k < kBoundaryPoints; ++k)
      points.push_back(with_displacement(rig, at(low_Hz, high_Hz, k, kBoundaryPoints), kSand_um));
  if (series == Series::friction)
    for (const double displacement_um : {0.25, 0.5, 1.0, 2.0, 3.0})
      if (displacement_um <= 1e6 * rig.limits.displacement_m)
        points.push_back(with_displacement(rig, (low_Hz + high_Hz) / 2, displacement_um));
  if (series == Series::sound)
    for (int k = 0; k < kSoundPoints; ++k)
      points.push_back(with_amplitude(rig, "", at(low_Hz, high_Hz, k, kSoundPoints)));
  return points;
}

int least_points(Series series) {
  return series == Series::response     ? 5
         : series == Series::boundaries ? 3
         : series == Series::friction   ? 1
                                        : 2;
}

std::pair<double, double> possible_values(const rig::Rig& rig, Series series) {
  if (series == Series::response) return {0.0001, 100};
  if (series == Series::boundaries) return {0, 1e3 * rig.surface.length_m};
  if (series == Series::friction) return {0, 1.5};
  return {0, 160};
}

double tone_length_s(const rig::Rig& rig) { return std::min(kTone_s, rig.limits.continuous_s); }

double rest_after_tone_s(const rig::Rig& rig) {
  return std::max(kToneRest_s, tone_length_s(rig) * (1 / rig.limits.duty - 1));
}

void play_point(const rig::Rig& rig, const SeriesPoint& point, const std::stop_token& stop,
                const OnToneReadings& on_readings) {
  const auto frames = [&](double s) {
    return static_cast<std::int64_t>(std::llround(s * rig.output.rate_Hz));
  };
  const auto transducer = std::find_if(rig.transducers.begin(), rig.transducers.end(),
                                       [&](const auto& one) { return one.name == point.transducer; });
  if (transducer == rig.transducers.end())
    throw core::UsageError("the rig has no transducer named " + point.transducer);
  audio::Burst burst;
  burst.length_frames = frames(tone_length_s(rig));
  burst.ramp.frames = frames(kRamp_s);
  burst.tones.count = 1;
  burst.tones.tones[0] = {point.frequency_Hz, point.full_scale, 0, transducer->channel};
  play_and_read(rig, burst, stop, on_readings);
}

SeriesResult finish_series(const rig::Rig& rig, Series series, const std::vector<SeriesPoint>& points) {
  const auto read =
      std::count_if(points.begin(), points.end(), [](const auto& p) { return p.value.has_value(); });
  if (read < least_points(series))
    throw core::Refusal(core::phrase("series.too_few", {core::plain(read), core::plain(points.size()),
                                                        core::plain(least_points(series))}));
  SeriesResult result;
  rig::Measurements measurements;
  if (series == Series::response) {
    for (const auto& transducer : rig.transducers) {
      std::vector<SeriesPoint> mine;
      std::copy_if(points.begin(), points.end(), std::back_inserter(mine),
                   [&](const auto& p) { return p.transducer == transducer.name && p.value; });
      if (mine.empty()) continue;
      result.csv = path_beside(rig, "response-" + transducer.name);
      system::write_file(result.csv, csv_of(series, mine));
      measurements.sweeps.push_back({transducer.name, result.csv, kQuiet});
    }
  } else {
    result.csv = path_beside(rig, word(series));
    system::write_file(result.csv, csv_of(series, points));
    (series == Series::boundaries ? measurements.boundaries_csv
     : series == Series::friction ? measurements.friction_csv
                                  : measurements.sound_csv) = result.csv;
  }
  const auto made = calibrate(rig, measurements, kValidDays, "");
  result.figure = calibration_figure(made, measurements);
  result.made = merged(rig, series, made);
  result.file = rig::file_for(rig.path, made.made_on);
  write_calibration(result.made, rig, result.file);
  return result;
}

}  // namespace turnpoint::maintenance
