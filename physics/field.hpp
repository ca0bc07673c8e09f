#pragma once
// Centre-line displacement of the surface for a set of tones, by a chosen model.
#include <complex>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "physics/warning.hpp"

namespace turnpoint::physics {

// Which value of |v| is set to one:
//   drive  v(0) of the strongest tone; weaker tones keep their ratio to the strongest one
//   peak   last maximum of |v| of each tone, times the tone's amplitude relative to the strongest; if a tone
//          has no last maximum, its largest |v| on the surface is used
//   none   no value: |v| is in metres, for the tones' amplitudes at the drive edge
enum class Normalise { drive, peak, none };
std::string_view name(Normalise normalise);
Normalise parse_normalise(std::string_view text);

// The value used for ln|v| where v is exactly zero (at the clamped end). It is the lowest finite double, not
// -infinity.
inline constexpr double ln_zero = std::numeric_limits<double>::lowest();

// What a model predicts for one tone on a surface. A position is empty if it does not exist on the surface.
struct ToneInfo {
  double frequency_Hz = 0;
  // position where the first transverse mode's local cut-off equals the frequency
  std::optional<double> turning_point_m;
  std::optional<double> last_peak_m;  // position of the outermost maximum of |v|
  // |v| at the last maximum (or, without one, the largest |v|) divided by |v(0)|
  double gain = 0;
  // factor by which the division by v(0) amplifies rounding errors; 1 for Normalise::peak
  double conditioning = 1;
  // frequency nearest to the tone's at which v(0) of the mode without loss is zero; set only by tone_info()
  std::optional<double> nearest_resonance_Hz;
  std::string no_peak_reason;  // why `last_peak_m` is empty; "" if it is set
};

struct ToneField {
  ToneInfo info;
  // complex displacement, one value per point, to be multiplied by exp(+i omega t); 0 where it underflows
  std::vector<std::complex<double>> v;
  // ln|v|, correct also where v underflows; ln_zero where v is exactly zero
  std::vector<double> ln_amplitude;
};

struct Field {
  Model model = Model::mode;
  Normalise normalise = Normalise::drive;
  std::vector<ToneField> tones;
  std::vector<double> amplitude;  // root of the summed squares of |v| over tones, one value per point
  std::vector<double> ln_amplitude;
};

// Evaluates the field at the points `x_m`, in any order. Throws std::invalid_argument if a point is outside
// [0, length_m], and for Model::edge, which has no profile; std::domain_error if the model does not apply.
// The cost is one solution per tone; none if `solved` contains them.
Field evaluate(const Surface& surface, std::span<const Tone> tones, std::span<const double> x_m, Model model,
               Normalise normalise, const SolvedLines& solved = {});

// Says how far a field can be trusted. Computing these notes takes several more solutions than the field
// itself.
struct FieldNotes {
  // error of any tone's |v|, relative to that tone's largest |v| on the surface
  double error_bound = 0;
  std::string validity;  // what the model leaves out for this surface, in words
  std::vector<Warning> warnings;
};
FieldNotes describe(const Surface& surface, std::span<const Tone> tones, const Field& field);

// Like evaluate(), but returns only the field of each tone, not their sum.
std::vector<ToneField> evaluate_tones(const Surface& surface, std::span<const Tone> tones,
                                      std::span<const double> x_m, Model model, Normalise normalise,
                                      const SolvedLines& solved = {});

// Amplitude in m at each point, for the tones' amplitudes at the drive edge: the root of the sum of |v|^2
// over the tones.
std::vector<double> amplitude_profile(const Surface& surface, std::span<const Tone> tones,
                                      std::span<const double> x_m, Model model,
                                      const SolvedLines& solved = {});

// Computes position and strength for one frequency (see ToneInfo), but no profile.
ToneInfo tone_info(const Surface& surface, double frequency_Hz, Model model = Model::mode);

// Returns the amplitude at the drive edge that gives the peak displacement `displacement_m` at the last
// maximum. If all tones are driven in this way, the last maxima of all of them are equally high, wherever
// their boundaries are. Throws Refused if there is no last maximum.
double drive_amplitude_m(const Surface& surface, double frequency_Hz, double displacement_m,
                         Model model = Model::mode);

// n evenly spaced points from 0 to length_m, ends included (n >= 2).
std::vector<double> linspace_points(const Surface& surface, int n);

}  // namespace turnpoint::physics
