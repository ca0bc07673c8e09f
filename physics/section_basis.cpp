#include "physics/section_basis.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "physics/dispersion.hpp"
#include "physics/operations.hpp"
#include "physics/root.hpp"
#include "physics/section_elements.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {
namespace {

using SectionMatrix = SectionBasis::Matrix;

// One component of the strain or of the motion at the quadrature points: a row per function, of which the
// first is function number `first`. For all other functions it is 0; without rows, for all.
struct Component {
  SectionMatrix values;
  Eigen::Index first = 0;
};
using Components = std::vector<Component>;

SectionMatrix weighted_gram(Eigen::Index count, const Components& a, const SectionMatrix& law,
                            const Components& b, const Eigen::VectorXd& weight) {
  SectionMatrix sum = SectionMatrix::Zero(count, count);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].values.size() == 0) continue;
    const SectionMatrix weighted = a[i].values * weight.asDiagonal();
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double part = law(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (part == 0 || b[j].values.size() == 0) continue;
      count_operations(2 * static_cast<double>(weighted.size() * b[j].values.rows()));
      sum.block(a[i].first, b[j].first, weighted.rows(), b[j].values.rows()).noalias() +=
          part * weighted * b[j].values.transpose();
    }
  }
  return sum;
}

SectionBasis integrate_section(Eigen::Index count, const std::array<Components, 4>& strain,
                               const SectionMatrix& law, const Components& motion,
                               const SectionMatrix& inertia, const Eigen::VectorXd& weight) {
  SectionBasis basis;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      basis.stiff[i][j] = weighted_gram(count, strain[i], law, strain[j], weight);
      if (j < i) basis.stiff[j][i] = basis.stiff[i][j].transpose();
    }
  }
  basis.mass = weighted_gram(count, motion, inertia, motion, weight);
  return basis;
}

// The functions (1 - t^2) P_n(t) sqrt(2n + 1), n = first, first + 2, ..., and their derivatives, at t = 0 and
// at the nodes of the rule.
void bubbles(int count, int first, const Quadrature& rule, SectionMatrix& value, SectionMatrix& slope,
             Eigen::VectorXd& start) {
  const auto nodes = static_cast<Eigen::Index>(rule.x.size());
  value.resize(count, nodes);
  slope.resize(count, nodes);
  start.resize(count);
  for (Eigen::Index q = 0; q <= nodes; ++q) {
    const double t = q == nodes ? 0 : rule.x[static_cast<std::size_t>(q)];
    double p0 = 1, p1 = t, d0 = 0, d1 = 1;
    for (int k = 0; k < first + 2 * count; ++k) {
      const int i = (k - first) / 2;
      if (k >= first && (k - first) % 2 == 0) {
        const double scale = std::sqrt(2 * k + 1.0);
        if (q == nodes) {
          start[i] = scale * p0;
        } else {
          value(i, q) = scale * (1 - t * t) * p0;
          slope(i, q) = scale * ((1 - t * t) * d0 - 2 * t * p0);
        }
      }
      const double m = k + 2;
      const double p2 = ((2 * m - 1) * t * p1 - (m - 1) * p0) / m;
      const double d2 = ((2 * m - 1) * (p1 + t * d1) - (m - 1) * d0) / m;
      p0 = p1, p1 = p2, d0 = d1, d1 = d2;
    }
  }
}

