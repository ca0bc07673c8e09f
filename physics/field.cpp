#include "physics/field.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/gate.hpp"
#include "physics/modes_bound.hpp"
#include "physics/planner.hpp"
#include "physics/statement.hpp"
#include "physics/taylor_kernel.hpp"

namespace turnpoint::physics {
namespace {

struct Solved {
  std::shared_ptr<const CentreLine> line;
  ToneInfo info;
  Scaled at_drive;
  Scaled at_peak;  // v at the last maximum, or at the drive edge if there is no maximum
};

Statement why_no_peak(const Surface& surface, double frequency_Hz) {
  const double cut_off = cut_off_frequency_Hz(surface, half_width_m(surface, 0));
  if (frequency_Hz <= cut_off)
    return make_statement("below-cut-off", "no smooth zone: %1 Hz is below the drive edge's cut-off of %2 Hz",
                          {frequency_Hz, cut_off});
  if (!turning_point_m(surface, frequency_Hz))
    return make_statement("turning-beyond", "no last maximum: the turning point lies beyond the surface");
  if (std::isfinite(surface.quality_factor))
    return make_statement("peak-hidden",
                          "no last maximum on the surface: it would lie before the drive edge, or loss "
                          "(Q = %1) hides it",
                          {surface.quality_factor});
  return make_statement("no-peak", "no last maximum on the surface: it would lie before the drive edge");
}

Solved solve(const Surface& surface, double frequency_Hz, Model model,
             std::shared_ptr<const CentreLine> line = nullptr) {
  Solved s;
  s.line = line ? std::move(line) : make_centre_line(surface, frequency_Hz, model);
  s.info.frequency_Hz = frequency_Hz;
  s.info.turning_point_m = turning_point_m(surface, frequency_Hz);
  s.info.last_peak_m = s.line->last_peak_m();
  if (!s.info.last_peak_m) s.info.no_peak_reason = why_no_peak(surface, frequency_Hz).text;
  // The solution of `modes` is scaled to a drive edge whose centre moves by exactly 1, so use 1. The series
  // itself is not 1 there for a piston, because the transverse functions cannot follow the jump to the held
  // sides.
  s.at_drive = model == Model::modes ? Scaled{1, 0} : s.line->value(0);
  s.at_peak = s.info.last_peak_m ? s.line->value(*s.info.last_peak_m) : s.at_drive;
  const double ln_gain = s.at_peak.ln_magnitude() - s.at_drive.ln_magnitude();
  s.info.gain = std::exp(std::clamp(ln_gain, -700.0, 700.0));
  s.info.conditioning = s.line->drive_conditioning(wavenumber_per_m(surface, frequency_Hz));
  return s;
}

double strongest(std::span<const Tone> tones) {
  double most = 0;
  for (const Tone& tone : tones) most = std::max(most, tone.amplitude_m);
  return most;
}

// The complex number by which v is divided, given by its phase factor and the logarithm of its magnitude.
struct Reference {
  std::complex<double> phase;
  double ln;
};

Reference reference(const Solved& s, const Tone& tone, Normalise normalise, double most) {
  const Scaled& unit = normalise == Normalise::peak ? s.at_peak : s.at_drive;
  if (unit.mantissa == 0.0) {
    throw Refused(make_statement(
        "at-resonance",
        "the tone is exactly at a resonance, where v(0) = 0: normalise by peak, or give a finite Q"));
  }
  const double weight = normalise == Normalise::none ? tone.amplitude_m : tone.amplitude_m / most;
  const auto phase = unit.mantissa / std::abs(unit.mantissa) * std::polar(1.0, -tone.phase_rad);
  // A tone of amplitude 0 gets the tiny weight e^-700 instead, so that its shape can still be computed.
  return {phase, unit.ln_magnitude() - (weight > 0 ? std::log(weight) : -700.0)};
}

void sum_tones(Field& field, std::size_t points) {
  field.amplitude.resize(points);
  if (field.tones.size() == 1) {
    field.ln_amplitude = field.tones[0].ln_amplitude;
    const auto& v = field.tones[0].v;
    magnitudes(reinterpret_cast<const double*>(v.data()), points, field.amplitude.data());
    return;
  }
  field.ln_amplitude.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    double most = ln_zero;
    for (const ToneField& tone : field.tones) most = std::max(most, tone.ln_amplitude[i]);
    double sum = 0;
    for (const ToneField& tone : field.tones) {
      if (tone.ln_amplitude[i] > ln_zero) sum += std::exp(2 * (tone.ln_amplitude[i] - most));
    }
    field.ln_amplitude[i] = sum > 0 ? most + 0.5 * std::log(sum) : ln_zero;
    field.amplitude[i] = sum > 0 ? std::exp(std::min(700.0, field.ln_amplitude[i])) : 0;
  }
}

std::string validity_of(Model model) {
  switch (model) {
    case Model::edge:
      return "positions only";
    case Model::mode:
      return "leaves out higher transverse modes of the drive edge";
    case Model::modes:
      break;
  }
  return "two-dimensional field";
}

// A lower limit of the error of `modes` near a resonance. The estimate made before solving finds resonances
// from the conditioning of the first mode. The resonances of the two-dimensional field lie at slightly
// different frequencies, so that estimate can miss them. modes_bound(), where it can be used, does not miss
// them, because it compares two solutions.
double resonant_error(const Surface& surface, const ToneField& tone, Normalise normalise, double weight) {
  constexpr double shape = 1e-4, largest = 2;
  if (normalise != Normalise::peak) {
    const bool piston = surface.drive == DriveShape::piston;
    return (piston ? 5 : 1) * shape * tone.info.conditioning;
  }
  double most = 1;  // largest |v| if the last maximum is scaled to 1
  for (const auto& v : tone.v) most = std::max(most, weight > 0 ? std::abs(v) / weight : 0);
  return std::min(largest, shape * tone.info.gain * most);
}

}  // namespace

