#include "physics/modal_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/line_search.hpp"
#include "physics/modal_elements.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;
constexpr double ln_domain_end = 70;  // of decay beyond the turning point, where the elements stop
constexpr double ln_match = 45;       // where the one-mode decay takes over
constexpr double widths_per_element = 1.2;

struct Setup {
  Taper taper;
  double k;
  TransverseBasis across;
  ElementBasis along;
  ModalEquation equation;
  double turning_m;  // or the length
  int spare;         // transverse functions beyond those that can propagate
};

// Tension makes a boundary layer along clamped sides, of sqrt(D/N), which takes more polynomials.
int spare_functions(const Dispersion& dispersion, double f, const ModalResolution& resolution) {
  if (!dispersion.clamped_bending()) return resolution.spare_functions;
  const double layers =
      dispersion.cut_off_half_width_m(f) * std::sqrt(dispersion.tension_N_per_m / dispersion.stiffness_N_m);
  return resolution.spare_functions + static_cast<int>(std::min(8.0, std::ceil(layers / 10)));
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
  const int functions = spare_functions(dispersion, f, resolution) + 2 +
                        static_cast<int>(std::ceil(k * Taper(surface).half_width_m(0) / pi));
  return TransverseBasis::polynomials(std::min(functions, 60), plate ? 2 : 1);
}

Setup make_setup(const Surface& surface, double f, Losses losses, const ModalResolution& resolution) {
  const Dispersion dispersion(surface);
  const double k = dispersion.wavenumber_per_m(f);
  const std::complex<double> lossy =
      k * std::complex<double>(1, losses == Losses::kept ? -0.5 / surface.quality_factor : 0);
  const bool plate = dispersion.clamped_bending();
  ModalEquation equation;
  equation.inertia = lossy * lossy;
  if (plate) {  // scaled by D
    equation.bending = 1;
    equation.tension = dispersion.tension_N_per_m / dispersion.stiffness_N_m;
    equation.inertia *= lossy * lossy + equation.tension;
  }
  return {Taper(surface),
          k,
          make_across(surface, f, resolution),
          ElementBasis{resolution.degree, plate ? 2 : 1},
          equation,
          turning_point_m(surface, f)
              .value_or(f < dispersion.cut_off_frequency_Hz(half_width_m(surface, 0)) ? 0 : surface.length_m),
          spare_functions(dispersion, f, resolution)};
}

// Intervals from the drive edge to the end, finer at the drive edge's corners, ending on the taper's knots.
std::vector<ModalElement> make_elements(const Setup& s, const ModalResolution& resolution, double& match_m) {
  std::vector<ModalElement> elements;
  double x = 0, decay = 0;
  match_m = s.taper.length_m();
  const double w0 = s.taper.half_width_m(0);
  const bool single = s.across.count() == 1;
  while (x < s.taper.length_m() && decay < ln_domain_end) {
    const double w = s.taper.half_width_m(x);
    double h = std::min(resolution.radians / s.k, widths_per_element * w);
    if (!single && elements.size() < 2) h = std::min(h, (elements.empty() ? 0.15 : 0.35) * w0);
    double end = s.taper.length_m();
    for (const Cubic& piece : s.taper.table().pieces()) {
      if (piece.x0 > x * (1 + 1e-12) && piece.x0 < end) end = piece.x0;
    }
    if (x + 1.5 * h > end) h = x + h >= end ? end - x : 0.5 * (end - x);
    if (!(h > 1e-9 * w0)) break;  // the apex itself
    const int wanted = static_cast<int>(std::ceil(s.k * w / pi)) + s.spare;
    ModalElement& e = elements.emplace_back();
    e.x0 = x;
    e.h = h;
    e.left = single ? 1 : std::min(s.across.count(), wanted + (elements.size() <= 2 ? 2 : 0));
    x = x + h >= end ? end : x + h;
    const double middle = pi / (2 * s.taper.half_width_m(e.x0 + 0.5 * h));
    decay += h * std::sqrt(std::max(0.0, middle * middle - s.k * s.k));
    if (decay > ln_match && match_m == s.taper.length_m()) match_m = x;
  }
  // Where the elements stop short of an apex, their held end shows in the last few e-foldings.
  if (x < s.taper.length_m())
    match_m = std::min(match_m, elements[elements.size() - std::min<std::size_t>(8, elements.size())].x0);
  for (std::size_t i = 0; i + 1 < elements.size(); ++i) elements[i].right = elements[i + 1].left;
  return elements;
}

