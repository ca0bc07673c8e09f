#pragma once
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/problem.hpp"

namespace turnpoint::rig {

/// The half-width W of the surface along its length x, as given in the file; exactly one form is set. SI
/// units.
struct Taper {
  double half_width_m = 0;      ///< half-width at the driven wide end; for a profile, taken from its table
  std::optional<double> slope;  ///< linear taper: W(x) = half_width_m - slope x
  std::optional<double> decay_length_m;  ///< exponential taper: W(x) = half_width_m exp(-x / decay_length_m)
  std::vector<std::pair<double, double>> profile_m;  ///< tabulated taper: (x, W) with monotone interpolation
};

enum class Edges { supported, clamped };
enum class Bending { automatic, on, off };
enum class WideEnd { left, right };
/// The theory for bending of a clamped plate; `automatic` chooses the simplest theory that meets a scene's
/// tolerance.
enum class PlateTheory { kirchhoff, mindlin, elastic, automatic };

/// Parameters of the surface, fitted to measured boundaries. Part of the rig's calibration. SI units.
struct SurfaceFit {
  struct Parameter {
    std::string name;      ///< name of the parameter, as physics::name() writes it
    double change = 0;     ///< the fitted estimate minus the value in the rig file
    double sd = 0;         ///< standard deviation of the estimate
    double stated_sd = 0;  ///< standard deviation of the parameter that the rig file states
    /// correlations of this parameter's error with the errors of the parameters before it in the list
    std::vector<double> correlations;
  };
  std::vector<Parameter> parameters;
};

/// The vibrating surface: material, tension (as a stress), geometry and loss.
struct Surface {
  std::string material;  ///< name of the material; "" if the file gives the constants itself
  double density_kg_m3 = 0;
  std::optional<double> modulus_Pa;
  std::optional<double> poisson;
  std::optional<double> yield_Pa;
  double tension_Pa = 0;  ///< tension of a membrane, as a stress; 0 means a plate
  double thickness_m = 0;
  double length_m = 0;
  /// quality factor of the vibration; infinity means no loss
  double quality_factor = std::numeric_limits<double>::infinity();
  Edges edges = Edges::supported;
  Bending bending = Bending::automatic;
  PlateTheory plate_theory = PlateTheory::automatic;
  WideEnd wide_end = WideEnd::left;
  Taper taper;
  /// Standard uncertainties of measured values, from the optional keys `*_sd`; 0 if not given.
  double tension_sd_Pa = 0, thickness_sd_m = 0, half_width_sd_m = 0, slope_sd = 0, density_sd_kg_m3 = 0,
         modulus_sd_Pa = 0, decay_length_sd_m = 0, clamp_line_sd_m = 0, temperature_sd_K = 0,
         quality_factor_sd = 0;
  /// Relative change of every length, and of Young's modulus, per kelvin; 0 if not known.
  double expansion_per_K = 0, modulus_per_K = 0;
  SurfaceFit fit;  ///< fitted parameters; empty if no calibration has measured boundaries
};

/// One drive element with its band, output channel and displacement of the drive edge at full scale.
struct Transducer {
  std::string name;
  int channel = 0;
  double low_Hz = 0, high_Hz = 0;
  /// displacement at full scale if it is the same at all frequencies; if empty, use `response`
  std::optional<double> m_per_full_scale;
  struct ResponsePoint {
    double frequency_Hz, m_per_full_scale, phase_rad;
  };
  std::vector<ResponsePoint> response;  ///< measured response from response_csv, in order of frequency
};

/// Longest period of the audio stream. The audio thread reports to the amplifier's guard once per period, and
/// the guard expects a report every 100 ms. Two periods must fit into 100 ms.
inline constexpr double longest_period_s = 0.05;

/// The output of the drive: `null:`, `wav:FILE` or `alsa:NAME`.
struct Output {
  std::string uri;
  int rate_Hz = 0;
  int bits = 24;
  int period_frames = 384;
  int periods = 4;
  /// delay from the moment when a sample leaves the buffer until it appears at the analog output
  double converter_delay_s = 0;
  /// number of channels of an ALSA device that has more channels than are used; 0: no more than are used
  int device_channels = 0;
  std::vector<std::string> allow_plugin;
};

/// A signal for recording equipment at each onset and change, on a channel that drives no transducer. A code
/// tells which event it is (audio/trigger_code.hpp).
struct Marker {
  enum class Kind { pulse, tone, code };
  int channel = 1;
  Kind kind = Kind::pulse;
  double amplitude = 0.5;      ///< amplitude of the marker; 1 is full scale
  double duration_s = 1e-3;    ///< length of the pulse or tone, or of one bit of a code
  double frequency_Hz = 1000;  ///< frequency, if the marker is a tone
};

/// Number of bits that a trigger code occupies on the marker channel, including the silence before the next
/// code.
inline constexpr int trigger_code_bits = 15;

/// Where pulses of another device come in, such as those of a scanner.
struct Sync {
  std::string uri;             ///< where the pulses arrive: `sim:`, `gpio:line=NAME` or `capture:`
  std::optional<int> channel;  ///< captured channel of the pulses, if the uri is `capture:`
};

/// What a pick-up captures per unit of drive on one output channel; part of the calibration.
struct PickUpResponse {
  int channel = 0;        ///< captured channel of the pick-up
  int drive_channel = 0;  ///< output channel of the transducer
  struct Point {
    double frequency_Hz = 0;
    double amplitude = 0;  ///< captured amplitude for a tone of full scale; 1 is full scale of the capture
    double phase_rad = 0;  ///< phase, with the delay from playback to capture removed
  };
  std::vector<Point> points;  ///< the measured points, in order of frequency
};

/// The calibration of three force cells, made with dead weights. It converts the ratio of each bridge's
/// output to the reference signal into forces.
struct ForceCells {
  /// Rows: cells a, b, lateral. Columns: normal force (N), lateral force (N), moment (N mm).
  using Matrix = std::array<std::array<double, 3>, 3>;
  Matrix matrix{};
  /// for each source of error: the change of the matrix if this source changes by one standard deviation
  std::vector<Matrix> changes;
  double carrier_Hz = 0;  ///< the calibration holds only for this carrier; 0: a converter with its own clock
  double reference_amplitude = 0;  ///< amplitude of the reference during the calibration; 1 is full scale
  std::array<double, 3> rotation_rad{};  ///< phase of each bridge signal against the reference signal
  /// ratio of bridge to reference signal at the rated load of each cell
  std::array<double, 3> rated_ratio{};
  /// Forces are right up to this frequency: a third of the lowest resonance of the plate on its cells. Empty
  /// if nobody tapped the plate.
  std::optional<double> usable_Hz = {};
};

/// Force cells on a converter with a clock of its own, which the kernel offers as a device of its subsystem
/// IIO.
struct CellConverter {
  std::string uri;  ///< `iio:DEVICE`, with the name or label of the device
  /// names of the channels of two cells below the surface (the first nearer to the wide edge) and of the
  /// lateral one
  std::array<std::string, 3> channels;
  double rate_Hz = 1000;                          ///< samples of each channel per second
  std::optional<double> sampling_frequency = {};  ///< what is written to the attribute of the driver
  std::string trigger = {};                       ///< name of the trigger; "": the one that the device has
  double delay_s = 0;                             ///< by how much the converter's filter delays the samples
};

/// What the station captures of its own output: `sim:` (a simulated plate; only in simulated sessions) or
/// `alsa:NAME` (the capture of the card that plays).
struct Capture {
  std::string uri;
  int channels = 2;           ///< number of channels of the capture device
  std::vector<int> pick_ups;  ///< captured channels with vibration sensors
  int reference = 0;          ///< captured channel that is wired to `excitation_channel`
  /// output channel of the excitation and of the pilot (a chirp that shows the delay from playback to
  /// capture); set for `alsa:`
  std::optional<int> excitation_channel;
  std::vector<PickUpResponse> responses;  ///< empty without a calibration of the pick-ups
  /// captured channel that is wired to the output of a marker with codes, which are read back from it
  std::optional<int> marker_channel = {};
  /// captured channels of the force cells: two below the surface (the first nearer to the wide edge) and the
  /// lateral one; empty without force cells
  std::vector<int> bridges = {};
  /// force cells that are not captured by the card; `bridges` is then empty
  std::optional<CellConverter> converter = {};
  std::optional<ForceCells> forces = {};  ///< empty without a calibration of the force cells
  /// lowest resonance of the plate on its captured cells, and its damping ratio: how late they are. The
  /// resonance that the calibration measured goes before.
  std::optional<double> cells_resonance_Hz = {};
  double cells_damping = 0.05;
};

/// Where the temperatures of the surface and of the frame that clamps it are read: hwmon:NAME/tempN or
/// iio:NAME/temp (`system/thermometer.hpp`).
struct Thermometers {
  std::string plate_uri, frame_uri;
};

/// Headphones that mask the audible part of a stimulus or give the response signal, for protocols that
/// require it.
struct MaskingNoise {
  int channel = 1;
  double rms = 0;  ///< level of the noise; 1 is full scale
  double low_Hz = 100, high_Hz = 8000;
  /// the tone that asks for an answer, for protocols whose response signal is a tone; amplitude 1 is full
  /// scale
  struct Signal {
    double frequency_Hz = 0, amplitude = 0;
  };
  std::optional<Signal> signal = {};
};

/// The friction curve of a measured table, in pairs of (displacement_m, relative_friction): begins at (0, 1),
/// and falls strictly. Neighbours of equal friction become one point in their middle. Empty if the table is
/// not usable: displacements must be 0 or more and ascend by at least 1 pm, friction must be at least 0.001,
/// never rise, be at most 1 (exactly 1 at displacement 0), and end below 1.
using FrictionTable = std::vector<std::pair<double, double>>;
FrictionTable falling(const FrictionTable& table);

/// The least relative friction of a measured table, and the least distance of its displacements.
inline constexpr double kLeastFriction = 1e-3;
inline constexpr double kLeastStep_m = 1e-12;

/// The relation between amplitude and relative friction: the illustrative load-sharing curve or a measured
/// table.
struct Friction {
  bool stated = false;    ///< true if the file has a [friction] table
  bool measured = false;  ///< true for a measured table; false for load sharing, which live mode refuses
  double pressure_Pa = 5000;
  double floor = 0.1;
  double fingertip_m = 0.010;
  FrictionTable table;  ///< measured; see falling()
};

/// A fingertip on the surface as a mechanical impedance at ultrasonic frequencies, with its standard
/// deviations between people.
struct Finger {
  double impedance_Ns_per_m = 55, impedance_sd_Ns_per_m = 15;
  /// a phase above zero means that force leads velocity, as for a mass
  double phase_rad = 0, phase_sd_rad = 0;
  double contact_m = 0.008;  ///< diameter of the contact between finger and surface
  /// how far a lateral force stretches the skin, so that the contact stays behind the finger
  double skin_m_per_N = 1e-3;
};

/// Limits for driving the surface, which must never be exceeded.
struct Limits {
  double displacement_m = 0;
  double continuous_s = 30;
  double duty = 0.8;
  double session_minutes = 60;
};

/// A station's hardware as described in its rig file. A loaded Rig is valid.
struct Rig {
  std::string path, source, sha256;
  std::string name;
  bool reproduction = false;
  Surface surface;
  std::vector<Transducer> transducers;
  Output output;
  std::string amplifier_uri;
  std::optional<std::string> buttons_uri, contact_uri, touch_uri;
  std::optional<std::string> trigger_lines_uri;  ///< lines that send trigger codes in parallel
  std::optional<Sync> sync;
  std::optional<Capture> capture;
  std::optional<Thermometers> thermometers;
  std::optional<Marker> marker;
  std::optional<MaskingNoise> noise;
  Friction friction;
  Finger finger;
  Limits limits;
  /// the sound card's mixer while the calibration was measured, by names of controls; empty without one
  std::map<std::string, std::string> mixer;
  std::vector<std::string> defaults_used;  ///< `key = value` for each default that was used
};

/// True if the rig has force cells, calibrated or not.
bool has_force_cells(const Rig& rig);

/// Returns the transducers whose vibration cannot be proven: the rig captures with a card, but the
/// calibration contains no response of a pick-up to them.
std::vector<std::string> unproven_transducers(const Rig& rig);

/// Returns the largest trigger code that every output for codes of this rig can send; 0 if the rig has no
/// such output.
int largest_trigger_code(const Rig& rig);

/// Reads and checks a rig file (format "friction-rig/1"). Throws core::BadInput with all problems at once, or
/// std::system_error if the file cannot be read.
Rig load(const std::string& path);

/// Like load(), for text that is already in memory (a resumed session). Files named in it are looked for in
/// the folder of `path`.
Rig parse(const std::string& source, const std::string& path);

/// Returns the number of channels of the stream: as many as the rig uses, but at least two.
int channels(const Rig& rig);

/// Names of the materials for which density, modulus, Poisson ratio and yield strength are built in.
std::vector<std::string> materials();

}  // namespace turnpoint::rig
