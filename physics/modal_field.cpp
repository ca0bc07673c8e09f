#include "physics/modal_field.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/line_search.hpp"
#include "physics/modal_setup.hpp"
#include "physics/section_field.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;

// Eliminates unknowns from the tip to the drive edge. In each element, all other unknowns are expressed by
// those at the end nearer to the drive edge.
void eliminate(const ModalAssembler& assembler, const ElementBasis& along,
               std::vector<ModalElement>& elements) {
  Eigen::MatrixXcd tail;  // stiffness of all elements farther out, seen at the right vertex
  for (auto e = elements.rbegin(); e != elements.rend(); ++e) {
    Eigen::MatrixXcd k = assembler.matrix(*e);
    if (tail.size() > 0) k.bottomRightCorner(tail.rows(), tail.cols()) += tail;
    const Eigen::Index left = along.per_vertex * e->left;
    const Eigen::Index rest = k.rows() - left;
    e->transfer = -k.bottomRightCorner(rest, rest).partialPivLu().solve(k.bottomLeftCorner(rest, left));
    tail = k.topLeftCorner(left, left) + k.topRightCorner(left, rest) * e->transfer;
  }
}

// Computes the unknowns of all elements, starting at the drive edge. Only the values on the centre line are
// stored. The logarithm of the unknowns' size is kept separately.
void substitute(const ModalSetup& s, const ModalAssembler& assembler, const Eigen::VectorXd& drive,
                std::vector<ModalElement>& elements) {
  Eigen::VectorXcd u = drive.cast<std::complex<double>>();
  double ln_scale = 0;
  for (ModalElement& e : elements) {
    ln_scale += take_out_size(u);
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
  void solve(const Surface& surface, const ModalSetup& setup, const ModalResolution& resolution);
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
  const ModalSetup s = make_modal_setup(surface, f, losses, resolution);
  along_ = s.along;
  spacing_m_ = 0.25 / s.k;
  turning_m_ = s.turning_m;
  elements_ = make_modal_elements(s, resolution, match_m_);
  if (surface.theory == PlateTheory::kirchhoff) {
    solve(surface, s, resolution);
  } else {
    solve_section_elements(surface, f, losses, resolution, s, elements_);
  }
  peak_m_ = find_last_peak(*this, std::min(s.turning_m, length_m_), spacing_m_);
}

void ModalLine::solve(const Surface& surface, const ModalSetup& s, const ModalResolution& resolution) {
  const ModalAssembler assembler(s.taper, s.across, s.along, s.equation, s.taper.half_width_m(0));
  eliminate(assembler, s.along, elements_);
  Eigen::VectorXd drive = Eigen::VectorXd::Unit(s.along.per_vertex, 0);
  if (s.across.count() > 1) {
    const auto shape =
        s.across.project(resolution.drive ? resolution.drive : drive_shape(surface, s.equation));
    drive = drive_unknowns(s, s.across, shape, elements_.front().left);
  }
  substitute(s, assembler, drive, elements_);
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

// Beyond the match point, where the field has decayed to e^-45, the one-mode equation gives the further
// decay.
Scaled ModalLine::beyond(double x, int derivative) const {
  const Scaled here = at(match_m_, 0), unit = tail_.value(match_m_);
  const Scaled there = derivative == 0 ? tail_.value(x) : tail_.slope(x);
  return {here.mantissa * there.mantissa / unit.mantissa, here.ln_scale + there.ln_scale - unit.ln_scale};
}

}  // namespace

std::unique_ptr<CentreLine> make_modal_line(const Surface& surface, double f, Losses losses,
                                            const ModalResolution& resolution) {
  if (resolution.degree && (*resolution.degree < 4 || *resolution.degree > largest_degree))
    throw std::invalid_argument("degree is " + std::to_string(*resolution.degree) + "; allowed: 4 to 12");
  return std::make_unique<ModalLine>(surface, f, losses, resolution);
}

}  // namespace turnpoint::physics