// Eliminates from the tip to the drive edge: each element's inner and outer unknowns per unknown of its inner
// end.
void eliminate(const ModalAssembler& assembler, const ElementBasis& along,
               std::vector<ModalElement>& elements) {
  Eigen::MatrixXcd tail;  // stiffness of everything beyond, seen at the right vertex
  for (auto e = elements.rbegin(); e != elements.rend(); ++e) {
    Eigen::MatrixXcd k = assembler.matrix(*e);
    if (tail.size() > 0) k.bottomRightCorner(tail.rows(), tail.cols()) += tail;
    const Eigen::Index left = along.per_vertex * e->left;
    const Eigen::Index rest = k.rows() - left;
    e->transfer = -k.bottomRightCorner(rest, rest).partialPivLu().solve(k.bottomLeftCorner(rest, left));
    tail = k.topLeftCorner(left, left) + k.topRightCorner(left, rest) * e->transfer;
  }
}

// Goes back out from the drive edge, keeping the size apart, and keeps the centre line only.
void substitute(const Setup& s, const ModalAssembler& assembler, const Eigen::VectorXd& drive,
                std::vector<ModalElement>& elements) {
  Eigen::VectorXcd u = Eigen::VectorXcd::Zero(s.along.per_vertex * elements.front().left);
  u.head(elements.front().left) = drive.head(elements.front().left).cast<std::complex<double>>();
  double ln_scale = 0;
  for (ModalElement& e : elements) {
    const double size = u.cwiseAbs().maxCoeff();
    if (size > 0) {
      u /= size;
      ln_scale += std::log(size);
    }
    e.ln_scale = ln_scale;
    const Eigen::VectorXcd rest = e.transfer * u;
    e.centre = Eigen::VectorXcd::Zero(s.along.count());
    for (int a = 0; a < s.along.count(); ++a) {
      const bool right = a >= s.along.count() - s.along.per_vertex;
      const int functions = right ? e.right : e.left;
      const Eigen::Index start =
          right ? rest.size() - (s.along.count() - a) * e.right : (a - s.along.per_vertex) * e.left;
      for (int i = 0; i < functions; ++i) {
        const auto c = a < s.along.per_vertex ? u[a * e.left + i] : rest[start + i];
        e.centre[a] += c * s.across.centre[i];
      }
      const bool slope = s.along.per_vertex == 2 && (a == 1 || a == s.along.count() - 1);
      if (slope) e.centre[a] *= assembler.slope_factor(e);
    }
    if (e.right > 0) u = rest.tail(s.along.per_vertex * e.right);
    e.transfer.resize(0, 0);
  }
}

// The drive edge's displacement against eta: a piston, or the first transverse mode at its cut-off.
std::function<double(double)> drive_shape(const Surface& surface, const ModalEquation& equation) {
  if (surface.drive == DriveShape::piston) return [](double) { return 1.0; };
  if (!equation.plate()) return [](double eta) { return std::cos(pi / 2 * eta); };
  const Dispersion dispersion(surface);
  const double w = half_width_m(surface, 0);
  const double b = w * dispersion.wavenumber_per_m(dispersion.cut_off_frequency_Hz(w));
  const double g = std::sqrt(b * b + w * w * equation.tension);
  const auto cosh_ratio = [g](double eta) {  // cosh(g eta)/cosh g, without overflow
    return std::exp(g * (eta - 1)) * (1 + std::exp(-2 * g * eta)) / (1 + std::exp(-2 * g));
  };
  const double unit = 1 / std::cos(b) - cosh_ratio(0);
  return [=](double eta) { return (std::cos(b * eta) / std::cos(b) - cosh_ratio(eta)) / unit; };
}

