#pragma once
#include <string>
#include <vector>

#include "station/report/chart.hpp"
#include "station/rig/calibration.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// Makes a calibration of this rig from measurements, with today's date. Throws core::BadInput with all
/// problems of all files. Throws core::UsageError if the points do not determine a fit, if the rig does not
/// have the transducer, or if the band is empty.
rig::Calibration calibrate(const rig::Rig& rig, const rig::Measurements& measurements, int valid_days,
                           const std::string& note);

/// Returns the text of the calibration file. Reads it back first, applies it to the rig, and plans with it as
/// sessions do. Throws core::UsageError if any of this fails, so that no command writes a calibration that
/// another one cannot use.
std::string usable_toml(const rig::Calibration& calibration, const rig::Rig& rig);

/// Writes the file with usable_toml() and with the present levels of the sound card's mixer. It may replace
/// the calibration from which this one was continued. Throws core::Refusal if that one was measured with
/// other levels of the mixer. Where no mixer can be read, its levels stay as they were.
void write_calibration(rig::Calibration calibration, const rig::Rig& rig, const std::string& path);

/// Plots the measured points with their fit, and the residuals below. There is a chart for each quantity that
/// was measured: response (amplitude and phase), boundary, friction, sound level.
report::Figure calibration_figure(const rig::Calibration& calibration, const rig::Measurements& measurements);

/// One tone of a stepped sweep. In a vibrometer's recording, the tones are found by their times.
struct SweepStep {
  std::string transducer;
  int channel = 0;
  double frequency_Hz = 0;
  double full_scale = 0;
  double start_s = 0, length_s = 0;  ///< the length of a tone includes both ramps
};

struct SweepOptions {
  int points = 81;  ///< number of tones for each transducer, spread over its band
  double full_scale = 0.1;
  double length_s = 0.5, pause_s = 0.25;
};

/// Plans a sweep with equal steps of frequency over each transducer's band. Throws core::UsageError for
/// fewer than 5 points, an amplitude outside 0 to 1, tones shorter than 0.2 s, or lengths that exceed the
/// rig's duty cycle.
std::vector<SweepStep> sweep_plan(const rig::Rig& rig, const SweepOptions& options);

/// Returns the sweep as CSV with the columns transducer, frequency_Hz, full_scale, start_s, length_s.
std::string to_csv(const std::vector<SweepStep>& steps);

/// Renders the sweep to a file as fast as possible. If `uri` (written as in a rig's [output]) is a converter,
/// plays the sweep with play_armed(); only an operator may request that.
void play_sweep(const rig::Rig& rig, const std::vector<SweepStep>& steps, const std::string& uri);

}  // namespace turnpoint::maintenance
