#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/core/texts.hpp"
#include "station/rig/fits.hpp"
#include "station/rig/panel_latency.hpp"
#include "station/rig/pick_up_fit.hpp"

namespace turnpoint::rig {

/// A sound pressure level that was measured with the drive at full scale.
struct SoundPoint {
  double frequency_Hz = 0;
  double level_dB = 0;
};

/// What was fitted to the measurements of a rig on one day. Sessions refer to the calibration file by its
/// SHA-256.
struct Calibration {
  std::string rig_name;
  std::string rig_sha256;  ///< hash of the rig file for which the calibration was made
  std::string made_on;     ///< date, YYYY-MM-DD
  int valid_days = 90;
  std::string note;
  struct Transducer {
    std::string name;
    ResponseFit response;
  };
  std::vector<Transducer> transducers;
  std::optional<BoundaryFit> boundary;
  std::optional<double> quality_factor;
  std::optional<FrictionFit> friction;
  std::vector<SoundPoint> sound;
  std::optional<PanelLatency> panel;
  std::vector<PickUp> pick_ups;
  std::optional<ForceCells> forces;
  /// the sound card's mixer during the measurements: the values of each control by its name
  std::map<std::string, std::string> mixer;
};

/// Names of the files with measurements; "" if there is no such file. Their columns are:
/// sweep: `frequency_Hz,displacement_um,phase_deg`, measured at the drive amplitude `full_scale`
/// boundaries: `frequency_Hz,boundary_mm,sd_mm`
/// friction: `displacement_um,relative_friction`
/// sound: `frequency_Hz,level_dB` at full scale
struct Measurements {
  struct Sweep {
    std::string transducer, csv;
    double full_scale = 1;  ///< drive amplitude during the sweep, 0 to 1; 1 is full scale
  };
  std::vector<Sweep> sweeps;
  std::string boundaries_csv, friction_csv, sound_csv;
  std::string edge = "p50";  ///< which edge of the vibration was measured, as physics::format() writes it
};

/// Reads the files and fits the measurements. Throws core::BadInput with all problems of all files, or
/// core::UsageError for points that do not determine a fit.
Calibration fit_measurements(const Measurements& measurements, const Rig& rig);

/// to_toml() returns the text of a calibration file (format "friction-calibration/1"); load_calibration()
/// reads such a file, and throws core::BadInput or std::system_error.
std::string to_toml(const Calibration& calibration);
Calibration load_calibration(const std::string& path);
/// Like load_calibration(), for the text of a calibration file that is already in memory (a resumed session).
/// `path` is only used in messages.
Calibration parse_calibration(const std::string& text, const std::string& path);

/// Returns for how many more days the calibration is valid on the day `today` (YYYY-MM-DD). If it has
/// expired, returns minus the number of days since then.
int days_left(const Calibration& calibration, const std::string& today);

/// Returns the reasons why sessions must not use the calibration: it was made for another rig file, it is not
/// valid on the day `today`, or nothing was measured. Empty if sessions may use it.
std::vector<core::Phrase> problems(const Calibration& calibration, const std::string& rig_sha256,
                                   const std::string& today);

}  // namespace turnpoint::rig
