#include "physics/modal_load.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/condensed.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/modal_setup.hpp"
#include "physics/section_basis.hpp"
#include "physics/section_field.hpp"
#include "physics/smooth_sides.hpp"

namespace turnpoint::physics {
namespace {

using Matrix = Eigen::MatrixXcd;
using Vector = Eigen::VectorXcd;

// The finite elements of the field, with all data that are needed to compute its response to a load. The
// matrices describe one half of the strip.
struct Strip {
  ModalSetup setup;
  std::vector<ModalElement> elements;
  std::vector<Matrix> matrices;
  Eigen::VectorXd drive;  // unknowns of the drive edge
  // number of functions that are ordered before those of the deflection (rotations of a thick plate)
  int other_functions;
  int power;  // exponent of (1 - eta^2) in the deflection's functions, see add_bubbles()
  Parity parity;
  std::complex<double> compliance;  // factor that turns 1 / matrix into metres per newton
};

// The numbers of unknowns of an element at its left and at its right vertex. Its unknowns are ordered: left
// vertex, bubbles, right vertex.
struct Sizes {
  Eigen::Index left, right;
  Sizes(const ModalElement& e, int per_vertex) : left(per_vertex * e.left), right(per_vertex * e.right) {}
};

// Solves the linear equations of a strip: eliminates the bubbles of each element, then the vertices from the
// tip to the drive edge.
class Chain {
 public:
  Chain(const Strip& strip);
  // Returns load^T matrix^-1 load for loads on consecutive elements, beginning with element `first`. The
  // drive edge is held.
  std::complex<double> quadratic(std::size_t first, const std::vector<Vector>& loads) const;
  // Returns the unknowns of each element for a motion of the drive edge.
  std::vector<Vector> driven(const Eigen::VectorXd& drive) const;

