#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "station/plant/cells.hpp"
#include "station/plant/condition.hpp"
#include "station/plant/delay.hpp"
#include "station/plant/finger.hpp"
#include "station/plant/lock_in.hpp"
#include "station/plant/pickup_response.hpp"
#include "station/plant/setup.hpp"
#include "station/plant/wires.hpp"

namespace turnpoint::plant {

/// What really happens, at the frame that was captured last.
struct Truth {
  std::int64_t frame = -1;             ///< captured frame
  double normal_N = 0, lateral_N = 0;  ///< on the surface: finger and load together
  FingerState finger;                  ///< at the step that began last (an eighth of a ms)
  CellForces reading_N{};              ///< after resonance, crosstalk, zero and drift: what the bridges show
  double drive_um = 0;                 ///< displacement of the drive edge now
  double amplitude_um = 0;             ///< of the surface under the finger, rms over the fingertip, all tones
  double temperature_C = 0;
};

/// Simulates the laboratory behind the converter: transducers, surface, pick-ups, finger, force cells,
/// bridges and wires. What the station played goes in, what it captures comes out.
///
/// The pick-ups respond to the played signal itself, whatever it is. The finger feels only the tones that
/// were named by set_tones(): their amplitudes are measured in what was played, and weighted by the model
/// `mode`.
///
/// Deterministic: the same setup, samples and calls give the same captured samples, however they are divided
/// into blocks. Not thread-safe.
class Plant {
 public:
  /// Throws std::invalid_argument for a channel that does not exist or is used twice, a rate below 8000 Hz, a
  /// delay that is too short, or a surface without loss.
  explicit Plant(const Setup& setup);

  /// The frequencies that may be played from now on. Solves the surface for those that are new (0.1 ms each,
  /// thick plates 20 ms), so call it between two trials; tones that stay are followed without a break.
  void set_tones(std::vector<double> frequency_Hz);
  /// Adds a fault. It must begin at a frame that was not captured yet.
  void add(const Fault& fault);
  /// Ends all faults with the next captured frame.
  void repair();
  /// Puts this load on the surface, or takes it away, from the next frame on.
  void set_load(const Load& load) { load_ = load; }

  /// Takes interleaved samples of the playback channels, full scale 1, and gives as many frames of the
  /// capture channels. Throws std::invalid_argument if the sizes do not match. Does not allocate.
  void advance(std::span<const double> played, std::span<double> captured);

  const Setup& setup() const { return setup_; }
  const Truth& truth() const { return truth_; }
  /// Frames captured so far.
  std::int64_t frames() const { return captured_; }
  /// Displacement of the drive edge by a named tone, as its lock-in sees it (um, 5 ms late):
  /// Re(z exp(2 pi i f n / rate)) at frame n of the world.
  std::complex<double> tone_um(std::size_t tone) const;
  /// rms over the fingertip of the displacement at x, per displacement of the drive edge.
  double gain_at(std::size_t tone, double x_m) const;
  /// Displacement at a pick-up per displacement of the drive edge, without the fault frequency_off.
  std::complex<double> pickup_response(std::size_t pickup, double frequency_Hz) const;
  /// Largest error of the pick-ups' response in its band, against the surface's model.
  double pickup_error() const { return filters_.front().second.fit_error(); }

 private:
  /// Mean square over the fingertip, per square of the drive edge, in steps of kGain_m along the surface.
  using Gains = std::vector<double>;
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
  void write(std::span<double> out);

  Setup setup_;
  int step_frames_;
  std::int64_t whole_delay_;
  std::vector<Fault> faults_;
  SurfaceResponse response_;
  std::map<double, Gains> gains_;                         // by frequency over resonance factor
  std::vector<std::pair<double, PickupFilter>> filters_;  // by resonance factor
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
  std::int64_t captured_ = 0;  // frames given to the station
  std::int64_t played_ = 0;
  std::int64_t world_ = 0;    // frames that passed in the laboratory; more after a gap
  CellForces from_{}, to_{};  // forces of the finger at the ends of this step
  double amplitude_um_ = 0;
  Truth truth_;
};

}  // namespace turnpoint::plant
