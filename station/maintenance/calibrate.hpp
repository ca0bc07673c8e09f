#pragma once
#include <string>
#include <vector>

#include "station/calibration/calibration.hpp"
#include "station/plot/chart.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// Measurements become a calibration of this rig, made today. Throws text::BadInput with every problem of
/// every file, terms::UsageError for points that do not determine a fit, for a transducer that the rig
/// does not have, or a band that is empty.
calibration::Calibration calibrate(const rig::Rig& rig, const calibration::Measurements& measurements,
                                   int valid_days, const std::string& note);

/// Measured points with their fit, and under each the residuals: response (amplitude, phase), boundary,
/// friction, sound level; as far as they were measured.
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
  int points = 81;  ///< per transducer, over its band
  double full_scale = 0.1;
  double length_s = 0.5, pause_s = 0.25;
};

/// Equal steps of frequency over each transducer's band. Throws terms::UsageError for fewer than 5
/// points, an amplitude outside 0 to 1, lengths below 0.2 s or that exceed the rig's duty.
std::vector<SweepStep> sweep_plan(const rig::Rig& rig, const SweepOptions& options);

/// Columns transducer, frequency_Hz, full_scale, start_s, length_s.
std::string to_csv(const std::vector<SweepStep>& steps);

/// Renders the sweep at once; where `uri` (as in a rig's [output]) is a converter, plays it by play_armed,
/// which is the operator's to ask for.
void play_sweep(const rig::Rig& rig, const std::vector<SweepStep>& steps, const std::string& uri);

}  // namespace turnpoint::maintenance
