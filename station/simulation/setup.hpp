#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "physics/friction.hpp"
#include "physics/surface.hpp"

namespace turnpoint::simulation {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

inline constexpr std::size_t kMostTransducers = 8;

/// Moves the drive edge of the surface. The motions of several transducers add up.
struct Transducer {
  int channel = 0;               ///< playback channel that drives it
  double um_per_full_scale = 4;  ///< peak displacement of the drive edge for a tone at full scale
};

/// A piezo patch on the surface. It measures displacement and does not load the surface.
struct Pickup {
  int channel = 0;  ///< capture channel of the pick-up
  double x_m = 0;   ///< distance of the pick-up from the drive edge
  double full_scale_per_um = 0.1;
  double noise_full_scale = 1e-4;  ///< rms of the noise in one captured sample
  /// An overdriven preamplifier: a signal y (full scale 1) becomes y + cubic y^3.
  double cubic = 0;
};

/// The cells a and b below the surface carry the normal force. A third cell measures the lateral force. For a
/// normal force N on the surface at x, and a lateral force T at the height h above the pivots:
///   a = N (1 - x/L) - h T/L,   b = N x/L + h T/L,   lateral = T
/// where x is counted from cell a.
struct Cells {
  double first_m = 0;     ///< position of cell a, from the drive edge
  double span_m = 0.3;    ///< L, distance from cell a to cell b
  double height_m = 0.0;  ///< h, height of the surface above the pivots
  /// resonance frequencies and damping of the cells
  double normal_Hz = 60, lateral_Hz = 180, damping = 0.05;
  /// For the cells a, b and lateral: reading = crosstalk matrix times forces.
  std::array<std::array<double, 3>, 3> crosstalk{{{1, 0.02, -0.02}, {0.02, 1, 0.02}, {-0.02, 0.02, 1}}};
  std::array<double, 3> zero_N{};
  double drift_N_per_K = 1e-3;
  double volt_per_volt_N = 2e-4;  ///< bridge output per volt of excitation and newton: 0.5 mV/N at 2.5 V
};

/// The electronics from the excitation to the converter. Distortion turns the amplified voltage y into y + a2
/// y^2 + a3 y^3.
struct Wires {
  std::optional<int> carrier_channel = 3;    ///< playback channel that excites the bridges
  double excitation_V_per_full_scale = 2.5;  ///< peak voltage of the excitation
  /// voltage of the excitation that gives full scale on the reference channel
  double reference_V_at_full_scale = 3.0;
  double gain = 200;          ///< gain of the bridge amplifiers
  double full_scale_V = 2.1;  ///< amplified voltage that is full scale on a bridge's channel
  /// crosstalk from the drive to each bridge: a tone of 0.25 gives 1 mV
  double crosstalk_V_per_full_scale = 4e-3;
  double a2_per_V = 1e-4, a3_per_V2 = 1e-4;
  double noise_V_per_rtHz = 4e-9;            ///< spectral density of the noise at the output of a bridge
  double converter_noise_full_scale = 7e-6;  ///< rms of one sample of the reference (110 dB in 20 kHz)
  int bits = 24;
};

/// Capture channels. An unused channel carries zeros.
struct CaptureChannels {
  int count = 8;
  std::optional<int> reference = 0, bridge_a = 1, bridge_b = 2, lateral = 3, marker = 4;
};

/// The finger is on the surface from from_frame up to the frame before to_frame. These frames count captured
/// frames and those that gaps lost.
struct Touch {
  std::int64_t from_frame = 0, to_frame = kNever;
};

/// A finger that strokes to and fro. Each stroke has minimum jerk. The skin stretches like a spring
/// (contact_N_per_m) until the lateral force reaches friction * normal force; then it slides.
struct Finger {
  std::vector<Touch> touches;
  double from_m = 0.06, to_m = 0.26;
  double stroke_s = 2.5;  ///< duration of a stroke; 0.2 m in 2.5 s are 80 mm/s on average, at most 150 mm/s
  double pause_s = 0.3;   ///< pause of the finger at each end of its path
  double land_s = 0.05;   ///< time in which the force rises when the finger lands, and falls when it leaves
  double normal_N = 0.5;
  /// relative standard deviation of the normal force; pink noise from 0.1 to 25 Hz
  double normal_noise = 0.15;
  double friction = 0.8;            ///< coefficient of friction while the surface is at rest
  double friction_drift_per_s = 0;  ///< friction is multiplied by exp(drift * time in s)
  /// relative standard deviation of the friction; pink noise from 0.1 to 400 Hz
  double friction_noise = 0.08;
  double film_Hz = 300;  ///< cut-off of the low-pass with which friction follows the amplitude
  double contact_N_per_m = 1000;
  double fingertip_m = 0.010;  ///< length of the fingertip, over which friction is averaged
  /// mechanical impedance with which the finger loads the surface at the frequencies of tones, and diameter
  /// of its contact (physics/finger.hpp); at 0 the surface moves under the finger as without it
  std::complex<double> impedance_Ns_per_m = 0;
  double contact_m = 8e-3;
};

/// A dead weight and a lateral force on the surface at x, in addition to the finger.
struct Load {
  double normal_N = 0, lateral_N = 0, x_m = 0;
};

/// What can fail. A number in parentheses is the default of Fault::amount.
enum class FaultKind {
  transducer_dead,  ///< transducer `index` does not move
  transducer_half,  ///< transducer `index` moves half as far
  resonance_off,    ///< all resonances of the surface are higher by the fraction `amount` (0.03)
  frequency_off,    ///< the frequencies of the drive edge are higher by the fraction `amount` (0.03)
  drive_late,       ///< the drive edge moves `amount` seconds later (0.005)
  clip,             ///< the amplifier clips at `amount` of full scale (0.5)
  broken_bridge,    ///< a wire of cell a, b or lateral (`index` 0, 1, 2) is open
  no_reference,     ///< the reference channel carries only noise
  finger_lifts,     ///< the finger is not on the surface
  gap,              ///< `amount` captured frames are lost at `from_frame` (480)
  warmer,           ///< surface and cells are warmer by `amount` kelvin (10)
  sounding,         ///< the drive edge also moves at 27 kHz, by `amount` um (0.05), whatever is played
  dead_bridge  ///< the captured channel of cell a, b or lateral (`index` 0, 1, 2) is exactly zero, without
               ///< noise
};

/// The name of the enumerator, with spaces instead of underscores: "transducer dead".
std::string_view name(FaultKind kind);
/// Returns the kind with this name; empty if there is none.
std::optional<FaultKind> find_fault(std::string_view name);

/// A fault and the captured frames during which it lasts: from from_frame up to the frame before to_frame.
struct Fault {
  FaultKind kind = FaultKind::transducer_dead;
  std::int64_t from_frame = 0, to_frame = kNever;
  std::optional<double> amount = {};  ///< strength of the fault; if empty, the default of its kind
  int index = 0;
};

/// Describes the laboratory between the converter's outputs and its inputs.
struct Setup {
  int rate_Hz = 192000;
  int playback_channels = 4;
  std::vector<Transducer> transducers{{}};
  Wires wires;
  CaptureChannels capture;
  std::vector<Pickup> pickups{{5, 0.003}, {6, 0.009}};
  std::optional<int>
      marker_channel;  ///< playback channel that the capture channel `marker` repeats bit by bit
  Cells cells;
  physics::Surface surface;
  physics::FrictionMap friction;
  Finger finger;
  double temperature_C = 23;
  double surface_temperature_C = 23;  ///< temperature at which `surface` describes the plate
  /// Relative change of all lengths, and of Young's modulus, per kelvin. The resonances of a plate change by
  /// half of the sum of both: longer lengths lower them, but the lower density raises them more.
  double expansion_per_K = 2.3e-5, modulus_per_K = -4.8e-4;
  /// The simulated response of the pick-ups is fitted to the surface's model in this band.
  double band_low_Hz = 16000, band_high_Hz = 50000;
  /// Delay from a played to a captured frame. If it has a fraction, it must be at least 24 frames.
  double loop_delay_frames = 400;
  std::uint64_t seed = 1;
};

}  // namespace turnpoint::simulation
