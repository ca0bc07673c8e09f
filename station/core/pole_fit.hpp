#pragma once
#include <complex>
#include <span>
#include <vector>

namespace turnpoint::core {

/// One resonance. It contributes the term weight / (frequency - pole) to the response to a tone; the pole is
/// at frequency_Hz (1 + i / (2 quality_factor)).
struct FittedPole {
  double frequency_Hz = 0, quality_factor = 0;
  /// Standard errors. They include the distance that the pole moves if another number of poles is fitted.
  double frequency_sd_Hz = 0, quality_sd = 0;
  std::complex<double> weight;
  double weight_share = 0;  ///< standard error of the weight, relative to its size
};

/// A response as a sum of resonances and a background that changes slowly (a parabola in frequency).
struct PoleFit {
  std::vector<FittedPole> poles;  ///< in order of frequency; includes those that only improve the background
  std::vector<std::complex<double>> fitted;  ///< fitted response at the frequencies of the measurement
  std::vector<double> fitted_sd;             ///< standard errors of `fitted` (rms of the complex number)
  double residual = 0;                       ///< rms of measured minus fitted

  /// The resonances inside the measured range that the data determine: quality factor to 25 %, weight to
  /// 10 %.
  std::vector<FittedPole> resonances() const;
};

/// Fits poles by vector fitting (B. Gustavsen, A. Semlyen, IEEE Trans. Power Delivery 14 (1999) 1052), with
/// as many poles as the Bayesian information criterion prefers, at most `most_poles`. Standard errors assume
/// an rms error of at least `noise` (complex) for each point, even if the residual is smaller. Frequencies
/// ascend. Throws UsageError for fewer than 20 points.
PoleFit fit_poles(std::span<const double> frequency_Hz, std::span<const std::complex<double>> response,
                  double noise, int most_poles = 24);

}  // namespace turnpoint::core