// The functions for a Mindlin plate: first those of the rotations beta_x and beta_y, then those of the
// deflection w, which has the given parity.
SectionBasis mindlin_section(const MindlinPlate& plate, int each, Parity parity = Parity::even) {
  const Quadrature rule = gauss_legendre(2 * each + 6);
  const auto nodes = static_cast<Eigen::Index>(rule.x.size());
  const Eigen::Map<const Eigen::VectorXd> eta(rule.x.data(), nodes), weight(rule.w.data(), nodes);
  const int first = parity == Parity::odd;
  // functions with the same parity as w, and with the opposite parity
  SectionMatrix same, same1, other, other1;
  Eigen::VectorXd same_start, other_start;
  bubbles(each, first, rule, same, same1, same_start);
  bubbles(each, 1 - first, rule, other, other1, other_start);
  const Components motion{{same, 0}, {other, each}, {same, 2 * each}};
  const Components slope{{same1, 0}, {other1, each}, {same1, 2 * each}};
  Components stretched = slope;
  for (Component& one : stretched) one.values = one.values * eta.asDiagonal();
  const Component zero{};
  // components of the strain: curvatures kappa_xx, kappa_yy, kappa_xy and shears gamma_x, gamma_y
  const auto by_x = [&](const Components& u) -> Components { return {u[0], zero, u[1], u[2], zero}; };
  const Components by_y{zero, slope[1], slope[0], zero, slope[2]};
  const Components local{zero, zero, zero, motion[0], motion[1]};
  SectionMatrix law = SectionMatrix::Zero(5, 5);
  const double d = plate.stiffness_N_m;
  law(0, 0) = law(1, 1) = d;
  law(0, 1) = law(1, 0) = d - 2 * plate.twist_N_m;  // this is nu D
  law(2, 2) = plate.twist_N_m;
  law(3, 3) = law(4, 4) = plate.shear_N_per_m;
  SectionMatrix inertia = SectionMatrix::Zero(3, 3);
  inertia.diagonal() << plate.rotary_inertia_kg, plate.rotary_inertia_kg, plate.mass_kg_per_m2;
  SectionBasis basis =
      integrate_section(3 * each, {by_x(motion), by_x(stretched), by_y, local}, law, motion, inertia, weight);
  basis.centre = Eigen::VectorXd::Zero(3 * each);
  if (parity == Parity::even) basis.centre.tail(each) = same_start;
  return basis;
}

SectionPencil mindlin_pencil(const SectionBasis& b, double half_width, Eigen::Index each) {
  using B = SectionBasis;
  const Eigen::Index rest = b.count() - each;
  // In a uniform strip, the strain is f' X + f (Y/W + Z), see SectionBasis. The following matrix is the
  // quadratic form of the part Y/W + Z.
  const SectionMatrix still = b.stiff[B::across][B::across] / (half_width * half_width) +
                              (b.stiff[B::across][B::local] + b.stiff[B::local][B::across]) / half_width +
                              b.stiff[B::local][B::local];
  const SectionMatrix mixed = b.stiff[B::along][B::across] / half_width + b.stiff[B::along][B::local];
  SectionPencil p;
  p.shear = still.topLeftCorner(each, each);
  p.along = b.stiff[B::along][B::along].topLeftCorner(each, each);
  p.along_mass = b.mass.topLeftCorner(each, each);
  p.coupling = mixed.topRightCorner(each, rest) - mixed.bottomLeftCorner(rest, each).transpose();
  p.stretching = (b.stiff[B::across][B::stretch] / half_width + b.stiff[B::local][B::stretch])
                     .topRightCorner(each, rest);
  p.plane = still.bottomRightCorner(rest, rest);
  p.cross = b.stiff[B::along][B::along].bottomRightCorner(rest, rest);
  p.mass = b.mass.bottomRightCorner(rest, rest);
  return p;
}

// The model `mode` uses the cut-off shapes of strips with these two half-widths. The first is that of the
// drive edge, whose shape drives the strip. The second is that of the tone's turning point, where the shapes
// are exact.
std::array<double, 2> shape_widths(const Surface& surface, double f) {
  const double drive = half_width_m(surface, 0);
  return {drive, std::min(Dispersion(surface).cut_off_half_width_m(f), 0.85 * drive)};
}

// Returns k_x^2 of the first mode's travelling wave at the drive edge by Mindlin's theory, which is the
// largest root of the strip's dispersion function; 0 if there is no root.
double travelling2(const Surface& surface, double f) {
  const MindlinPlate plate(surface);
  const double w = half_width_m(surface, 0), highest = plate.waves(f).bending;
  constexpr int steps = 200;
  const auto at = [&](double along2) { return plate.characteristic(f, w, along2); };
  Chord step{0, 0, highest * (1 - 0.5 / steps), 0};
  step.f_right = at(step.right);
  for (int i = 1; i < steps; ++i) {
    step.left = highest * (1 - (i + 0.5) / steps);
    step.f_left = at(step.left);
    if ((step.f_left > 0) != (step.f_right > 0))
      return false_position(step, at, {4}, 0, [](const Chord& c) { return c.width() <= 1e-9 * c.right; });
    step.right = step.left, step.f_right = step.f_left;
  }
  return 0;
}

