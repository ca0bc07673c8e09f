#pragma once
// Centre-line displacement of the surface under a set of tones, by a chosen model.
#include <complex>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "physics/warning.hpp"

namespace turnpoint::physics {

// What is set to one.
//   drive  v(0) of the strongest tone (others keep their ratio to it)
//   peak   last maximum of |v| of each tone, times the tone's amplitude relative to the strongest; a tone
//   without
//          a last maximum is divided by its largest value on the surface
//   none   nothing: metres, for the tones' amplitudes at the drive edge
enum class Normalise { drive, peak, none };
std::string_view name(Normalise normalise);
Normalise parse_normalise(std::string_view text);

// ln|v| at an exact zero of v (the clamped end): the lowest finite double, never -infinity.
inline constexpr double ln_zero = std::numeric_limits<double>::lowest();

// The behaviour of one tone on a surface, by one model. Positions that do not exist on the surface are empty.
struct ToneInfo {
  double frequency_Hz = 0;
  std::optional<double> turning_point_m;  // local cut-off of the first transverse mode
  std::optional<double> last_peak_m;      // outermost maximum of |v|
  double gain = 0;                        // |v| at the last maximum (largest value if none) over |v(0)|
  double conditioning = 1;                // amplification of rounding by the division by v(0); 1 for `peak`
  std::optional<double> nearest_resonance_Hz;  // nearest zero of the lossless mode's v(0)
  std::string no_peak_reason;                  // why last_peak_m is none; empty otherwise
};

struct ToneField {
  ToneInfo info;
  std::vector<std::complex<double>> v;  // one per point; convention v exp(+i omega t); 0 where it underflows
  std::vector<double> ln_amplitude;     // ln|v|, right also where v underflows; ln_zero at exact zeros
};

struct Field {
  Model model = Model::mode;
  Normalise normalise = Normalise::drive;
  std::vector<ToneField> tones;
  std::vector<double> amplitude;     // root of the summed squares of |v|, one per point
  std::vector<double> ln_amplitude;  // its logarithm
  double error_bound = 0;            // of any tone's |v|, relative to that tone's largest |v| on the surface
  std::string validity;              // what the model leaves out here, in words
  std::vector<Warning> warnings;
};

// Evaluates the field at `x_m` (any order, each in [0, length_m]; throws std::invalid_argument otherwise, and
// for Model::edge, which has no profile, or `modes` on clamped plates). Cost: one solution per tone.
Field evaluate(const Surface& surface, std::span<const Tone> tones, std::span<const double> x_m, Model model,
               Normalise normalise);

// The tones of evaluate() alone: no bound, warnings or nearest resonances, for callers that ask for those
// once and for profiles often.
std::vector<ToneField> evaluate_tones(const Surface& surface, std::span<const Tone> tones,
                                      std::span<const double> x_m, Model model, Normalise normalise);

// Root of the summed squares of |v| at each point (m), for the tones' amplitudes at the drive edge.
std::vector<double> amplitude_profile(const Surface& surface, std::span<const Tone> tones,
                                      std::span<const double> x_m, Model model);

// Where and how strongly one frequency acts, without a profile.
ToneInfo tone_info(const Surface& surface, double frequency_Hz, Model model = Model::mode);

// Amplitude of the drive edge that gives `displacement_m` (peak) at the last maximum; the means by which
// levels are equal across boundaries. Throws std::domain_error when there is no last maximum.
double drive_amplitude_m(const Surface& surface, double frequency_Hz, double displacement_m,
                         Model model = Model::mode);

// n points from 0 to length_m inclusive (n >= 2).
std::vector<double> linspace_points(const Surface& surface, int n);

}  // namespace turnpoint::physics
