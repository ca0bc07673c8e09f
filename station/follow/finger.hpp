#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "station/follow/delay.hpp"

namespace turnpoint::follow {

/// Why the surface cannot follow the finger at this moment. If several are true, the first in this list is
/// given.
enum class Fault : std::uint8_t {
  none,
  late,       ///< frames were left out, or the newest sample is too old, or newer than it can be
  reference,  ///< the amplitude of the bridges' excitation is more than 3 % off
  force,   ///< captured frames are missing or come again, a bridge is overloaded, has a wire off, or is dead
  lifted,  ///< the finger is not on the surface
  position,  ///< the normal force is too small to tell the place, the place is beyond the strip, or it jumped
  saturated  ///< friction below the finger's reach has been asked of the loop for most of the last 0.2 s
};
inline constexpr int kFaults = 7;
const char* name(Fault fault) noexcept;

/// Forces on the surface at one point in time. The place of the finger is moment_Nm / normal_N, from the wide
/// edge. lateral_N is positive if the finger pulls towards larger places.
struct FingerSample {
  std::int64_t frame = 0;  ///< playback frame at the centre of the window
  double normal_N = 0, lateral_N = 0, moment_Nm = 0;
  Fault fault = Fault::none;  ///< none, reference or force
};

/// How the force cells are wired and calibrated; the same conventions as sensing::BridgeOptions and
/// sensing::ForceCalibration, in SI units.
struct Bridges {
  double carrier_Hz = 10525;
  int channels = 4;                     ///< number of channels in a captured frame
  int reference = 0;                    ///< captured channel of the excitation itself
  std::array<int, 3> bridges{1, 2, 3};  ///< captured channels of cells a and b and of the lateral cell
  double reference_amplitude = 0.5;     ///< full scale is 1
  std::array<double, 3> full_scale{0.4, 0.4, 0.4};  ///< ratio to the reference at the rated load
  std::array<double, 3> rotation_rad{};             ///< phase of each bridge against the reference
  std::array<double, 3> tare{};                     ///< ratios without a finger
  /// Rows: ratios of a, b and lateral after the tare; columns: normal force, lateral force (N), moment (N
  /// m). sensing::ForceCalibration has the moment in N mm, so its values must be multiplied by 1e-3.
  std::array<std::array<double, 3>, 3> matrix{};
};

/// The short path from captured frames to forces. It mixes the newest window_frames frames down from the
/// carrier, weighted by a Blackman-Harris window (Harris 1978: side lobes below -92 dB), and divides by the
/// reference. A force from half a window ago is the result, so the delay is 0.75 ms. A drive tone 2.7 kHz (4
/// / window) or more from the carrier leaks with less than 3e-5 of its amplitude. The noise bandwidth is 1.3
/// kHz. These figures are those of a window of 1.5 ms, as timing_of() gives it. Today's path
/// (BridgeDemodulator) has 17 ms of delay and stays for the record. Fixed size.
class BridgeWindow {
 public:
  static constexpr int kMostFrames = 1024;

  BridgeWindow() = default;
  /// Throws std::invalid_argument for a window of fewer than 32 or more than 1024 frames, for channels that
  /// do not exist, and for a carrier that is nearer than 4 / window to 0, to half the rate, or to one of the
  /// tones of the drive.
  BridgeWindow(const Bridges& bridges, const Timing& timing, std::span<const double> drive_Hz);

  /// Takes frames, of which the first has the number `first` in the playback's clock. Frames that are left
  /// out empty the window. 32 equal samples of a bridge in a row, or 32 frames that equal those of the push
  /// before, are a fault for as long as one of them is in the window. (BridgeDemodulator, for the record,
  /// also finds blocks of other lengths that come again.)
  void push(std::int64_t first, const std::int32_t* frames, int count) noexcept;
  /// The force at the centre of the newest window. Fault::force until the window is full.
  FingerSample sample() const noexcept;