// The motions `cross`, `along` and `stretched` for one half-width, one per column. They are scaled so that
// `cross` moves the centre line by 1.
SectionMatrix columns(const SectionShapes& shapes, double centre) {
  const Eigen::Index na = shapes.along.size(), nb = shapes.cross.size();
  SectionMatrix all = SectionMatrix::Zero(na + nb, 3);
  const double size = shapes.cross.norm() / centre;
  all.col(0).tail(nb) = shapes.cross / centre;
  all.col(1).head(na) = shapes.along * (size / shapes.along.norm());
  all.col(2).head(na) = shapes.stretched * (size / shapes.stretched.norm());
  return all;
}

SectionMatrix mindlin_columns(const SectionBasis& full, double half_width, Eigen::Index each) {
  const SectionShapes shapes = section_shapes_of(mindlin_pencil(full, half_width, each));
  return columns(shapes, shapes.cross.dot(full.centre.tail(full.count() - each)));
}

SectionBasis mindlin_shapes(const Surface& surface, double f) {
  constexpr int each = 8;
  const SectionBasis full = mindlin_section(MindlinPlate(surface), each);
  const auto widths = shape_widths(surface, f);
  const SectionShapes wave = section_shapes_of(mindlin_pencil(full, widths[0], each),
                                               2 * std::numbers::pi * f, travelling2(surface, f));
  SectionMatrix shapes(full.count(), 9);
  shapes << mindlin_columns(full, widths[0], each), mindlin_columns(full, widths[1], each),
      columns(wave, wave.cross.dot(full.centre.tail(full.count() - each)));
  SectionBasis basis;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      basis.stiff[i][j] = shapes.transpose() * full.stiff[i][j] * shapes;
      if (j < i) basis.stiff[j][i] = basis.stiff[i][j].transpose();
    }
  }
  basis.mass = shapes.transpose() * full.mass * shapes;
  basis.centre = shapes.transpose() * full.centre;
  basis.drive = Eigen::VectorXd::Unit(shapes.cols(), 0);
  return basis;
}

// One component of displacement and its derivatives at all quadrature points, with one row per shape.
struct Displacement {
  SectionMatrix value, by_eta, by_z;
};

Displacement displacement(const SectionMatrix& coefficients, const LineFunctions& across, bool odd_across,
                          const LineFunctions& through, bool odd_through) {
  const SectionMatrix& y = odd_across ? across.odd : across.even;
  const SectionMatrix& y1 = odd_across ? across.odd_slope : across.even_slope;
  const SectionMatrix& z = odd_through ? through.odd : through.even;
  const SectionMatrix& z1 = odd_through ? through.odd_slope : through.even_slope;
  const Eigen::Index points = y.cols() * z.cols();
  Displacement all{SectionMatrix(coefficients.cols(), points), SectionMatrix(coefficients.cols(), points),
                   SectionMatrix(coefficients.cols(), points)};
  for (Eigen::Index i = 0; i < coefficients.cols(); ++i) {
    const Eigen::VectorXd column = coefficients.col(i);
    // coefficients ordered by y, then z
    const Eigen::Map<const SectionMatrix> c(column.data(), z.rows(), y.rows());
    const auto at = [&](const SectionMatrix& of_z, const SectionMatrix& of_y) -> Eigen::RowVectorXd {
      const SectionMatrix grid = of_z.transpose() * c * of_y;
      return Eigen::Map<const Eigen::RowVectorXd>(grid.data(), points);
    };
    all.value.row(i) = at(z, y);
    all.by_eta.row(i) = at(z, y1);
    all.by_z.row(i) = at(z1, y);
  }
  return all;
}

SectionMatrix stacked_rows(const std::vector<SectionMatrix>& parts) {
  SectionMatrix all(0, parts.front().cols());
  for (const SectionMatrix& one : parts) {
    all.conservativeResize(all.rows() + one.rows(), Eigen::NoChange);
    all.bottomRows(one.rows()) = one;
  }
  return all;
}

