#pragma once
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace turnpoint::calibration {

/// One degree in radians: files have degrees, the program radians.
constexpr double kDegree_rad = std::numbers::pi / 180;

/// A boundary that was seen or felt: where, for which frequency; `sd_m` is its standard uncertainty (0: not
/// known).
struct BoundaryPoint {
  double frequency_Hz = 0;
  double boundary_m = 0;
  double sd_m = 0;
};

/// x = apex - constant f^-exponent: every lossless feature of a linear taper moves along it, with exponent 1
/// on a membrane and 1/2 on a plate; in between, tension and bending both matter.
struct BoundaryFit {
  double apex_m = 0, apex_sd_m = 0;
  double constant = 0, constant_sd = 0;  ///< m Hz^exponent
  double exponent = 1;
  double residual_m = 0;            ///< rms; 0 with two points
  std::vector<double> residuals_m;  ///< of each point
  /// Residual with the exponents 1 and 1/2; with three points or more the smaller one tells membrane from
  /// plate.
  double membrane_residual_m = 0, plate_residual_m = 0;
  enum class Law { membrane, plate } law = Law::membrane;
  /// Curvature against 1/f in standard errors (four points or more): above 2 bending shows.
  std::optional<double> curvature_z;
};

/// Least squares, weighted where all uncertainties are known. `law` says which surface it is; without it
/// three points decide. Throws terms::UsageError: fewer than two points (three without a law), equal
/// frequencies.
BoundaryFit fit_boundaries(const std::vector<BoundaryPoint>& points, std::optional<BoundaryFit::Law> law);

/// Where the fitted law puts the boundary.
double boundary_at(const BoundaryFit& fit, double frequency_Hz);

/// One frequency of a sweep: displacement of the drive edge at full scale and its phase.
struct ResponsePoint {
  double frequency_Hz = 0;
  double m_per_full_scale = 0;
  double phase_rad = 0;
};

/// A response for use: smoothed locally (quadratic in frequency over `window` points, in log amplitude and
/// unwrapped phase).
struct ResponseFit {
  std::vector<ResponsePoint> points;
  double residual_dB = 0;  ///< rms of the measured points about it
  double residual_rad = 0;
  double low_Hz = 0, high_Hz = 0;  ///< where equalisation stays within the cap
};

/// Highest equalisation: a drive that needs more than this above its best frequency is outside the band.
inline constexpr double equalisation_cap_dB = 20;

/// Throws terms::UsageError: fewer than 5 points, not rising, an amplitude that is not above 0.
ResponseFit fit_response(const std::vector<ResponsePoint>& sweep, int window = 5);

/// A resonance of the surface seen in a sweep.
struct Resonance {
  double frequency_Hz = 0;
  double quality_factor = 0;
};

/// Resonances by a straight line: about a peak 1/|u|^2 is a parabola in f, whose width is f0/2Q. Peaks with
/// fewer than five points above half power are left out, and those where the phase does not turn: they are
/// the transducer's, not the surface's.
std::vector<Resonance> find_resonances(const std::vector<ResponsePoint>& sweep);

/// Median quality factor; none without resonances.
std::optional<double> quality_of(const std::vector<Resonance>& resonances);

/// Relative friction against displacement, made monotone (falling) by pooling adjacent violators.
struct FrictionPoint {
  double displacement_m = 0;
  double relative_friction = 0;
};
struct FrictionFit {
  std::vector<FrictionPoint> points;
  double residual = 0;  ///< rms
};

/// Throws terms::UsageError: fewer than two displacements, values outside 0 to 1.5.
FrictionFit fit_friction(std::vector<FrictionPoint> measured);

}  // namespace turnpoint::calibration