std::string_view name(Normalise normalise) {
  switch (normalise) {
    case Normalise::drive:
      return "drive";
    case Normalise::peak:
      return "peak";
    case Normalise::none:
      break;
  }
  return "none";
}

Normalise parse_normalise(std::string_view text) {
  for (const Normalise one : {Normalise::drive, Normalise::peak, Normalise::none}) {
    if (name(one) == text) return one;
  }
  throw std::invalid_argument("normalise \"" + std::string(text) +
                              "\" is not known; allowed: drive, peak, none");
}

std::vector<ToneField> evaluate_tones(const Surface& surface, std::span<const Tone> tones,
                                      std::span<const double> x, Model model, Normalise normalise,
                                      const SolvedLines& solved) {
  validate(surface, tones);
  if (!solved.empty() && solved.size() != tones.size())
    throw std::invalid_argument("a field needs as many solutions as tones, or none");
  for (const double one : x) require_on_surface(surface, "x_m of a point", one);
  const double most = strongest(tones);
  std::vector<ToneField> fields;
  for (std::size_t i = 0; i < tones.size(); ++i) {
    const Tone& tone = tones[i];
    const Solved s = solve(surface, tone.frequency_Hz, model, solved.empty() ? nullptr : solved[i]);
    ToneField& one = fields.emplace_back();
    one.info = s.info;
    if (normalise == Normalise::peak) one.info.conditioning = 1;
    one.v.resize(x.size());
    one.ln_amplitude.resize(x.size());
    const Reference unit = reference(s, tone, normalise, most);
    s.line->evaluate(x, unit.phase, unit.ln, one.v, one.ln_amplitude);
  }
  return fields;
}

std::vector<double> amplitude_profile(const Surface& surface, std::span<const Tone> tones,
                                      std::span<const double> x, Model model, const SolvedLines& solved) {
  Field field;
  field.tones = evaluate_tones(surface, tones, x, model, Normalise::none, solved);
  sum_tones(field, x.size());
  return field.amplitude;
}

Field evaluate(const Surface& surface, std::span<const Tone> tones, std::span<const double> x, Model model,
               Normalise normalise, const SolvedLines& solved) {
  Field field;
  field.model = model;
  field.normalise = normalise;
  field.tones = evaluate_tones(surface, tones, x, model, normalise, solved);
  sum_tones(field, x.size());
  return field;
}

FieldNotes describe(const Surface& surface, std::span<const Tone> tones, const Field& field) {
  validate(surface, tones);
  if (field.tones.size() != tones.size())
    throw std::invalid_argument("description: the field must be that of the tones");
  FieldNotes notes;
  const PlanRequest request{
      {tones.begin(), tones.end()}, static_cast<int>(field.amplitude.size()), {}, field.normalise, {}};
  notes.error_bound = estimate(surface, request, field.model).amplitude_bound;
  const bool estimated = field.model == Model::modes && !modes_bound_applies(surface);
  for (std::size_t i = 0; estimated && i < field.tones.size(); ++i) {
    const double weight = tones[i].amplitude_m / strongest(tones);
    notes.error_bound =
        std::max(notes.error_bound, resonant_error(surface, field.tones[i], field.normalise, weight));
  }
  notes.validity = validity_of(field.model);
  notes.warnings = surface_warnings(surface);
  for (Warning& warning : tone_warnings(surface, tones)) notes.warnings.push_back(std::move(warning));
  double conditioning = 1;
  for (const ToneField& one : field.tones) conditioning = std::max(conditioning, one.info.conditioning);
  if (conditioning > 100) {
    notes.warnings.push_back(make_statement(
        "ill-conditioned",
        "a tone is close to a resonance, where v(0) = 0: dividing by v(0) amplifies errors %1 times",
        {conditioning}));
  }
  return notes;
}

ToneInfo tone_info(const Surface& surface, double frequency_Hz, Model model) {
  validate(surface, frequency_Hz);
  ToneInfo info = solve(surface, frequency_Hz, model).info;
  info.nearest_resonance_Hz = nearest_resonance_Hz(surface, frequency_Hz);
  return info;
}

double drive_amplitude_m(const Surface& surface, double frequency_Hz, double displacement_m, Model model) {
  validate(surface, frequency_Hz);
  require_size("displacement_m", displacement_m);
  const ToneInfo info = solve(surface, frequency_Hz, model).info;
  if (!info.last_peak_m) throw Refused(why_no_peak(surface, frequency_Hz));
  return displacement_m / info.gain;
}

std::vector<double> linspace_points(const Surface& surface, int n) {
  require(n >= 2 && n <= 1'000'000, "points", n, "2 to 1 000 000");
  require_size("length_m", surface.length_m);
  std::vector<double> x(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = surface.length_m * i / (n - 1);
  x.back() = surface.length_m;
  return x;
}

}  // namespace turnpoint::physics
