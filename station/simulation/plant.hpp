#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "station/simulation/cells.hpp"
#include "station/simulation/condition.hpp"
#include "station/simulation/delay.hpp"
#include "station/simulation/finger.hpp"
#include "station/simulation/lock_in.hpp"
#include "station/simulation/pickup_response.hpp"
#include "station/simulation/setup.hpp"
#include "station/simulation/wires.hpp"

namespace turnpoint::simulation {

/// The true state of the laboratory at the frame that was captured last.
struct Truth {
  std::int64_t frame = -1;             ///< number of the frame that was captured last; -1 before the first
  double normal_N = 0, lateral_N = 0;  ///< forces on the surface, from finger and load together
  /// state of the finger at the beginning of the newest step; a step is an eighth of a millisecond
  FingerState finger;
  /// readings of the force cells that the bridges measure, with the cells' resonance, crosstalk, zero and
  /// drift
  CellForces reading_N{};
  double drive_um = 0;      ///< displacement of the drive edge at this frame
  double amplitude_um = 0;  ///< amplitude of all tones under the finger, rms over the fingertip
  double temperature_C = 0;
};

/// Simulates the laboratory behind the converter: transducers, surface, pick-ups, finger, force cells,
/// bridges and wires. Its input is what the station plays; its output is what the station captures.
///
/// The pick-ups respond to any played signal. The finger feels only the tones that set_tones() named. Their
/// amplitudes at the drive edge are measured in the played signal, and the model `mode` gives the amplitudes
/// under the finger. The finger's impedance reduces them by one factor under the whole fingertip, that of its
/// place (physics::finger_load()), however hard it presses. Each part of the fingertip has the friction of
/// the amplitude below it, and all parts press equally, so the finger's friction is their mean. The pick-ups,
/// near the drive edge, do not notice the finger.
///
/// Deterministic: the same setup, samples and calls give the same captured samples, however they are divided
/// into blocks. Not thread-safe.
class Plant {
 public:
  /// Throws std::invalid_argument for a channel that does not exist or is used twice, a rate below 8000 Hz, a
  /// delay that is too short, or a surface without loss.
  explicit Plant(const Setup& setup);

  /// Names the tones that the finger can feel from now on. Solves the surface for new frequencies (0.1 ms
  /// each, 20 ms for a thick plate), so call it between trials. Tones that were already named are followed
  /// without interruption. The finger feels their amplitudes half a `window_s` late; a shorter window than 10
  /// ms needs tones that are further apart (LockIn).
  void set_tones(std::vector<double> frequency_Hz, double window_s = 0.01);
  /// The impedance with which the finger loads the surface from now on (Finger::impedance_Ns_per_m). Solves
  /// the surface again for all tones, so call it between trials.
  void set_impedance(std::complex<double> impedance_Ns_per_m);
  /// Adds a fault. It must begin at a frame that has not been captured yet.
  void add(const Fault& fault);
  /// Ends all faults with the next captured frame.
  void repair();
  /// The finger touches the surface for this many frames, beginning with the next captured frame, and starts
  /// a new sequence of strokes. Earlier touches are forgotten.
  void touch(std::int64_t frames);
  /// Makes the finger leave the surface after this many frames, unless its touch ends earlier.
  void lift(std::int64_t frames);
  /// From now on, the finger's force and friction no longer vary at random.
  void steady_finger() { finger_.steady(); }
  /// Replaces the load on the surface from the next frame on. An empty load removes it.
  void set_load(const Load& load) { load_ = load; }

  /// Takes interleaved samples of the playback channels (full scale 1), and writes the same number of frames
  /// of the capture channels. Throws std::invalid_argument if the sizes do not match. Does not allocate.
  void advance(std::span<const double> played, std::span<double> captured);

  const Setup& setup() const { return setup_; }
  const Truth& truth() const { return truth_; }
  /// Number of frames captured so far.
  std::int64_t frames() const { return captured_; }
  /// Returns the complex amplitude z (um) with which this tone (an index) moves the drive edge, as it was
  /// half a window ago. The motion at frame n of the laboratory is Re(z exp(2 pi i f n / rate)).
  std::complex<double> tone_um(std::size_t tone) const;
  /// Displacement under a fingertip at x, which loads the surface (rms over its length), per displacement of
  /// the drive edge.
  double gain_at(std::size_t tone, double x_m) const;
  /// Displacement at a pick-up per displacement of the drive edge, which moves at `frequency_Hz`. With
  /// FaultKind::frequency_off, this differs from the frequency that is played.
  std::complex<double> pickup_response(std::size_t pickup, double frequency_Hz) const;
  /// Frequency (Hz) and quality factor of each simulated resonance.
  std::vector<std::pair<double, double>> resonances() const { return filters_[filter_].second.resonators(); }
  /// Largest difference, within the band, between the simulated response of a pick-up and the surface's
  /// model.
  double pickup_error() const { return filters_.front().second.fit_error(); }

 private:
  /// The squared displacement without a finger and its mean over the fingertip, both relative to the squared
  /// displacement of the drive edge, and the share of the square that a finger at this place leaves, at
  /// positions kGain_m apart.
  struct Gains {
    std::vector<double> squares, under_fingertip, share;
  };
  static constexpr double kGain_m = 0.5e-3;
  struct Tone {
    LockIn lock_in;
    const Gains* gains;
  };

  const Gains& gains_for(double frequency_Hz);
  std::size_t filter_for(double resonance);
  void prepare();
  void change(std::int64_t frame);
  double edge_um(double& full_scale) const;
  double shifted_edge_um() const;
  void begin_step();
  void next_frame(std::span<double> out);
  double amplitude_um(double x_m) const;
  double amplitude_um_at_point(double x_m, double finger_m) const;
  double relative_friction(double x_m) const;
  void write(std::span<double> out);

  Setup setup_;
  int step_frames_;
  std::int64_t whole_delay_;
  std::vector<Fault> faults_;
  SurfaceResponse response_;
  std::map<double, Gains> gains_;  // gains for each frequency, which is divided by Condition::resonance
  // each value of Condition::resonance that the faults lead to, with the filter for it
  std::vector<std::pair<double, PickupFilter>> filters_;
  std::size_t filter_ = 0;
  std::vector<Tone> tones_;
  std::vector<Delay> transducer_delays_, carrier_delay_, marker_delay_;
  WiresModel wires_;
  CellReadings cells_;
  FingerModel finger_;
  std::vector<Noise> pickup_noise_;
  Load load_;
  Condition now_;
  std::int64_t next_change_ = 0;
  std::int64_t captured_ = 0;  // number of frames that the station has captured
  std::int64_t played_ = 0;
  std::int64_t world_ = 0;    // number of frames simulated; larger than captured_ after a gap
  CellForces from_{}, to_{};  // forces of the finger at the beginning and end of this step
  double amplitude_um_ = 0;
  Truth truth_;
};

}  // namespace turnpoint::simulation
