#pragma once
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "station/rig/rig.hpp"

namespace turnpoint::rig {

/// Files give angles in degrees, the program uses radians.
constexpr double kDegree_rad = std::numbers::pi / 180;

/// The position of a boundary that was measured at a frequency.
struct BoundaryPoint {
  double frequency_Hz = 0;
  double boundary_m = 0;
  double sd_m = 0;        ///< standard deviation of the measurement, above 0
  double residual_m = 0;  ///< measured minus fitted position
  /// distance from the position that the other boundaries predict, in standard deviations
  double deviation = 0;
  bool outlier = false;
  bool left_out = false;  ///< an outlier that the fit does not use
};

/// The result of fitting the rig's surface to measured boundaries.
struct BoundaryFit {
  /// which definition of the boundary was measured ("p50"), as physics::format() writes it
  std::string edge;
  std::vector<BoundaryPoint> points;
  SurfaceFit surface;
};

/// A person reads a few dozen; with more than this, the fit would run for minutes.
inline constexpr std::size_t kMostBoundaries = 1000;

/// Fits all parameters of the surface for which the rig file states a standard deviation (see
/// physics::fit_boundaries()). Throws core::UsageError for too many points, for points that cannot be used,
/// and for points that contradict the others or the rig so that no fit can say which of them are wrong; it
/// names them.
BoundaryFit fit_boundaries(const Rig& rig, const std::string& edge, std::vector<BoundaryPoint> points);

/// One frequency of a sweep: the drive edge's displacement at full scale and its phase.
struct ResponsePoint {
  double frequency_Hz = 0;
  double m_per_full_scale = 0;
  double phase_rad = 0;
};

/// A transducer's smoothed response: for each point, a parabola in frequency is fitted to the log amplitudes
/// and unwrapped phases of the nearest `window` points.
struct ResponseFit {
  std::vector<ResponsePoint> points;
  double residual_dB = 0;  ///< rms deviation of the measured points from the fit
  double residual_rad = 0;
  double low_Hz = 0, high_Hz = 0;  ///< band in which no tone needs more equalisation than equalisation_cap_dB
};

/// The largest amount by which equalisation raises a weak response. A frequency whose response is more than
/// this below the strongest one is outside the usable band.
inline constexpr double equalisation_cap_dB = 20;

/// Smooths the response that a sweep has measured. Throws core::UsageError for fewer than 5 points,
/// frequencies that do not ascend, or an amplitude that is not above 0.
ResponseFit fit_response(const std::vector<ResponsePoint>& sweep, int window = 5);

/// A resonance of the surface found in a sweep.
struct Resonance {
  double frequency_Hz = 0;
  double quality_factor = 0;
  double frequency_sd_Hz = 0, quality_sd = 0;  ///< standard errors; 0: unknown
};

/// Finds resonances by a linear fit: near a peak, 1/|u|^2 (u is the displacement) is a parabola in f whose
/// width is f0/2Q. Leaves out peaks with fewer than five points above half power. Also leaves out peaks at
/// which the phase does not turn, because they belong to the transducer and not to the surface.
std::vector<Resonance> find_resonances(const std::vector<ResponsePoint>& sweep);

/// Median quality factor; empty without resonances.
std::optional<double> quality_of(const std::vector<Resonance>& resonances);

/// One point of a curve of relative friction over displacement. The fitted curve begins at (0, 1) and falls
/// strictly: where the measured friction does not fall, neighbours are pooled into one point.
struct FrictionPoint {
  double displacement_m = 0;
  double relative_friction = 0;
};
struct FrictionFit {
  std::vector<FrictionPoint> points;
  double residual = 0;  ///< rms of measured minus fitted relative friction
};

/// A measured point that is further from the fitted curve contradicts it: friction does not rise with
/// displacement, and it is 1 at displacement 0.
inline constexpr double largest_friction_miss = 0.15;

/// Fits friction that falls with displacement. Throws core::UsageError for fewer than two displacements, for
/// values outside rig::kLeastFriction to 1.5, and for points that contradict the curve, which it names.
FrictionFit fit_friction(std::vector<FrictionPoint> measured);

}  // namespace turnpoint::rig
