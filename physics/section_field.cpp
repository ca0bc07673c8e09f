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

SectionAssembler::SectionAssembler(const SectionBasis& section, const ModalSetup& setup,
                                   std::complex<double> omega2)
    : setup_(setup), omega2_(omega2), n_(section.count()), terms_(n_ * n_, 14) {
  using S = SectionBasis;
  const auto& k = section.stiff;
  Eigen::Index term = 0;
  const auto add = [&](const Eigen::MatrixXd& one) {
    terms_.col(term++) = Eigen::Map<const Eigen::VectorXd>(one.data(), one.size());
  };
  const auto both = [&](S::Part i, S::Part j) { add(k[i][j] + k[j][i]); };
  add(k[S::along][S::along]);
  for (const auto part : {S::stretch, S::across, S::local}) add(k[S::along][part]), add(k[part][S::along]);
  for (const auto part : {S::stretch, S::across, S::local}) add(k[part][part]);
  both(S::stretch, S::across), both(S::stretch, S::local), both(S::across, S::local);
  add(section.mass);
}

SectionElement SectionAssembler::element(const ModalElement& e) const {
  using Matrix = Eigen::MatrixXd;
  const Eigen::Index count = setup_.along.count();
  const Quadrature rule = gauss_legendre(setup_.along.degree + 3);
  const auto points = static_cast<Eigen::Index>(rule.x.size());
  // The strain is f' X + f (r R + s Y + Z), with X, R, Y and Z as in SectionBasis, r = -W'/W and s = 1/W.
  // Each term of the element's stiffness is an integral over x times a matrix over the section; `factors` has
  // the integrals in the order of `terms_`, a column for each pair of functions along x.
  Matrix factors = Matrix::Zero(terms_.cols(), count * (count + 1) / 2);
  for (std::size_t q = 0; q < rule.x.size(); ++q) {
    const double x = e.x0 + e.h * rule.x[q], w = setup_.taper.half_width_m(x);
    const double r = -setup_.taper.slope(x) / w, s = 1 / w, weight = e.h * rule.w[q] * w;
    const BasisValues basis = setup_.along.at(2 * rule.x[q] - 1);
    Eigen::Index pair = 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(count); ++a) {
      const double value = weight * basis.value[a], first = weight * basis.first[a] * 2 / e.h;
      for (std::size_t b = 0; b <= a; ++b, ++pair) {
        const double other = basis.value[b], other1 = basis.first[b] * 2 / e.h;
        const double vv = value * other, fv = first * other, vf = value * other1;
        double* const sum = factors.col(pair).data();
        sum[0] += first * other1;
        sum[1] += r * fv, sum[2] += r * vf;
        sum[3] += s * fv, sum[4] += s * vf;
        sum[5] += fv, sum[6] += vf;
        sum[7] += r * r * vv, sum[8] += s * s * vv, sum[9] += vv;
        sum[10] += r * s * vv, sum[11] += r * vv, sum[12] += s * vv;
      }
    }
  }
  const Eigen::RowVectorXd inertia = factors.row(9);
  factors.row(13) = -omega2_.real() * inertia;
  count_operations(20 * static_cast<double>(points * count * count) +
                   2 * static_cast<double>(terms_.size() * factors.cols()));
  const Matrix blocks = terms_ * factors;
  SectionElement all{Matrix(n_ * count, n_ * count), Matrix(n_ * count, n_ * count)};
  const Eigen::Map<const Matrix> mass(terms_.col(terms_.cols() - 1).data(), n_, n_);
  for (Eigen::Index a = 0, pair = 0; a < count; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b, ++pair) {
      const Eigen::Map<const Matrix> block(blocks.col(pair).data(), n_, n_);
      const double lossy = -omega2_.imag() * inertia[pair];
      all.real.block(a * n_, b * n_, n_, n_) = block;
      all.imaginary.block(a * n_, b * n_, n_, n_) = lossy * mass;
      if (a == b) continue;
      all.real.block(b * n_, a * n_, n_, n_) = block.transpose();
      all.imaginary.block(b * n_, a * n_, n_, n_) = lossy * mass;
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
  const SectionAssembler assembler(section, setup, omega2);
  struct Link {
    Condensed element;
    Eigen::MatrixXcd pull;  // unknowns of the right vertex are -pull times those of the left one
  };
  std::vector<Link> links(elements.size());
  // stiffness of all elements farther out, as seen at the right vertex, with the far end of the strip fixed
  Eigen::MatrixXcd tail;
  for (std::size_t i = elements.size(); i-- > 0;) {
    Link& link = links[i];
    const SectionElement e = assembler.element(elements[i]);
    link.element = Condensed(e.real, e.imaginary, n, n);
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