class ModalLine final : public CentreLine {
 public:
  ModalLine(const Surface& surface, double f, Losses losses, const ModalResolution& resolution);

  Scaled value(double x) const override { return at(x, 0); }
  Scaled slope(double x) const override { return at(x, 1); }
  std::optional<double> last_peak_m() const override { return peak_m_; }
  std::optional<double> level_m(double level) const override {
    if (!peak_m_) return std::nullopt;
    return find_level(*this, *peak_m_, length_m_, spacing_m_, level);
  }
  double drive_conditioning(double) const override {
    const double ln_drive = value(0).ln_magnitude();
    double most = 1;
    for (double x = 0; x <= turning_m_; x += spacing_m_)
      most = std::max(most, std::exp(std::min(600.0, value(x).ln_magnitude() - ln_drive)));
    return most;
  }

 private:
  Scaled at(double x, int derivative) const;
  Scaled beyond(double x, int derivative) const;

  ElementBasis along_;
  std::vector<ModalElement> elements_;
  TaylorMarch tail_;
  double length_m_, turning_m_ = 0, match_m_ = 0, spacing_m_;
  std::optional<double> peak_m_;
};

ModalLine::ModalLine(const Surface& surface, double f, Losses losses, const ModalResolution& resolution)
    : along_{}, tail_(Taper(surface), best_equation(surface, f, losses)), length_m_(surface.length_m) {
  const Setup s = make_setup(surface, f, losses, resolution);
  along_ = s.along;
  spacing_m_ = 0.25 / s.k;
  turning_m_ = s.turning_m;
  elements_ = make_elements(s, resolution, match_m_);
  const ModalAssembler assembler(s.taper, s.across, s.along, s.equation, s.taper.half_width_m(0));
  eliminate(assembler, s.along, elements_);
  Eigen::VectorXd drive = Eigen::VectorXd::Ones(1);
  if (s.across.count() > 1) {
    drive = s.across.project(resolution.drive ? resolution.drive : drive_shape(surface, s.equation));
  }
  substitute(s, assembler, drive, elements_);
  peak_m_ = find_last_peak(*this, std::min(s.turning_m, length_m_), spacing_m_);
}

Scaled ModalLine::at(double x, int derivative) const {
  if (x > match_m_) return beyond(x, derivative);
  auto e = std::partition_point(elements_.begin(), elements_.end(),
                                [x](const ModalElement& one) { return one.x0 + one.h < x; });
  if (e == elements_.end()) --e;
  const double t = std::clamp(2 * (x - e->x0) / e->h - 1, -1.0, 1.0);
  const BasisValues basis = along_.at(t);
  const auto& part = derivative == 0 ? basis.value : basis.first;
  std::complex<double> sum = 0;
  for (int a = 0; a < along_.count(); ++a) sum += e->centre[a] * part[static_cast<std::size_t>(a)];
  return {derivative == 0 ? sum : sum * (2 / e->h), e->ln_scale};
}

// Beyond e^-45 the one-mode decay continues the field from the match point.
Scaled ModalLine::beyond(double x, int derivative) const {
  const Scaled here = at(match_m_, 0), unit = tail_.value(match_m_);
  const Scaled there = derivative == 0 ? tail_.value(x) : tail_.slope(x);
  return {here.mantissa * there.mantissa / unit.mantissa, here.ln_scale + there.ln_scale - unit.ln_scale};
}

}  // namespace

std::unique_ptr<CentreLine> make_modal_line(const Surface& surface, double f, Losses losses,
                                            const ModalResolution& resolution) {
  if (resolution.degree < 4 || resolution.degree > largest_degree) {
    throw std::invalid_argument("degree is " + std::to_string(resolution.degree) + "; allowed: 4 to 12");
  }
  return std::make_unique<ModalLine>(surface, f, losses, resolution);
}

}  // namespace turnpoint::physics
