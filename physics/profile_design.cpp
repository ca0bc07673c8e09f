// Finds tones that produce a desired profile of amplitude along the centre line.
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "physics/centre_line.hpp"
#include "physics/crest.hpp"
#include "physics/gate.hpp"
#include "physics/nnls.hpp"
#include "physics/statement.hpp"
#include "physics/zone.hpp"

namespace turnpoint::physics {
namespace {

constexpr double reachable_residual = 0.25;
// stop if another tone reduces the residual by less than this fraction
constexpr double fit_tolerance = 1e-4;
constexpr int most_candidates = 1000;

// Appends a tone's squared amplitudes at the target's points to `columns`. The amplitudes are relative to the
// tone's last maximum; `drive_gain` becomes |v(0)| divided by that maximum.
bool shape(const Surface& surface, double f, std::span<const double> x, std::vector<double>& columns,
           double& drive_gain) {
  const auto line = make_centre_line(surface, f, Model::mode);
  const auto peak = line->last_peak_m();
  if (!peak) return false;
  const double ln_peak = line->value(*peak).ln_magnitude();
  std::vector<std::complex<double>> v(x.size());
  std::vector<double> ln(x.size());
  line->evaluate(x, 1.0, ln_peak, v, ln);
  for (const auto& one : v) columns.push_back(std::norm(one));
  drive_gain = std::exp(line->value(0).ln_magnitude() - ln_peak);
  return true;
}

}  // namespace

ProfileDesign design_profile(const Surface& surface, std::span<const ProfilePoint> target,
                             const ToneBand& band) {
  validate(surface);
  std::vector<double> x, wanted;
  double norm = 0;
  for (const ProfilePoint& point : target) {
    require_on_surface(surface, "x_m of a target profile", point.x_m);
    x.push_back(point.x_m);
    require(point.amplitude_m >= 0 && point.amplitude_m <= largest_size, "amplitude_m", point.amplitude_m,
            "0 to 1e18");
    wanted.push_back(point.amplitude_m * point.amplitude_m);
    norm += wanted.back() * wanted.back();
  }
  if (!(norm > 0)) throw std::invalid_argument("target profile: an amplitude above 0 is needed");
  for (const double one : {band.low_Hz, band.high_Hz, band.spacing_Hz}) require_size("tone band", one);
  if (!(band.low_Hz > 0 && band.spacing_Hz > 0 && band.high_Hz >= band.low_Hz)) {
    throw std::invalid_argument("tone band: low_Hz up to high_Hz and spacing_Hz above 0 are needed");
  }
  std::vector<double> columns, frequencies, gains;
  const double candidates = std::floor((band.high_Hz - band.low_Hz) / band.spacing_Hz * (1 + 1e-12));
  if (!(candidates < most_candidates)) {
    throw std::invalid_argument("tone band: spacing_Hz gives " + StatementValue(candidates).text +
                                " candidate tones; allowed: fewer than " + std::to_string(most_candidates));
  }
  const int count = static_cast<int>(candidates);
  for (int i = 0; i <= count; ++i) {
    const double f = band.low_Hz + i * band.spacing_Hz;
    validate(surface, f);
    double gain = 1;
    if (!shape(surface, f, x, columns, gain)) continue;
    frequencies.push_back(f);
    gains.push_back(gain);
  }
  if (frequencies.empty())
    throw Refused(
        make_statement("no-smooth-zone", "no frequency of the band has a smooth zone on this surface"));
  const NnlsResult fit = nnls(columns, x.size(), wanted, fit_tolerance);
  ProfileDesign design;
  for (std::size_t i = frequencies.size(); i-- > 0;) {
    if (fit.x[i] > 0) design.tones.push_back({frequencies[i], std::sqrt(fit.x[i]) * gains[i], 0});
  }
  assign_phases(design.tones);
  design.residual = fit.residual_norm / std::sqrt(norm);
  design.reachable = design.residual <= reachable_residual;
  std::ostringstream text;
  text << design.tones.size() << " of " << frequencies.size() << " tones; relative rms residual "
       << design.residual
       << (design.reachable ? ": reachable" : ": not reachable (limit 0.25); profiles that fall with x are");
  design.verdict = text.str();
  return design;
}

}  // namespace turnpoint::physics
