#include "physics/section_field.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/condensed.hpp"
#include "physics/dispersion.hpp"
#include "physics/operations.hpp"

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

SectionElement section_element(const SectionBasis& section, const ModalSetup& setup, const ModalElement& e) {
  using S = SectionBasis;
  using Matrix = Eigen::MatrixXd;
  const Eigen::Index n = section.count(), count = setup.along.count();
  const Quadrature rule = gauss_legendre(setup.along.degree + 3);
  const auto points = static_cast<Eigen::Index>(rule.x.size());
  // basis functions along x and their derivatives, one row per quadrature point; s = 1/W and r = -W'/W
  Matrix value(points, count), first(points, count);
  Eigen::VectorXd weight(points), r(points), s(points);
  for (Eigen::Index q = 0; q < points; ++q) {
    const auto node = static_cast<std::size_t>(q);
    const double x = e.x0 + e.h * rule.x[node], w = setup.taper.half_width_m(x);
    r[q] = -setup.taper.slope(x) / w, s[q] = 1 / w;
    weight[q] = e.h * rule.w[node] * w;
    const BasisValues basis = setup.along.at(2 * rule.x[node] - 1);
    for (Eigen::Index a = 0; a < count; ++a) {
      value(q, a) = basis.value[static_cast<std::size_t>(a)];
      first(q, a) = basis.first[static_cast<std::size_t>(a)] * 2 / e.h;
    }
  }
  const auto gram = [&weight](const Matrix& a, const Eigen::VectorXd& by, const Matrix& b) -> Matrix {
    return a.transpose() * weight.cwiseProduct(by).asDiagonal() * b;
  };
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(points);
  // The strain is f' X + f (r R + s Y + Z), with X, R, Y and Z as in SectionBasis. Each term of the element's
  // stiffness is a matrix over x times a matrix over the section.
  const Matrix xx = gram(first, one, first), xr = gram(first, r, value), xs = gram(first, s, value),
               xz = gram(first, one, value), rr = gram(value, r.cwiseProduct(r), value),
               ss = gram(value, s.cwiseProduct(s), value), zz = gram(value, one, value),
               rs = gram(value, r.cwiseProduct(s), value), rz = gram(value, r, value),
               sz = gram(value, s, value);
  const auto& k = section.stiff;
  const auto both = [&k](S::Part i, S::Part j) -> Matrix { return k[i][j] + k[i][j].transpose(); };
  const Matrix stretch_across = both(S::stretch, S::across), stretch_local = both(S::stretch, S::local),
               across_local = both(S::across, S::local);
  // ten products over the quadrature points, and ten matrices of the section for each pair of functions along
  // x
  count_operations(20 * static_cast<double>(points * count * count) +
                   14 * static_cast<double>(n * n * count * (count + 1)));
  SectionElement all{Matrix(n * count, n * count), Matrix(n * count, n * count)};
  for (Eigen::Index a = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      auto stiffness = all.stiffness.block(a * n, b * n, n, n);
      auto mass = all.mass.block(a * n, b * n, n, n);
      stiffness = xx(a, b) * k[S::along][S::along] + xr(a, b) * k[S::along][S::stretch] +
                  xs(a, b) * k[S::along][S::across] + xz(a, b) * k[S::along][S::local] +
                  rr(a, b) * k[S::stretch][S::stretch] + ss(a, b) * k[S::across][S::across] +
                  zz(a, b) * k[S::local][S::local] + rs(a, b) * stretch_across + rz(a, b) * stretch_local +
                  sz(a, b) * across_local;
      stiffness += (xr(b, a) * k[S::along][S::stretch] + xs(b, a) * k[S::along][S::across] +
                    xz(b, a) * k[S::along][S::local])
                       .transpose();
      mass = zz(a, b) * section.mass;
      if (a == b) continue;
      all.stiffness.block(b * n, a * n, n, n) = stiffness.transpose();
      all.mass.block(b * n, a * n, n, n) = mass.transpose();
    }
  }
  return all;
}

void solve_section_elements(const Surface& surface, double f, Losses losses,
                            const ModalResolution& resolution, const ModalSetup& setup,
                            std::vector<ModalElement>& elements) {
  if (resolution.drive)
    throw std::invalid_argument("drive shapes can be given for plate theory kirchhoff only");
  const SectionBasis section = make_section(surface, f, resolution, setup);
  const std::complex<double> lossy =
      losses == Losses::kept ? Dispersion(surface).loss(f, surface.quality_factor) : 1;
  const std::complex<double> omega2 = std::pow(2 * std::numbers::pi * f, 2) * lossy * lossy * lossy * lossy;
  const Eigen::Index n = section.count();
  struct Link {
    Condensed element;
    Eigen::MatrixXcd pull;  // unknowns of the right vertex are -pull times those of the left one
  };
  std::vector<Link> links(elements.size());
  // stiffness of all elements farther out, as seen at the right vertex, with the far end of the strip fixed
  Eigen::MatrixXcd tail;
  for (std::size_t i = elements.size(); i-- > 0;) {
    Link& link = links[i];
    const SectionElement e = section_element(section, setup, elements[i]);
    link.element = Condensed(e.stiffness - omega2.real() * e.mass, -omega2.imag() * e.mass, n, n);
    const Eigen::MatrixXcd& ends = link.element.ends();
    if (tail.size() == 0) {
      link.pull = Eigen::MatrixXcd::Zero(n, n);
    } else {
      count_factorisation(static_cast<double>(n), static_cast<double>(n));
      link.pull = (ends.bottomRightCorner(n, n) + tail).partialPivLu().solve(ends.bottomLeftCorner(n, n));
    }
    count_operations(8 * static_cast<double>(n * n * n));
    tail = ends.topLeftCorner(n, n) - ends.topRightCorner(n, n) * link.pull;
  }
  Eigen::VectorXcd u = section.drive.cast<std::complex<double>>();
  double ln_scale = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    ModalElement& e = elements[i];
    ln_scale += take_out_size(u);
    e.ln_scale = ln_scale;
    Eigen::VectorXcd ends(2 * n), all((setup.along.count()) * n);
    ends << u, -(links[i].pull * u);
    all << u, links[i].element.follow(ends), ends.tail(n);
    e.centre =
        Eigen::Map<const Eigen::MatrixXcd>(all.data(), n, setup.along.count()).transpose() * section.centre;
    u = all.tail(n);
  }
}

}  // namespace turnpoint::physics
