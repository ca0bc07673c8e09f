#pragma once
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "station/drive/burst.hpp"

namespace turnpoint::sensing {

/// Distance from the ends of a chirp within which the ratio of the two spectra is not the response.
inline constexpr double kSweepMargin_Hz = 600;

/// A slow chirp on one output channel, from which the responses of the pick-ups are computed. It must be slow
/// compared with the resonances: (rate of change of frequency) << (f / Q)^2.
struct Sweep {
  int rate_Hz = 192000;
  /// The band in which the response is computed. The chirp is kSweepMargin_Hz wider on both sides.
  double low_Hz = 22000, high_Hz = 46000;
  double length_s = 3;
  double amplitude = 0.1;  ///< fraction of full scale
  int channel = 0;         ///< output channel

  std::int64_t frames() const { return static_cast<std::int64_t>(length_s * rate_Hz); }
};

/// The sweep as a burst that any stream can play.
drive::Burst sweep_burst(const Sweep& sweep, std::int64_t start_frame);

/// These parts of a recording are needed before and after the sweep. Nothing may be played in them.
inline constexpr double kSweepQuiet_s = 0.3;

struct SweepPoint {
  double frequency_Hz = 0;
  std::complex<double> response;  ///< captured complex amplitude for a tone of full scale, without the delay
};

/// The response to a sweep, and the noise in it.
struct SweepResponse {
  std::vector<SweepPoint> points;  ///< every 20 Hz
  double noise = 0;           ///< rms of the error of one response (complex), from the quiet before the sweep
  double largest_sample = 0;  ///< 1 is full scale of the capture
};

/// Computes the response. `played` holds the samples of the sweep, from its first frame on. `captured` holds
/// the samples of one pick-up and starts kSweepQuiet_s before the frame at which the sweep was played; it
/// must reach kSweepQuiet_s beyond the sweep. What is played at frame n is captured at frame n +
/// delay_frames.
///
/// For each frequency, both signals are Fourier transformed over 0.18 s around the time at which the sweep
/// passes this frequency; the response is the ratio. So noise and products at other times do not count.
SweepResponse sweep_response(const Sweep& sweep, std::span<const double> played,
                             std::span<const double> captured, double delay_frames);

}  // namespace turnpoint::sensing
