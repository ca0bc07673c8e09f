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
#include "physics/operations.hpp"
#include "physics/piston_lift.hpp"
#include "physics/section_field.hpp"
#include "physics/smooth_sides.hpp"

namespace turnpoint::physics {
namespace {

// the PistonLift reaches into the strip by this many half-widths of the drive edge
constexpr double lift_widths = 0.45;
// quadrature nodes along x; across the strip, one more for each transverse function
constexpr int lift_nodes = 12;

// Eliminates the load on one element (static condensation): moves it from the inner unknowns (bubbles) and
// the right vertex to the left vertex. `tail` is the load on all elements farther out, as a load on the right
// vertex. Returns the resulting load on the left vertex.
Eigen::VectorXcd eliminate_load(ModalElement& e, const Eigen::PartialPivLU<Eigen::MatrixXcd>& right_stiffness,
                                Eigen::Index left, const Eigen::VectorXcd& tail) {
  const Eigen::Index right = e.pull.rows(), bubbles = e.inner.bubbles();
  const Eigen::VectorXcd reduced = e.inner.reduce(e.load.segment(left, bubbles));
  const Eigen::VectorXcd on_ends = e.inner.load_on_ends(reduced);
  Eigen::VectorXcd seen = e.load.head(left) + on_ends.head(left);
  e.bubbles_under_load = e.inner.under(reduced);
  if (right == 0) return seen;
  Eigen::VectorXcd on_right = e.load.tail(right) + on_ends.tail(right);
  if (tail.size() > 0) on_right += tail;
  e.right_under_load = right_stiffness.solve(on_right);
  return seen - e.pull.transpose() * on_right;
}

// The same as eliminate(), but with pivoting. It is for plates, whose equation is of fourth order.
void eliminate_plate(const ModalAssembler& assembler, const ElementBasis& along,
                     std::vector<ModalElement>& elements) {
  Eigen::MatrixXcd tail;  // stiffness of all elements farther out, as it acts on the right vertex
  for (auto e = elements.rbegin(); e != elements.rend(); ++e) {
    Eigen::MatrixXcd k = assembler.matrix(*e);
    if (tail.size() > 0) k.bottomRightCorner(tail.rows(), tail.cols()) += tail;
    const Eigen::Index left = along.per_vertex * e->left;
    const Eigen::Index rest = k.rows() - left;
    count_factorisation(static_cast<double>(rest), static_cast<double>(left));
    count_operations(8 * static_cast<double>(left * rest * left));
    e->transfer = -k.bottomRightCorner(rest, rest).partialPivLu().solve(k.bottomLeftCorner(rest, left));
    tail = k.topLeftCorner(left, left) + k.topRightCorner(left, rest) * e->transfer;
  }
}

// Eliminates unknowns from the tip to the drive edge: first the bubbles of each element, then its right
// vertex.
void eliminate(const ModalAssembler& assembler, const ElementBasis& along,
               std::vector<ModalElement>& elements) {
  Eigen::MatrixXcd tail;       // stiffness of all elements farther out, as it acts on the right vertex
  Eigen::VectorXcd tail_load;  // load on them, as it acts on the right vertex; empty if there is none
  for (auto e = elements.rbegin(); e != elements.rend(); ++e) {
    const Eigen::MatrixXcd k = assembler.matrix(*e);
    const Eigen::Index left = along.per_vertex * e->left, right = along.per_vertex * e->right;
    e->inner = Condensed(k.real(), k.imag(), left, right);
    const Eigen::MatrixXcd& ends = e->inner.ends();
    Eigen::PartialPivLU<Eigen::MatrixXcd> right_stiffness;
    Eigen::MatrixXcd seen = ends.topLeftCorner(left, left);
    if (right > 0) {
      count_factorisation(static_cast<double>(right), static_cast<double>(left));
      count_operations(8 * static_cast<double>(left * right * left));
      right_stiffness.compute(ends.bottomRightCorner(right, right) + tail);
      e->pull = right_stiffness.solve(ends.bottomLeftCorner(right, left));
      seen -= ends.topRightCorner(left, right) * e->pull;
    }
    tail = seen;
    if (e->load.size() > 0) tail_load = eliminate_load(*e, right_stiffness, left, tail_load);
  }
}

// Returns the other unknowns of an element (bubbles and right vertex), given those of its left vertex.
Eigen::VectorXcd others(const ModalElement& e, const Eigen::VectorXcd& u) {
  if (e.transfer.size() > 0) {
    count_operations(8 * static_cast<double>(e.transfer.size()));
    return e.transfer * u;
  }
  const Eigen::Index right = e.pull.rows(), bubbles = e.inner.bubbles();
  const double load_scale = std::exp(-e.ln_scale);
  Eigen::VectorXcd ends(u.size() + right), rest(bubbles + right);
  ends.head(u.size()) = u;
  if (right > 0) ends.tail(right) = -(e.pull * u);
  if (e.right_under_load.size() > 0) ends.tail(right) += load_scale * e.right_under_load;
  rest << e.inner.follow(ends), ends.tail(right);
  if (e.bubbles_under_load.size() > 0) rest.head(bubbles) += load_scale * e.bubbles_under_load;
  return rest;
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
    const Eigen::VectorXcd rest = others(e, u);
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
    e.inner = {};
    e.pull.resize(0, 0);
  }
}

// Returns the load on an element, in the weak form, that arises because the field is written as the sum of
// the finite-element part and the PistonLift.
Eigen::VectorXcd lift_load(const ModalSetup& s, const PistonLift& lift, const ModalElement& e) {
  const Quadrature along = gauss_legendre(lift_nodes), across = gauss_legendre(lift_nodes + e.left);
  const int bubbles_end = s.along.count() - s.along.per_vertex;
  Eigen::MatrixXd shapes(e.left, static_cast<Eigen::Index>(across.x.size()));
  for (std::size_t j = 0; j < across.x.size(); ++j) {
    Eigen::VectorXd shape = Eigen::VectorXd::Zero(e.left);
    add_bubbles(shape, 1, Parity::even, across.x[j], across.w[j]);
    shapes.col(static_cast<Eigen::Index>(j)) = shape;
  }
  Eigen::VectorXcd load = Eigen::VectorXcd::Zero(bubbles_end * e.left + e.right);
  Eigen::VectorXcd source(shapes.cols());
  // the closed form of the lift has an arc tangent and its derivatives at each point
  count_operations(static_cast<double>(along.x.size() * across.x.size()) *
                   (4 * function_operations + 2.0 * e.left));
  for (std::size_t i = 0; i < along.x.size(); ++i) {
    const double x = e.x0 + e.h * along.x[i], w = s.taper.half_width_m(x);
    for (std::size_t j = 0; j < across.x.size(); ++j) {
      const double y = w * across.x[j];
      source[static_cast<Eigen::Index>(j)] =
          s.equation.tension * lift.laplacian(x, y) + s.equation.inertia * lift.value(x, y);
    }
    const Eigen::VectorXcd part = e.h * along.w[i] * w * (shapes * source);
    const BasisValues basis = s.along.at(2 * along.x[i] - 1);
    for (int a = 0; a < bubbles_end; ++a)
      load.segment(a * e.left, e.left) += basis.value[static_cast<std::size_t>(a)] * part;
    load.tail(e.right) += basis.value[static_cast<std::size_t>(bubbles_end)] * part.head(e.right);
  }
  return load;
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
  void lift_piston(const ModalSetup& setup);
  Scaled at(double x, int derivative) const;
  Scaled beyond(double x, int derivative) const;

  ElementBasis along_;
  std::vector<ModalElement> elements_;
  TaylorMarch tail_;
  double length_m_, turning_m_ = 0, match_m_ = 0, spacing_m_;
  std::optional<double> peak_m_;
  // the part of the field of a piston that the elements leave out; empty if they solve for the whole field
  std::optional<PistonLift> lift_;
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
  if (surface.drive == DriveShape::piston && !s.equation.plate() && !resolution.drive) lift_piston(s);
  (s.equation.plate() ? eliminate_plate : eliminate)(assembler, s.along, elements_);
  Eigen::VectorXd drive = Eigen::VectorXd::Unit(s.along.per_vertex, 0);
  if (lift_) {
    drive = Eigen::VectorXd::Zero(elements_.front().left);
  } else if (s.across.count() > 1) {
    const auto shape =
        s.across.project(resolution.drive ? resolution.drive : drive_shape(surface, s.equation));
    drive = drive_unknowns(s, s.across, shape, elements_.front().left);
  }
  substitute(s, assembler, drive, elements_);
}

// Takes the jump of a piston's field at the corners out of the equations: a PistonLift, which ends at the end
// of an element, represents the jump. The elements then solve for the rest of the field, which is zero at the
// drive edge and has a load.
void ModalLine::lift_piston(const ModalSetup& s) {
  const double reach = lift_widths * s.taper.half_width_m(0);
  auto last = elements_.begin();
  while (last + 1 != elements_.end() && last->x0 + last->h < reach) ++last;
  lift_.emplace(s.taper, last->x0 + last->h);
  for (auto e = elements_.begin(); e <= last; ++e) e->load = lift_load(s, *lift_, *e);
}

Scaled ModalLine::at(double x, int derivative) const {
  if (x > match_m_) return beyond(x, derivative);
  auto e = std::partition_point(elements_.begin(), elements_.end(),
                                [x](const ModalElement& one) { return one.x0 + one.h < x; });
  if (e == elements_.end()) --e;
  const double t = std::clamp(2 * (x - e->x0) / e->h - 1, -1.0, 1.0);
  const BasisValues basis = along_.at(t);
  count_operations(24 * along_.bubbles() + 4 * along_.count() + 2 * function_operations);
  const auto& part = derivative == 0 ? basis.value : basis.first;
  std::complex<double> sum = 0;
  for (int a = 0; a < along_.count(); ++a) sum += e->centre[a] * part[static_cast<std::size_t>(a)];
  if (derivative == 1) sum *= 2 / e->h;
  if (lift_ && x < lift_->end_m())
    sum += (derivative == 0 ? lift_->value(x, 0) : lift_->centre_slope(x)) * std::exp(-e->ln_scale);
  return {sum, e->ln_scale};
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
  return std::make_unique<ModalLine>(smooth_sides(surface), f, losses, resolution);
}

void require_modal_line(const Surface& surface, double f) { require_solvable(smooth_sides(surface), f, {}); }

}  // namespace turnpoint::physics
