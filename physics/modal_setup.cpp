#include "physics/modal_setup.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;
// the elements end where the field has decayed by e^-70 beyond the turning point
constexpr double ln_domain_end = 70;
constexpr double ln_match = 45;  // where the field has decayed by e^-45, the one-mode equation takes over
constexpr double widths_per_element = 1.2;
constexpr int most_functions = 60;  // across the strip
// Largest work of a solution at the default resolution: the sum over its elements of the cube of their
// unknowns. A second is enough for this solution and the finer one with which it is compared.
constexpr double most_work = 1e9;

// Returns the number of functions of eta that are needed to follow cos(kw eta). Legendre's series of this
// function decays only beyond the degree kw, so there must be more functions than propagating modes, of which
// there are kw/pi. A plate's functions have a factor (1 - eta^2)^2, and thus two degrees more than a
// membrane's.
int functions_for(double kw, bool plate) {
  const int followed = static_cast<int>(std::ceil(0.5 * kw));
  return plate ? std::max(static_cast<int>(std::ceil(kw / pi)), followed - 1) : followed;
}

// Returns how many transverse functions are used in addition to those that follow waves across the strip.
// Tension makes a boundary layer of width sqrt(D/N) along clamped sides, which takes more polynomials to
// describe.
int spare_functions(const Dispersion& dispersion, double f, const ModalResolution& resolution) {
  if (!dispersion.clamped_bending()) return resolution.spare_functions;
  const double layers =
      dispersion.cut_off_half_width_m(f) * std::sqrt(dispersion.tension_N_per_m / dispersion.stiffness_N_m);
  return resolution.spare_functions + static_cast<int>(std::min(8.0, std::ceil(layers / 10)));
}

// The number of transverse functions at the drive edge.
int functions_across(const Dispersion& dispersion, const Surface& surface, double f,
                     const ModalResolution& resolution) {
  return spare_functions(dispersion, f, resolution) + 2 +
         functions_for(dispersion.wavenumber_per_m(f) * Taper(surface).half_width_m(0),
                       dispersion.clamped_bending());
}

TransverseBasis make_across(const Surface& surface, double f, const ModalResolution& resolution) {
  const Dispersion dispersion(surface);
  const double k = dispersion.wavenumber_per_m(f);
  const bool plate = dispersion.clamped_bending();
  if (resolution.across == ModalResolution::Across::cut_off_shape && plate) {
    const double w = dispersion.cut_off_half_width_m(f);
    return TransverseBasis::clamped_shape(
        k * w, w * std::sqrt(k * k + dispersion.tension_N_per_m / dispersion.stiffness_N_m));
  }
  return TransverseBasis::polynomials(functions_across(dispersion, surface, f, resolution), plate ? 2 : 1);
}

// Shortens an element in which a membrane narrows by a large factor, as at a step in a tabulated taper.
// Polynomials along x approximate such a change poorly, also at a higher resolution.
double gently_narrowing(const Taper& taper, double x, double h) {
  constexpr double least_share = 0.5;
  const double w = taper.half_width_m(x);
  while (taper.half_width_m(x + h) < least_share * w) h *= 0.8;
  return h;
}

// Elements end at the points of a table, where the curvature jumps, and where the surface ends. The last
// point may be short of that by a rounding error.
double element_end(const Taper& taper, double x) {
  const std::vector<Cubic>& pieces = taper.table().pieces();
  const auto next = std::partition_point(pieces.begin(), pieces.end(),
                                         [x](const Cubic& p) { return p.x0 <= x * (1 + 1e-12); });
  return next == pieces.end() ? taper.length_m() : std::min(next->x0, taper.length_m());
}

// Throws std::domain_error if the two-dimensional field would take too long: if the cubes of the elements'
// unknowns add up to too much. Each piece of a table has an element at least.
void require_work(const Surface& surface, double f) {
  const Taper taper(surface);
  const Dispersion dispersion(surface);
  const double k = dispersion.wavenumber_per_m(f);
  const bool plate = dispersion.clamped_bending();
  const ModalResolution usual;
  const int spare = spare_functions(dispersion, f, usual);
  const int per_function = surface.theory == PlateTheory::kirchhoff ? 8 : 18;
  double work = 0, end = 0;
  for (double x = 0; x < surface.length_m; x = end) {
    end = element_end(taper, x);
    const double piece = end - x;
    const double panels = std::ceil(100 * piece / surface.length_m), panel = piece / panels;
    for (int i = 0; i < panels; ++i) {
      const double w = taper.half_width_m(x + panel * (i + 0.5));
      const double elements =
          std::max(1 / panels, panel / std::min(usual.radians / k, widths_per_element * w));
      work += elements * std::pow((functions_for(k * w, plate) + spare) * per_function, 3);
    }
  }
  if (work > most_work)
    throw std::domain_error(
        "the two-dimensional field has too many waves across this surface to be solved; "
        "allowed: the model mode");
}

}  // namespace

void require_solvable(const Surface& surface, double f, const ModalResolution& resolution) {
  require_work(surface, f);
  if (functions_across(Dispersion(surface), surface, f, resolution) > most_functions)
    throw std::domain_error("the two-dimensional field would need more than 60 functions across the strip");
}