SectionBasis elastic_shapes(const Surface& surface, double f) {
  const auto widths = shape_widths(surface, f);
  const double layer = std::min(0.5, 1.2 * surface.thickness_m / widths[1]);
  const double speed2 = *surface.modulus_Pa / (2 * (1 + surface.poisson) * surface.density_kg_m3);
  // for each component of displacement: its values and its derivatives with respect to eta and to z
  std::array<std::vector<SectionMatrix>, 9> parts;
  Eigen::VectorXd weight, eta, centres(0);
  double lame = 0;
  for (std::size_t i = 0; i < widths.size(); ++i) {
    const SectionElements section(surface.thickness_m / widths[i], surface.poisson, layer);
    const LineFunctions &y = section.across, &z = section.through;
    const Eigen::Index na = y.even.rows() * z.odd.rows(), nb = y.odd.rows() * z.odd.rows();
    const Eigen::Index nc = y.even.rows() * z.even.rows();
    Eigen::VectorXd centre(nc);
    for (Eigen::Index j = 0; j < y.even.rows(); ++j)
      centre.segment(j * z.even.rows(), z.even.rows()) = y.even_start[j] * z.even_start;
    const SectionShapes found = section_shapes_of(section.pencil);
    SectionMatrix shapes = columns(found, found.cross.tail(nc).dot(centre));
    if (i == 0) {
      const double in_units = widths[0] / std::sqrt(speed2);
      const SectionShapes wave = section_shapes_of(section.pencil, 2 * std::numbers::pi * f * in_units,
                                                   travelling2(surface, f) * widths[0] * widths[0]);
      shapes.conservativeResize(Eigen::NoChange, 6);
      shapes.rightCols(3) = columns(wave, wave.cross.tail(nc).dot(centre));
    }
    if (i == 1) {
      const Eigen::VectorXd thickening = section.thickening(shapes.col(1).head(na));
      shapes.conservativeResize(Eigen::NoChange, 4);
      shapes.col(3).head(na).setZero();
      shapes.col(3).tail(nb + nc) = thickening * (shapes.col(0).norm() / thickening.norm());
    }
    const std::array<Displacement, 3> u{displacement(shapes.topRows(na), y, false, z, true),
                                        displacement(shapes.middleRows(na, nb), y, true, z, true),
                                        displacement(shapes.bottomRows(nc), y, false, z, false)};
    for (std::size_t c = 0; c < 3; ++c) {
      parts[c].push_back(u[c].value);
      parts[3 + c].push_back(u[c].by_eta);
      parts[6 + c].push_back(u[c].by_z / widths[i]);
    }
    const Eigen::VectorXd deflection = shapes.bottomRows(nc).transpose() * centre;
    centres.conservativeResize(centres.size() + deflection.size());
    centres.tail(deflection.size()) = deflection;
    lame = section.lame;
    if (i > 0) continue;  // the quadrature points are the same for all half-widths, so one pass is enough
    weight.resize(y.at.size() * z.at.size());
    eta.resize(weight.size());
    for (Eigen::Index j = 0; j < y.at.size(); ++j) {
      weight.segment(j * z.at.size(), z.at.size()) = y.weight[j] * z.weight;
      eta.segment(j * z.at.size(), z.at.size()).setConstant(y.at[j]);
    }
  }
  std::array<Component, 9> u;
  for (std::size_t i = 0; i < u.size(); ++i) u[i].values = stacked_rows(parts[i]);
  const Component zero{};
  const auto stretched = [&](Component slope) {
    slope.values = slope.values * eta.asDiagonal();
    return slope;
  };
  // components of the strain in the order xx, yy, zz, yz, xz, xy; the stiffness is divided by the shear
  // modulus
  const Components by_x{u[0], zero, zero, zero, u[2], u[1]};
  const Components stretch{stretched(u[3]), zero, zero, zero, stretched(u[5]), stretched(u[4])};
  const Components by_y{zero, u[4], zero, u[5], zero, u[3]};
  const Components local{zero, zero, u[8], u[7], u[6], zero};
  SectionMatrix law = SectionMatrix::Identity(6, 6);
  law.topLeftCorner(3, 3).setConstant(lame);
  law.topLeftCorner(3, 3).diagonal().setConstant(lame + 2);
  SectionBasis basis = integrate_section(centres.size(), {by_x, stretch, by_y, local}, law,
                                         {u[0], u[1], u[2]}, SectionMatrix::Identity(3, 3) / speed2, weight);
  basis.centre = centres;
  basis.drive = Eigen::VectorXd::Unit(centres.size(), 0);
  return basis;
}

}  // namespace

SectionBasis mindlin_polynomials(const Surface& surface, int each, Parity parity) {
  SectionBasis basis = mindlin_section(MindlinPlate(surface), each, parity);
  basis.drive = Eigen::VectorXd::Zero(basis.count());
  if (parity == Parity::even) basis.drive = mindlin_columns(basis, half_width_m(surface, 0), each).col(0);
  return basis;
}

SectionBasis section_shapes(const Surface& surface, double f) {
  return surface.theory == PlateTheory::elastic ? elastic_shapes(surface, f) : mindlin_shapes(surface, f);
}

}  // namespace turnpoint::physics
