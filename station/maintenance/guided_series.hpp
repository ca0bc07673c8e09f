#pragma once
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "station/maintenance/tone_readings.hpp"
#include "station/report/chart.hpp"
#include "station/rig/calibration.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// What an operator measures point by point while the station plays one tone at a time: the response of a
/// transducer (with a vibrometer), the boundary (with sand), friction, and the sound level.
enum class Series { response, boundaries, friction, sound };

/// One point of a series.
struct SeriesPoint {
  std::string transducer;
  double frequency_Hz = 0;
  double full_scale = 0;            ///< amplitude of the tone; 1 is full scale
  double displacement_um = 0;       ///< of the driven edge, as the rig file or its calibration says
  std::optional<double> value;      ///< what was read: um, mm, relative friction, or dB
  std::optional<double> phase_deg;  ///< response only
};

/// The points of a series for this rig, evenly spaced over what it can play. Throws scene::Unreachable.
std::vector<SeriesPoint> series_points(const rig::Rig& rig, Series series);
/// The smallest number of points from which a series can be fitted.
int least_points(Series series);
/// What a reading of this series can be: the lowest and the highest value that is not a mistake.
std::pair<double, double> possible_values(const rig::Rig& rig, Series series);

/// Length of the tone of a point, by the rig's limits at most 4 s; and how long the surface must rest after
/// it.
double tone_length_s(const rig::Rig& rig);
double rest_after_tone_s(const rig::Rig& rig);
/// Plays the tone of a point after an operator's request, and reads the pick-ups meanwhile; see
/// play_and_read().
void play_point(const rig::Rig& rig, const SeriesPoint& point, const std::stop_token& stop,
                const OnToneReadings& on_readings);

/// A calibration with a series that was measured anew.
struct SeriesResult {
  std::string file;       ///< the calibration file that was written
  std::string csv;        ///< the file with what was read
  report::Figure figure;  ///< the readings with their fit, and the residuals
  rig::Calibration made;
};
/// Writes the readings beside the rig file, fits them, and writes a calibration with today's date: the newest
/// valid one with this series replaced. Points without a value are left out. Throws core::UsageError and
/// core::BadInput like calibrate().
SeriesResult finish_series(const rig::Rig& rig, Series series, const std::vector<SeriesPoint>& points);

}  // namespace turnpoint::maintenance