 private:
  struct Link {
    Eigen::Index left, right;
    Condensed element;
    Eigen::PartialPivLU<Matrix> right_stiffness;  // stiffness of the right vertex and everything beyond it
    Matrix pull;  // unknowns of the right vertex are -pull times those of the left one
    // A load on the right vertex, after elimination of everything beyond it, adds right^T compliance right to
    // load^T matrix^-1 load.
    Matrix compliance;
  };
  std::vector<Link> links_;
};

Chain::Chain(const Strip& strip) {
  links_.resize(strip.elements.size());
  Matrix tail;
  for (std::size_t i = links_.size(); i-- > 0;) {
    Link& link = links_[i];
    const Sizes size(strip.elements[i], strip.setup.along.per_vertex);
    link.left = size.left, link.right = size.right;
    link.element = Condensed(strip.matrices[i].real(), strip.matrices[i].imag(), link.left, link.right);
    const Matrix& outer = link.element.ends();
    Matrix left = outer.topLeftCorner(link.left, link.left);
    if (link.right > 0) {
      link.right_stiffness.compute(outer.bottomRightCorner(link.right, link.right) + tail);
      link.pull = link.right_stiffness.solve(outer.bottomLeftCorner(link.right, link.left));
      left -= outer.topRightCorner(link.left, link.right) * link.pull;
    }
    tail = left;
  }
  for (std::size_t i = 0; i < links_.size(); ++i) {
    Link& link = links_[i];
    if (link.right == 0) continue;
    link.compliance = link.right_stiffness.inverse();
    if (i > 0) link.compliance += link.pull * links_[i - 1].compliance * link.pull.transpose();
  }
}

std::complex<double> Chain::quadratic(std::size_t first, const std::vector<Vector>& loads) const {
  std::complex<double> sum = 0;
  // the load that elimination has left on the vertex shared with the next element farther out
  Vector vertex;
  for (std::size_t i = first + loads.size(); i-- > first;) {
    const Link& link = links_[i];
    const Vector& load = loads[i - first];
    const Vector bubbles = link.element.reduce(load.segment(link.left, load.size() - link.left - link.right));
    sum += link.element.quadratic(bubbles);
    const Vector ends = link.element.load_on_ends(bubbles);
    Vector left = load.head(link.left) + ends.head(link.left);
    if (link.right > 0) {
      Vector right = load.tail(link.right) + ends.tail(link.right);
      if (vertex.size() > 0) right += vertex;
      sum += (right.transpose() * link.right_stiffness.solve(right))(0, 0);
      left -= link.pull.transpose() * right;
    }
    vertex = left;
  }
  if (first > 0) sum += (vertex.transpose() * links_[first - 1].compliance * vertex)(0, 0);
  return sum;
}

std::vector<Vector> Chain::driven(const Eigen::VectorXd& drive) const {
  std::vector<Vector> all;
  Vector left = drive.cast<std::complex<double>>();
  for (const Link& link : links_) {
    Vector ends(link.left + link.right);
    ends.head(link.left) = left;
    if (link.right > 0) ends.tail(link.right) = -(link.pull * left);
    Vector& u = all.emplace_back(ends.size() + link.element.bubbles());
    u << left, link.element.follow(ends), ends.tail(link.right);
    left = ends.tail(link.right);
  }
  return all;
}

// Half of the strip by Mindlin's theory. The unknowns are two rotations and the deflection.
Strip thick_strip(const Surface& surface, double f, Parity parity) {
  Surface plate = surface;
  plate.theory = PlateTheory::mindlin;
  ModalSetup setup = make_modal_setup(plate, f, Losses::kept, {});
  double match_m = 0;
  auto elements = make_modal_elements(setup, {}, match_m);
  const int each = setup.across.count();
  const SectionBasis section = mindlin_polynomials(plate, each, parity);
  const std::complex<double> loss = std::pow(Dispersion(plate).loss(f, plate.quality_factor), 4);
  const std::complex<double> omega2 = std::pow(2 * std::numbers::pi * f, 2) * loss;
  const SectionAssembler assembler(section, setup, omega2);
  std::vector<Matrix> matrices;
  for (ModalElement& e : elements) {
    e.left = e.right = static_cast<int>(section.count());
    const SectionElement one = assembler.element(e);
    matrices.push_back(one.real + std::complex<double>(0, 1) * one.imaginary);
  }
  elements.back().right = 0;
  const Eigen::Index kept = matrices.back().rows() - section.count();
  matrices.back() = Matrix(matrices.back().topLeftCorner(kept, kept));
  Eigen::VectorXd drive = section.drive;
  if (parity == Parity::even) drive /= section.drive.dot(section.centre);
  return {std::move(setup), std::move(elements), std::move(matrices), drive, 2 * each, 1, parity, 0.5 * loss};
}

// Half of a thin strip. The matrices are divided by the bending stiffness (plate) or by the tension
// (membrane).
Strip thin_strip(const Surface& surface, const ModalSetup& setup, Parity parity) {
  double match_m = 0;
  auto elements = make_modal_elements(setup, {}, match_m);
  const int power = setup.along.per_vertex;
  const auto across = TransverseBasis::polynomials(setup.across.count(), power, parity);
  const ModalAssembler assembler(setup.taper, across, setup.along, setup.equation,
                                 setup.taper.half_width_m(0));
  std::vector<Matrix> matrices;
  for (const ModalElement& e : elements) matrices.push_back(assembler.matrix(e));
  Eigen::VectorXd drive = Eigen::VectorXd::Zero(power * elements.front().left);
  if (parity == Parity::even) {
    const int functions = elements.front().left;
    drive = drive_unknowns(setup, across, across.project(drive_shape(surface, setup.equation)), functions);
    drive /= drive.head(functions).dot(across.centre.head(functions));
  }
  return {setup, std::move(elements), std::move(matrices), drive, 0, power, parity, 0.5};
}

// Returns strips whose responses add up to the response of the surface.
std::vector<Strip> make_strips(const Surface& surface, double f, Parity parity) {
  const Dispersion dispersion(surface);
  if (dispersion.clamped_bending() && surface.theory != PlateTheory::kirchhoff)
    return {thick_strip(surface, f, parity)};
  ModalSetup setup = make_modal_setup(surface, f, Losses::kept, {});
  std::vector<Strip> all{thin_strip(surface, setup, parity)};
  const std::complex<double> inertia = setup.equation.inertia;
  const double lossless = make_modal_setup(surface, f, Losses::left_out, {}).equation.inertia.real();
  const double tension = line_tension_N_per_m(surface), bending = dispersion.stiffness_N_m;
  if (!dispersion.bending || dispersion.clamped) {
    all[0].compliance *= inertia / lossless / (dispersion.bending ? bending : tension);
    return all;
  }
  // With simply supported sides the equation is D (lap + k^2) (lap - k2^2) v = force. Its response is a
  // multiple of the difference of two membranes' responses, one with k^2 and one with -k2^2.
  const std::complex<double> evanescent = inertia + tension / bending;
  const std::complex<double> loss = inertia * evanescent / (lossless * (lossless + tension / bending));
  setup.equation.inertia = -evanescent;
  all.push_back(thin_strip(surface, setup, parity));
  all[0].compliance *= loss / (bending * (inertia + evanescent));
  all[1].compliance = -all[0].compliance;
  all[1].drive.setZero();
  return all;
}

// The weights of a mean over the disc, in the form of loads on consecutive elements.
struct DiscLoad {
  std::size_t first = 0;
  std::vector<Vector> loads;
};

// Returns the integrals of the transverse functions of the deflection over the width of the disc at one x.
Eigen::VectorXd across_disc(const Strip& strip, int functions, double half_width, double from, double to) {
  const Quadrature rule = gauss_legendre(14);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(functions);
  if (!(from < to)) return sum;
  // of functions that are symmetric about the middle of the disc, one half of the points is enough
  const bool half = from == -to && strip.parity == Parity::even;
  for (std::size_t i = half ? rule.x.size() / 2 : 0; i < rule.x.size(); ++i)
    add_bubbles(sum, strip.power, strip.parity, (from + (to - from) * rule.x[i]) / half_width,
                (half ? 2 : 1) * (to - from) * rule.w[i]);
  return sum;
}

Vector element_load(const Strip& strip, const ModalElement& e, double x_m, const Disc& disc) {
  const ElementBasis& along = strip.setup.along;
  const int functions = e.left, deflections = functions - strip.other_functions;
  Vector load = Vector::Zero(along.count() * functions);
  const double from = std::max(e.x0, x_m - disc.radius_m), to = std::min(e.x0 + e.h, x_m + disc.radius_m);
  const double area = std::numbers::pi * disc.radius_m * disc.radius_m;
  const double slope_factor = 0.5 * e.h / strip.setup.taper.half_width_m(0);
  const Quadrature rule = gauss_legendre(12);
  for (std::size_t i = 0; i < rule.x.size(); ++i) {
    const double x = from + (to - from) * rule.x[i], w = strip.setup.taper.half_width_m(x);
    const double chord = std::sqrt(std::max(0.0, disc.radius_m * disc.radius_m - (x - x_m) * (x - x_m)));
    const Eigen::VectorXd across = across_disc(strip, deflections, w, std::max(-w, disc.beside_m - chord),
                                               std::min(w, disc.beside_m + chord)) *
                                   ((to - from) * rule.w[i] / area);
    const BasisValues basis = along.at(2 * (x - e.x0) / e.h - 1);
    for (int a = 0; a < along.count(); ++a) {
      const bool slope = along.per_vertex == 2 && (a == 1 || a == along.count() - 1);
      load.segment(a * functions + strip.other_functions, deflections) +=
          across * (basis.value[static_cast<std::size_t>(a)] * (slope ? slope_factor : 1));
    }
  }
  // The right vertex may have fewer transverse functions than the left one.
  const Eigen::Index rest = (along.count() - along.per_vertex) * functions;
  Vector kept(rest + along.per_vertex * e.right);
  kept.head(rest) = load.head(rest);
  for (int v = 0; v < along.per_vertex; ++v)
    kept.segment(rest + v * e.right, e.right) = load.segment(rest + v * functions, e.right);
  return kept;
}

DiscLoad disc_load(const Strip& strip, double x_m, const Disc& disc) {
  DiscLoad all;
  for (std::size_t i = 0; i < strip.elements.size(); ++i) {
    const ModalElement& e = strip.elements[i];
    if (e.x0 + e.h <= x_m - disc.radius_m || e.x0 >= x_m + disc.radius_m) continue;
    if (all.loads.empty()) all.first = i;
    all.loads.push_back(element_load(strip, e, x_m, disc));
  }
  return all;
}

void add_responses(const Strip& strip, const Disc& disc, const std::vector<double>& x_m,
                   std::vector<DiscResponse>& all) {
  const Chain chain(strip);
  const std::vector<Vector> driven = chain.driven(strip.drive);
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    const DiscLoad load = disc_load(strip, x_m[i], disc);
    if (load.loads.empty()) continue;
    for (std::size_t j = 0; j < load.loads.size(); ++j)
      all[i].unloaded += (load.loads[j].transpose() * driven[load.first + j])(0, 0);
    all[i].receptance_m_per_N += strip.compliance * chain.quadratic(load.first, load.loads);
  }
}

}  // namespace

std::vector<DiscResponse> disc_responses(const Surface& surface, double f, const Disc& disc,
                                         const std::vector<double>& x_m) {
  const Surface smooth = smooth_sides(surface);
  std::vector<DiscResponse> all(x_m.size());
  for (const Strip& strip : make_strips(smooth, f, Parity::even)) add_responses(strip, disc, x_m, all);
  if (disc.beside_m == 0) return all;
  for (const Strip& strip : make_strips(smooth, f, Parity::odd)) add_responses(strip, disc, x_m, all);
  return all;
}

}  // namespace turnpoint::physics