 private:
  Bridges bridges_;
  int window_frames_ = 0;
  std::array<float, kMostFrames> cosine_{}, sine_{};      ///< window times carrier
  std::array<std::array<float, 4>, kMostFrames> kept_{};  ///< newest frames in a ring: reference, bridges
  std::array<std::int32_t, 3> last_{};
  std::array<int, 3> unchanged_{};  ///< how many samples of a bridge in a row were the same
  int repeated_ = 0;                ///< how many frames in a row were those of the push before
  std::int64_t dead_until_ = 0;     ///< frame number behind the last frame that was dead or came again
  std::int64_t end_ = 0;            ///< frame number behind the newest frame
  int filled_ = 0, next_ = 0;
};
static_assert(std::is_trivially_copyable_v<BridgeWindow>);

/// How the place is estimated.
struct EstimatorSettings {
  int rate_Hz = 192000;
  double first_m = 0, last_m = 0;   ///< the strip; a place more than 3 mm beyond it is lost
  double moment_noise_Nm = 1.2e-4;  ///< standard deviation of the moment in one sample
  /// Spectral density of the finger's acceleration (m2/s3). With 0.02 the place follows with about 26 Hz at
  /// 0.5 N.
  double acceleration_density = 0.02;
  /// How far the skin is stretched per lateral force (m/N); 0 for a rigid finger. The place of the contact is
  /// the finger's minus the stretch. The finger moves smoothly, but where friction varies along the strip,
  /// the contact does not: it stays behind while friction rises, and jumps ahead when it falls. So the finger
  /// is filtered and predicted, and the stretch is added to it.
  double skin_m_per_N = 1e-3;
  double least_normal_N = 0.1;  ///< below it, the place is lost
  double contact_N = 0.05, release_N = 0.03;
};

/// The finger at the frame of the newest sample. Place and speed are meaningless while Fault::lifted or
/// Fault::position is given.
struct Finger {
  std::int64_t frame = 0;
  double place_m = 0, speed_m_s = 0;  ///< of the finger; the contact is skin_m_per_N * lateral_N behind it
  double normal_N = 0, lateral_N = 0;
  double travelled_m = 0;  ///< since contact or the last change of direction
  bool contact = false;
  Fault fault = Fault::lifted;
};

/// Estimates place and speed by a Kalman filter for constant speed with random acceleration (Bar-Shalom, Li &
/// Kirubarajan 2001, section 6.2). The variance of a measured place is (moment noise / normal force)^2, so a
/// light finger is filtered more. Windows of 1.5 ms in periods of 0.5 ms overlap, so their noise is
/// correlated, but the filter takes it as independent: with shorter periods the place gets noisier. It has no
/// lag at constant speed, also for predictions; an acceleration a lags by about a/w^2, where w^4 = density /
/// (variance times sample interval).
class FingerEstimator {
 public:
  FingerEstimator() = default;
  /// Throws std::invalid_argument for values that are not finite or not possible.
  explicit FingerEstimator(const EstimatorSettings& settings);

  /// Takes the next sample.
  const Finger& push(const FingerSample& sample) noexcept;
  const Finger& finger() const noexcept { return finger_; }
  /// The finger's place at a frame (which may have a fraction), if it keeps its speed.
  double place_at(double frame) const noexcept {
    return finger_.place_m +
           finger_.speed_m_s * (frame - static_cast<double>(finger_.frame)) / settings_.rate_Hz;
  }

 private:
  void start(double place_m, double variance) noexcept;
  void follow(double measured_m, double variance, double step_s) noexcept;

  EstimatorSettings settings_;
  Finger finger_;
  bool knows_place_ = false;
  int jumps_ = 0;
  double pp_ = 0, pv_ = 0, vv_ = 0;  ///< covariance of place and speed
};
static_assert(std::is_trivially_copyable_v<FingerEstimator>);

}  // namespace turnpoint::follow
