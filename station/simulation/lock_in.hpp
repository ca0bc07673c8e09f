#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>

namespace turnpoint::simulation {

/// Follows the amplitude of one tone in a signal, with a Hann window. With one of 10 ms, a neighbouring tone
/// at a distance of 1.05 kHz leaks in with 6e-4 of its amplitude. The amplitude is delayed by half the
/// window.
class LockIn {
 public:
  static constexpr int kWindow = 80;  ///< largest number of steps in the Hann window: 10 ms

  /// `step_frames` is the number of frames in a step (an eighth of a ms). The samples of a step are summed
  /// before the window of `window_steps` steps, from 1 to kWindow, is applied.
  LockIn(double frequency_Hz, int rate_Hz, int step_frames, int window_steps = kWindow);

  double frequency_Hz() const { return frequency_Hz_; }
  int window_steps() const { return window_steps_; }
  /// Call this at the first frame of each step. The phase is computed from the frame number, so it never
  /// drifts.
  void begin_step(std::int64_t frame);
  void add(double sample) {
    sum_ += sample * rotor_;
    const double re = rotor_.real() * turn_.real() - rotor_.imag() * turn_.imag();
    rotor_ = {re, rotor_.real() * turn_.imag() + rotor_.imag() * turn_.real()};
  }
  /// The tone is Re(amplitude exp(2 pi i f frame / rate)). The amplitude changes every tenth of a window, and not
  /// within a step.
  std::complex<double> amplitude() const { return amplitude_; }

 private:
  double frequency_Hz_;
  double cycles_per_frame_;
  int window_steps_;
  std::size_t every_;  ///< steps between two amplitudes
  double scale_;
  std::complex<double> turn_, rotor_{}, sum_{}, amplitude_{};
  std::array<std::complex<double>, kWindow> steps_{};
  std::array<double, kWindow> window_{};
  std::size_t next_ = 0;
};

/// exp(2 pi i cycles_per_frame frame), accurate for large frame numbers too.
std::complex<double> phasor(double cycles_per_frame, std::int64_t frame);

}  // namespace turnpoint::simulation