ModalSetup make_modal_setup(const Surface& surface, double f, Losses losses,
                            const ModalResolution& resolution) {
  const Dispersion dispersion(surface);
  const double k = dispersion.wavenumber_per_m(f);
  if (resolution.across == ModalResolution::Across::polynomials) require_solvable(surface, f, resolution);
  const std::complex<double> lossy =
      losses == Losses::kept ? k * dispersion.loss(f, surface.quality_factor) : k;
  const bool plate = dispersion.clamped_bending();
  const bool thick = plate && surface.theory != PlateTheory::kirchhoff;
  ModalEquation equation;
  equation.inertia = lossy * lossy;
  if (plate) {  // the equation of a plate is divided by D
    equation.bending = 1;
    equation.tension = dispersion.tension_N_per_m / dispersion.stiffness_N_m;
    equation.inertia *= lossy * lossy + equation.tension;
  }
  return {Taper(surface),
          k,
          make_across(surface, f, resolution),
          ElementBasis{resolution.degree.value_or(thick ? 5 : 7), plate && !thick ? 2 : 1},
          equation,
          turning_point_m(surface, f)
              .value_or(f < dispersion.cut_off_frequency_Hz(half_width_m(surface, 0)) ? 0 : surface.length_m),
          spare_functions(dispersion, f, resolution)};
}

std::function<double(double)> drive_shape(const Surface& surface, const ModalEquation& equation) {
  if (surface.drive == DriveShape::piston) return [](double) { return 1.0; };
  if (!equation.plate()) return [](double eta) { return std::cos(pi / 2 * eta); };
  const Dispersion dispersion(surface);
  const double w = half_width_m(surface, 0);
  const double b = w * dispersion.wavenumber_per_m(dispersion.cut_off_frequency_Hz(w));
  const double g = std::sqrt(b * b + w * w * equation.tension);
  const auto cosh_ratio = [g](double eta) {  // cosh(g eta)/cosh g in a form that does not overflow
    return std::exp(g * (eta - 1)) * (1 + std::exp(-2 * g * eta)) / (1 + std::exp(-2 * g));
  };
  const double unit = 1 / std::cos(b) - cosh_ratio(0);
  return [=](double eta) { return (std::cos(b * eta) / std::cos(b) - cosh_ratio(eta)) / unit; };
}

Eigen::VectorXd drive_unknowns(const ModalSetup& setup, const TransverseBasis& across,
                               const Eigen::VectorXd& shape, int functions) {
  Eigen::VectorXd all(setup.along.per_vertex * functions);
  all.head(functions) = shape.head(functions);
  if (setup.along.per_vertex == 1) return all;
  const auto mass = across.mass.topLeftCorner(functions, functions);
  const auto stretch = across.stretch.topLeftCorner(functions, functions);
  all.tail(functions) = setup.taper.slope(0) * mass.ldlt().solve(stretch * shape.head(functions));
  return all;
}

std::vector<ModalElement> make_modal_elements(const ModalSetup& s, const ModalResolution& resolution,
                                              double& match_m) {
  std::vector<ModalElement> elements;
  double x = 0, decay = 0;
  match_m = s.taper.length_m();
  const double w0 = s.taper.half_width_m(0);
  const bool single = s.across.count() == 1;
  while (x < s.taper.length_m() && decay < ln_domain_end) {
    const double w = s.taper.half_width_m(x);
    double h = std::min(resolution.radians / s.k, widths_per_element * w);
    if (!single && elements.size() < 2) h = std::min(h, (elements.empty() ? 0.15 : 0.35) * w0);
    const double end = element_end(s.taper, x);
    if (!s.equation.plate()) h = gently_narrowing(s.taper, x, std::min(h, end - x));
    if (x + 1.5 * h > end) h = x + h >= end ? end - x : 0.5 * (end - x);
    if (!(h > 1e-9 * w0)) break;  // the apex is reached
    const int wanted = functions_for(s.k * w, s.equation.plate()) + s.spare;
    ModalElement& e = elements.emplace_back();
    e.x0 = x;
    e.h = h;
    e.left = single ? 1 : std::min(s.across.count(), wanted + (elements.size() <= 2 ? 2 : 0));
    x = x + h >= end ? end : x + h;
    const double middle = pi / (2 * s.taper.half_width_m(e.x0 + 0.5 * h));
    decay += h * std::sqrt(std::max(0.0, middle * middle - s.k * s.k));
    if (decay > ln_match && match_m == s.taper.length_m()) match_m = x;
  }
  // If the elements end before the apex, their held end distorts the field in the last few elements. The
  // one-mode decay must then be used from an earlier position on.
  if (x < s.taper.length_m())
    match_m = std::min(match_m, elements[elements.size() - std::min<std::size_t>(8, elements.size())].x0);
  for (std::size_t i = 0; i + 1 < elements.size(); ++i) elements[i].right = elements[i + 1].left;
  return elements;
}

}  // namespace turnpoint::physics
