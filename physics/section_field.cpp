#include "physics/section_field.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace turnpoint::physics {
namespace {

SectionBasis make_section(const Surface& surface, double f, const ModalResolution& resolution,
                          const ModalSetup& setup) {
  if (resolution.across == ModalResolution::Across::cut_off_shape) return section_shapes(surface, f);
  if (surface.theory == PlateTheory::elastic)
    throw std::domain_error("model modes is not available for plate theory elastic; allowed: mode");
  return mindlin_polynomials(surface, setup.across.count());
}

}  // namespace

Eigen::MatrixXcd section_element_matrix(const SectionBasis& section, const ModalSetup& setup,
                                        std::complex<double> omega2, const ModalElement& e) {
  using S = SectionBasis;
  const Eigen::Index n = section.count(), count = setup.along.count();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n * count, n * count), mass = stiffness;
  const Quadrature rule = gauss_legendre(setup.along.degree + 3);
  for (std::size_t q = 0; q < rule.x.size(); ++q) {
    const double x = e.x0 + e.h * rule.x[q], w = setup.taper.half_width_m(x);
    const double r = -setup.taper.slope(x) / w, s = 1 / w;
    // The strain is f' X + f (r R + s Y + Z), with X, R, Y and Z as in SectionBasis.
    const Eigen::MatrixXd mixed = r * section.stiff[S::along][S::stretch] +
                                  s * section.stiff[S::along][S::across] + section.stiff[S::along][S::local];
    const Eigen::MatrixXd cross = r * s * section.stiff[S::stretch][S::across] +
                                  r * section.stiff[S::stretch][S::local] +
                                  s * section.stiff[S::across][S::local];
    const Eigen::MatrixXd still = r * r * section.stiff[S::stretch][S::stretch] +
                                  s * s * section.stiff[S::across][S::across] +
                                  section.stiff[S::local][S::local] + cross + cross.transpose();
    const BasisValues basis = setup.along.at(2 * rule.x[q] - 1);
    const double weight = e.h * rule.w[q] * w;
    for (Eigen::Index a = 0; a < count; ++a) {
      for (Eigen::Index b = 0; b < count; ++b) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        const double va = weight * basis.value[i], vb = basis.value[j];
        const double da = weight * basis.first[i] * 2 / e.h, db = basis.first[j] * 2 / e.h;
        stiffness.block(a * n, b * n, n, n) += da * db * section.stiff[S::along][S::along] + da * vb * mixed +
                                               va * db * mixed.transpose() + va * vb * still;
        mass.block(a * n, b * n, n, n) += va * vb * section.mass;
      }
    }
  }
  return stiffness - omega2 * mass;
}

void solve_section_elements(const Surface& surface, double f, Losses losses,
                            const ModalResolution& resolution, const ModalSetup& setup,
                            std::vector<ModalElement>& elements) {
  if (resolution.drive)
    throw std::invalid_argument("drive shapes can be given for plate theory kirchhoff only");
  const SectionBasis section = make_section(surface, f, resolution, setup);
  const std::complex<double> lossy(1, losses == Losses::kept ? -0.5 / surface.quality_factor : 0);
  const std::complex<double> omega2 = std::pow(2 * std::numbers::pi * f, 2) * lossy * lossy * lossy * lossy;
  const Eigen::Index n = section.count(), inner = setup.along.degree * n;
  // stiffness of all elements farther out, seen at the right vertex, with the far end held
  Eigen::MatrixXcd tail;
  for (auto e = elements.rbegin(); e != elements.rend(); ++e) {
    Eigen::MatrixXcd k = section_element_matrix(section, setup, omega2, *e);
    Eigen::Index rest = inner;
    if (tail.size() == 0) {
      rest -= n;
      k = Eigen::MatrixXcd(k.topLeftCorner(inner, inner));
    } else {
      k.bottomRightCorner(n, n) += tail;
    }
    e->transfer = -k.bottomRightCorner(rest, rest).partialPivLu().solve(k.bottomLeftCorner(rest, n));
    tail = k.topLeftCorner(n, n) + k.topRightCorner(n, rest) * e->transfer;
  }
  Eigen::VectorXcd u = section.drive.cast<std::complex<double>>();
  double ln_scale = 0;
  for (ModalElement& e : elements) {
    ln_scale += take_out_size(u);
    e.ln_scale = ln_scale;
    Eigen::VectorXcd all = Eigen::VectorXcd::Zero(inner + n);
    const Eigen::VectorXcd beyond = e.transfer * u;
    all.head(n) = u;
    all.segment(n, beyond.size()) = beyond;
    e.centre =
        Eigen::Map<const Eigen::MatrixXcd>(all.data(), n, setup.along.count()).transpose() * section.centre;
    u = all.tail(n);
    e.transfer.resize(0, 0);
  }
}

}  // namespace turnpoint::physics
