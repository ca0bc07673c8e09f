#pragma once
// The centre-line displacement of one tone. Every model that has a profile implements this interface.
#include <complex>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/taylor_march.hpp"

namespace turnpoint::physics {

// The displacement v(x) along the centre line, up to a constant factor. Functions marked const are
// thread-safe.
class CentreLine {
 public:
  virtual ~CentreLine() = default;
  virtual Scaled value(double x_m) const = 0;
  virtual Scaled slope(double x_m) const = 0;  // the derivative dv/dx
  // Computes values at many points; see TaylorMarch::evaluate for the arguments. This default version calls
  // value() for each point.
  virtual void evaluate(std::span<const double> x_m, std::complex<double> phase_reference,
                        double ln_reference, std::span<std::complex<double>> v,
                        std::span<double> ln_amplitude) const;
  virtual std::optional<double> last_peak_m() const = 0;
  // Outermost point at which |v| is `level` times its last maximum; empty if there is none.
  virtual std::optional<double> level_m(double level) const = 0;
  // Factor by which the division by v(0) amplifies errors: the envelope of the standing wave at the drive
  // edge, divided by |v(0)|.
  virtual double drive_conditioning(double wavenumber_per_m) const;
};

// Whether losses are included (see Dispersion::loss) or left out.
enum class Losses { kept, left_out };

// Makes the centre line for a model. Throws std::invalid_argument for Model::edge, which has no profile, and
// std::domain_error if the model does not apply.
std::unique_ptr<CentreLine> make_centre_line(const Surface& surface, double frequency_Hz, Model model,
                                             Losses losses = Losses::kept);

// Position where the local cut-off of the first transverse mode equals the frequency; empty if outside [0,
// length_m].
std::optional<double> turning_point_m(const Surface& surface, double frequency_Hz);

// Returns the surface without its outer part, where the first mode has decayed by more than a factor of e^45
// beyond its turning point. Edges and resonances do not depend on that part, and on a long exponential taper
// solving it would take millions of steps.
Surface moving_part(const Surface& surface, double frequency_Hz);

// The equation that the model `mode` solves step by step.
MarchEquation march_equation(const Surface& surface, double frequency_Hz, Losses losses);

// The most exact single equation for the first transverse mode. On a linear taper of slope d its solution is
// the two-dimensional mode of the wedge, J_nu(k s) with nu = pi / (2 atan d). On other tapers it is the
// equation of the model `mode`.
MarchEquation best_equation(const Surface& surface, double frequency_Hz, Losses losses);

// Makes a centre line by solving the given equation.
std::unique_ptr<CentreLine> make_marched_line(const Surface& surface, const MarchEquation& equation);

// The resonance nearest to a frequency. A resonance is a frequency at which v(0) of the lossless mode is
// zero. Empty if there is none above 0 Hz.
std::optional<double> nearest_resonance_Hz(const Surface& surface, double frequency_Hz);

// All resonances in [low_Hz, high_Hz], ascending.
std::vector<double> resonances_Hz(const Surface& surface, double low_Hz, double high_Hz);

}  // namespace turnpoint::physics
