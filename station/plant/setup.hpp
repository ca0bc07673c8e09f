#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "physics/friction.hpp"
#include "physics/surface.hpp"

namespace turnpoint::plant {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

inline constexpr std::size_t kMostTransducers = 8;

/// Moves the drive edge of the surface. The motions of several transducers add up.
struct Transducer {
  int channel = 0;               ///< playback channel
  double um_per_full_scale = 4;  ///< displacement of the drive edge, peak
};

/// A piezo patch on the surface. It measures displacement, without loading the surface.
struct Pickup {
  int channel = 0;  ///< capture channel
  double x_m = 0;   ///< distance from the drive edge
  double full_scale_per_um = 0.1;
  double noise_full_scale = 1e-4;  ///< rms of one sample
};

/// The two cells below the surface, a and b, carry the normal force; the third cell measures the lateral
/// force. With a force N on the surface at x, and T along it at the height h above the pivots:
///   a = N (1 - x/L) - h T/L,   b = N x/L + h T/L,   lateral = T
/// where x is counted from cell a.
struct Cells {
  double first_m = 0;                                       ///< place of cell a, from the drive edge
  double span_m = 0.3;                                      ///< L, distance from cell a to cell b
  double height_m = 0.0;                                    ///< h
  double normal_Hz = 60, lateral_Hz = 180, damping = 0.05;  ///< second-order resonances
  /// reading = crosstalk * force, for a, b and lateral
  std::array<std::array<double, 3>, 3> crosstalk{{{1, 0.02, -0.02}, {0.02, 1, 0.02}, {-0.02, 0.02, 1}}};
  std::array<double, 3> zero_N{};
  double drift_N_per_K = 1e-3;
  double volt_per_volt_N = 2e-4;  ///< bridge output per volt of excitation: 0.5 mV/N at 2.5 V
};

/// From the excitation to the converter. Distortion acts on the amplified voltage y: y + a2 y^2 + a3 y^3.
struct Wires {
  std::optional<int> carrier_channel = 3;    ///< playback channel of the bridges' excitation
  double excitation_V_per_full_scale = 2.5;  ///< peak
  double reference_V_at_full_scale = 3.0;    ///< excitation that fills the reference channel
  double gain = 200;                         ///< bridge amplifiers
  double full_scale_V = 2.1;                 ///< amplified voltage that fills a bridge's channel
  double crosstalk_V_per_full_scale = 4e-3;  ///< of the drive into each bridge; 1 mV for a tone of 0.25
  double a2_per_V = 1e-4, a3_per_V2 = 1e-4;
  double noise_V_per_rtHz = 4e-9;            ///< at the bridge
  double converter_noise_full_scale = 7e-6;  ///< rms of one sample of the reference (110 dB in 20 kHz)
  int bits = 24;
};

/// Capture channels. A channel that has no role carries zeros.
struct CaptureChannels {
  int count = 8;
  std::optional<int> reference = 0, bridge_a = 1, bridge_b = 2, lateral = 3, marker = 4;
};

/// The finger is on the surface between two frames of the laboratory: captured frames plus those lost in
/// gaps.
struct Touch {
  std::int64_t from_frame = 0, to_frame = kNever;
};

/// A finger that strokes to and fro. Each stroke has minimum jerk. The skin is a spring (contact_N_per_m)
/// that holds until friction * N is reached, and slides then.
struct Finger {
  std::vector<Touch> touches;
  double from_m = 0.06, to_m = 0.26;
  double stroke_s = 2.5;  ///< duration of one stroke; 0.2 m in 2.5 s are 80 mm/s on average, 150 at most
  double pause_s = 0.3;   ///< rest at each end
  double land_s = 0.05;   ///< time in which the force rises and falls
  double normal_N = 0.5;
  double normal_noise = 0.15;       ///< relative sd, pink, 0.1 to 25 Hz
  double friction = 0.8;            ///< coefficient on the resting surface
  double friction_drift_per_s = 0;  ///< friction is multiplied by exp(drift * time)
  double friction_noise = 0.08;     ///< relative sd, pink, 0.1 to 400 Hz
  double film_Hz = 300;             ///< friction follows the amplitude with this low-pass
  double contact_N_per_m = 1000;
  double fingertip_m = 0.010;  ///< the amplitude is the rms over this length
};

/// A dead weight, and a force along the surface, both at x. It is there besides the finger.
struct Load {
  double normal_N = 0, lateral_N = 0, x_m = 0;
};

enum class FaultKind {
  transducer_dead,  ///< `index`: the transducer
  transducer_half,  ///< half of its motion is left
  resonance_off,    ///< all resonances of the surface are higher by `amount` (0.03)
  frequency_off,    ///< the edge moves at frequencies that are higher by `amount` (0.03)
  drive_late,       ///< the drive comes later by `amount` seconds (0.005)
  clip,             ///< the amplifier clips at `amount` of full scale (0.5)
  broken_bridge,    ///< `index` 0, 1, 2: a wire of cell a, b or lateral is open
  no_reference,     ///< the reference channel carries noise only
  finger_lifts,     ///< there is no finger on the surface
  gap,              ///< `amount` captured frames are lost at `from_frame` (480)
  warmer            ///< surface and cells are warmer by `amount` kelvin (10)
};

/// "transducer dead", ...: the enumerators with spaces.
std::string_view name(FaultKind kind);
/// Empty if no kind has this name.
std::optional<FaultKind> find_fault(std::string_view name);

/// Lasts from one captured frame to another, the latter excluded.
struct Fault {
  FaultKind kind = FaultKind::transducer_dead;
  std::int64_t from_frame = 0, to_frame = kNever;
  std::optional<double> amount = {};  ///< the kind's default if empty
  int index = 0;
};

/// The laboratory: what is behind the converter's outputs and in front of its inputs.
struct Setup {
  int rate_Hz = 192000;
  int playback_channels = 4;
  std::vector<Transducer> transducers{{}};
  Wires wires;
  CaptureChannels capture;
  std::vector<Pickup> pickups{{5, 0.003}, {6, 0.009}};
  std::optional<int>
      marker_channel;  ///< playback channel that the marker's capture channel repeats bit by bit
  Cells cells;
  physics::Surface surface;
  physics::FrictionMap friction;
  Finger finger;
  double temperature_C = 23;
  double surface_temperature_C = 23;  ///< temperature for which `surface` holds
  /// Relative change of every length, and of Young's modulus, per kelvin. All resonances of a plate then
  /// change by half of the sum (of every length alone, they would fall; density falls too).
  double expansion_per_K = 2.3e-5, modulus_per_K = -4.8e-4;
  /// The pick-ups' response is fitted in this band.
  double band_low_Hz = 16000, band_high_Hz = 50000;
  /// From a played to a captured frame. A fraction needs at least 24 frames.
  double loop_delay_frames = 400;
  std::uint64_t seed = 1;
};

}  // namespace turnpoint::plant
