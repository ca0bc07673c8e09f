#pragma once
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "station/audio/burst.hpp"

namespace turnpoint::sensing {

/// Within this distance of the lowest and the highest frequency of a chirp, the ratio of captured to played
/// spectrum does not give the response.
inline constexpr double kSweepMargin_Hz = 600;

/// A slow chirp on one output channel, from which the responses of the pick-ups are computed. It must be slow
/// compared with the resonances: (rate of change of frequency) << (f / Q)^2.
struct Sweep {
  int rate_Hz = 192000;
  /// The band in which the response is computed. The chirp is kSweepMargin_Hz wider on both sides.
  double low_Hz = 22000, high_Hz = 46000;
  double length_s = 3;
  double amplitude = 0.1;  ///< amplitude as a fraction of full scale
  int channel = 0;         ///< output channel on which it is played

  std::int64_t frames() const { return static_cast<std::int64_t>(length_s * rate_Hz); }
};

/// Returns the sweep as a burst that any stream can play.
audio::Burst sweep_burst(const Sweep& sweep, std::int64_t start_frame);

/// A recording must contain this much silence before and after the sweep.
inline constexpr double kSweepQuiet_s = 0.3;

struct SweepPoint {
  double frequency_Hz = 0;
  /// captured complex amplitude for a tone of full scale; the loop delay is removed
  std::complex<double> response;
};

/// The response to a sweep, and the noise in it.
struct SweepResponse {
  std::vector<SweepPoint> points;  ///< one response every 20 Hz
  double noise = 0;                ///< rms error of one (complex) response, from the noise before the sweep
  double largest_sample = 0;       ///< largest captured sample; 1 is full scale
};

/// Computes the response of one pick-up. `played` holds the samples of the sweep, from its first frame on.
/// `captured` holds the samples of one pick-up and starts kSweepQuiet_s before the frame at which the sweep
/// was played; it must reach kSweepQuiet_s beyond the sweep. What is played at frame n is captured at frame n
/// + delay_frames.
///
/// For each frequency, both signals are Fourier transformed over 0.18 s around the time at which the sweep
/// passes this frequency; the response is the ratio. So noise and distortion products at other times have no
/// effect.
SweepResponse sweep_response(const Sweep& sweep, std::span<const double> played,
                             std::span<const double> captured, double delay_frames);

}  // namespace turnpoint::sensing
