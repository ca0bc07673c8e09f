#pragma once
#include <string>
#include <vector>

#include "station/calibration/calibration.hpp"
#include "station/plot/chart.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// Makes a calibration of this rig from measurements, with today's date. Throws text::BadInput with all
/// problems of all files, or terms::UsageError for points that do not determine a fit, for a transducer that
/// the rig does not have, or for an empty band.
calibration::Calibration calibrate(const rig::Rig& rig, const calibration::Measurements& measurements,
                                   int valid_days, const std::string& note);

/// The measured points with their fit, and the residuals below, for everything that was measured: response
/// (amplitude, phase), boundary, friction, sound level.
plot::Figure calibration_figure(const calibration::Calibration& calibration,
                                const calibration::Measurements& measurements);

/// One tone of a stepped sweep, for a vibrometer that is triggered by time.
struct SweepStep {
  std::string transducer;
  int channel = 0;
  double frequency_Hz = 0;
  double full_scale = 0;
  double start_s = 0, length_s = 0;  ///< both ramps included
};

struct SweepOptions {
  int points = 81;  ///< number of tones for each transducer, over its band
  double full_scale = 0.1;
  double length_s = 0.5, pause_s = 0.25;
};

/// Equal steps of frequency over each transducer's band. Throws terms::UsageError for fewer than 5 points, an
/// amplitude outside 0 to 1, or lengths that are below 0.2 s or exceed the rig's duty cycle.
std::vector<SweepStep> sweep_plan(const rig::Rig& rig, const SweepOptions& options);

/// Columns transducer, frequency_Hz, full_scale, start_s, length_s.
std::string to_csv(const std::vector<SweepStep>& steps);

/// Renders the sweep as fast as possible. If `uri` (as in a rig's [output]) is a converter, plays it by
/// play_armed, which only an operator may request.
void play_sweep(const rig::Rig& rig, const std::vector<SweepStep>& steps, const std::string& uri);

}  // namespace turnpoint::maintenance
