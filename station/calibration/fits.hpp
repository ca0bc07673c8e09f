#pragma once
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace turnpoint::calibration {

/// Files give angles in degrees, the program uses radians.
constexpr double kDegree_rad = std::numbers::pi / 180;

/// The position of a boundary that was seen or felt at a frequency. `sd_m` is its standard uncertainty (0:
/// not known).
struct BoundaryPoint {
  double frequency_Hz = 0;
  double boundary_m = 0;
  double sd_m = 0;
};

/// A boundary's position x as a function of frequency f: x = apex - constant f^-exponent. Without loss, the
/// boundaries on a linear taper follow this law, with exponent 1 on a membrane and 1/2 on a plate. If both
/// tension and bending matter, the exponent lies in between.
struct BoundaryFit {
  double apex_m = 0, apex_sd_m = 0;
  double constant = 0, constant_sd = 0;  ///< m Hz^exponent
  double exponent = 1;
  double residual_m = 0;            ///< rms of the residuals; 0 with two points
  std::vector<double> residuals_m;  ///< measured minus fitted position of each point
  /// Rms of the residuals with the exponents 1 and 1/2. With three or more points, the smaller one tells
  /// membrane from plate.
  double membrane_residual_m = 0, plate_residual_m = 0;
  enum class Law { membrane, plate } law = Law::membrane;
  /// Quadratic coefficient of a parabola in 1/f divided by its standard error; empty with fewer than four
  /// points. A value above 2 indicates bending.
  std::optional<double> curvature_z;
};

/// Fits the law by least squares, weighted if all uncertainties are known. `law` says whether the surface is
/// a membrane or a plate; without it, at least three points are needed to find out. Throws terms::UsageError
/// for fewer than two points (three without a law) and for equal frequencies.
BoundaryFit fit_boundaries(const std::vector<BoundaryPoint>& points, std::optional<BoundaryFit::Law> law);

/// Returns the position of the boundary according to the fitted law.
double boundary_at(const BoundaryFit& fit, double frequency_Hz);

/// One frequency of a sweep: displacement of the drive edge at full scale and its phase.
struct ResponsePoint {
  double frequency_Hz = 0;
  double m_per_full_scale = 0;
  double phase_rad = 0;
};

/// A transducer's smoothed response: for each point, a parabola in frequency is fitted to the log amplitudes
/// and unwrapped phases of the nearest `window` points.
struct ResponseFit {
  std::vector<ResponsePoint> points;
  double residual_dB = 0;  ///< rms deviation of the measured points
  double residual_rad = 0;
  double low_Hz = 0, high_Hz = 0;  ///< band in which equalisation stays within equalisation_cap_dB
};

/// The largest equalisation. A frequency that needs more than this, relative to the best frequency, is
/// outside the band.
inline constexpr double equalisation_cap_dB = 20;

/// Smooths a sweep. Throws terms::UsageError for fewer than 5 points, frequencies that do not ascend, or an
/// amplitude that is not above 0.
ResponseFit fit_response(const std::vector<ResponsePoint>& sweep, int window = 5);

/// A resonance of the surface found in a sweep.
struct Resonance {
  double frequency_Hz = 0;
  double quality_factor = 0;
};

/// Finds resonances by a linear fit: near a peak, 1/|u|^2 is a parabola in f whose width is f0/2Q. Leaves out
/// peaks with fewer than five points above half power. Also leaves out peaks at which the phase does not
/// turn, because they belong to the transducer and not to the surface.
std::vector<Resonance> find_resonances(const std::vector<ResponsePoint>& sweep);

/// Median quality factor; empty without resonances.
std::optional<double> quality_of(const std::vector<Resonance>& resonances);

/// Relative friction as a function of displacement, made monotonically decreasing by pooling adjacent
/// violators.
struct FrictionPoint {
  double displacement_m = 0;
  double relative_friction = 0;
};
struct FrictionFit {
  std::vector<FrictionPoint> points;
  double residual = 0;  ///< rms of measured minus fitted relative friction
};

/// Fits friction that never rises with displacement. Throws terms::UsageError for fewer than two
/// displacements, or values outside 0 to 1.5.
FrictionFit fit_friction(std::vector<FrictionPoint> measured);

}  // namespace turnpoint::calibration
