#pragma once
// One tone's centre-line displacement, behind one interface for every rung that has a profile.
#include <complex>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/taylor_march.hpp"

namespace turnpoint::physics {

// v(x) up to a constant factor. Const functions are thread-safe.
class CentreLine {
 public:
  virtual ~CentreLine() = default;
  virtual Scaled value(double x_m) const = 0;
  virtual Scaled slope(double x_m) const = 0;  // dv/dx
  // As TaylorMarch::evaluate; the default calls value() per point.
  virtual void evaluate(std::span<const double> x_m, std::complex<double> phase_reference,
                        double ln_reference, std::span<std::complex<double>> v,
                        std::span<double> ln_amplitude) const;
  virtual std::optional<double> last_peak_m() const = 0;
  // Outermost point at `level` of the last maximum; empty if there is none.
  virtual std::optional<double> level_m(double level) const = 0;
  // How much a division by v(0) amplifies errors: the envelope of the standing wave at the drive edge over
  // |v(0)|.
  virtual double drive_conditioning(double wavenumber_per_m) const;
};

// Whether losses are kept (k -> k (1 - i/2Q)) or left out.
enum class Losses { kept, left_out };

// Throws std::invalid_argument for Model::edge (it has no profile), std::domain_error where the model has no
// answer: `airy` and `uniform` without a turning point on the (continued) taper.
std::unique_ptr<CentreLine> make_centre_line(const Surface& surface, double frequency_Hz, Model model,
                                             Losses losses = Losses::kept);

// Position of the local cut-off of the first transverse mode; empty if outside [0, length_m].
std::optional<double> turning_point_m(const Surface& surface, double frequency_Hz);

// The marched equation of `seed` or `mode`.
MarchEquation march_equation(const Surface& surface, double frequency_Hz, Model model, Losses losses);

// The first transverse mode as exactly as one equation can have it: on a linear taper J_nu(k s), nu = pi / (2
// atan d), the two-dimensional mode of the wedge; elsewhere `mode`.
MarchEquation best_equation(const Surface& surface, double frequency_Hz, Losses losses);

// A centre line that solves a given marched equation.
std::unique_ptr<CentreLine> make_marched_line(const Surface& surface, const MarchEquation& equation);

// The zero of the lossless mode's v(0) nearest to a frequency; empty if there is none above zero frequency.
std::optional<double> nearest_resonance_Hz(const Surface& surface, double frequency_Hz);

// All such zeros in [low_Hz, high_Hz], ascending.
std::vector<double> resonances_Hz(const Surface& surface, double low_Hz, double high_Hz);

}  // namespace turnpoint::physics
