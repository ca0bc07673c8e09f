#include "physics/modal_load.hpp"

#include <algorithm>

#include "physics/dispersion.hpp"
#include "physics/modal_setup.hpp"

namespace turnpoint::physics {
namespace {

using Matrix = Eigen::MatrixXcd;

// Static condensation: the stiffness of the `kept` unknowns when no force acts on the `others`.
Matrix condensed(const Matrix& kept, const Matrix& coupling, const Matrix& others) {
  return kept - coupling * others.partialPivLu().solve(coupling.transpose());
}

// Returns, for each element, the inverse of the stiffness at its unknowns. That stiffness includes all
// elements on both sides. Unknowns that are held, at the drive edge and at the far end, are left out.
std::vector<Matrix> inverses(const ModalSetup& setup, const ModalAssembler& assembler,
                             const std::vector<ModalElement>& elements) {
  const Eigen::Index ends = setup.along.per_vertex;
  std::vector<Matrix> seen;
  for (const ModalElement& e : elements) seen.push_back(assembler.matrix(e));
  const std::vector<Matrix> own = seen;
  for (std::size_t i = seen.size(); i-- > 1;) {
    const Eigen::Index rest = seen[i].rows() - ends;
    const Matrix tail = condensed(seen[i].topLeftCorner(ends, ends), seen[i].topRightCorner(ends, rest),
                                  seen[i].bottomRightCorner(rest, rest));
    seen[i - 1].bottomRightCorner(ends, ends) += tail;
  }
  Matrix head;  // stiffness at the left vertex of all elements before it, drive edge held
  for (std::size_t i = 0; i < seen.size(); ++i) {
    Matrix before = own[i];
    if (i == 0) {
      const Eigen::Index rest = before.rows() - ends;
      seen[i] = Matrix(seen[i].bottomRightCorner(rest, rest));
      before = Matrix(before.bottomRightCorner(rest, rest));
    } else {
      seen[i].topLeftCorner(ends, ends) += head;
      before.topLeftCorner(ends, ends) += head;
    }
    const Eigen::Index rest = before.rows() - ends;
    if (i + 1 < seen.size())
      head = condensed(before.bottomRightCorner(ends, ends), before.bottomLeftCorner(ends, rest),
                       before.topLeftCorner(rest, rest));
    seen[i] = Matrix(seen[i].partialPivLu().inverse());
  }
  return seen;
}

}  // namespace

std::vector<std::complex<double>> plate_receptance_m_per_N(const Surface& surface, double f,
                                                           const std::vector<double>& x_m) {
  ModalResolution resolution;
  resolution.across = ModalResolution::Across::cut_off_shape;
  const ModalSetup setup = make_modal_setup(surface, f, Losses::kept, resolution);
  double match_m = 0;
  const auto elements = make_modal_elements(setup, resolution, match_m);
  const ModalAssembler assembler(setup.taper, setup.across, setup.along, setup.equation,
                                 setup.taper.half_width_m(0));
  const auto inverse = inverses(setup, assembler, elements);
  // The elements' matrices describe half of the strip and are divided by D.
  const double unit = 1 / (2 * Dispersion(surface).stiffness_N_m);
  std::vector<std::complex<double>> answer;
  for (const double x : x_m) {
    auto e = std::partition_point(elements.begin(), elements.end(),
                                  [x](const ModalElement& one) { return one.x0 + one.h < x; });
    if (e == elements.end()) --e;
    const BasisValues basis = setup.along.at(std::clamp(2 * (x - e->x0) / e->h - 1, -1.0, 1.0));
    Eigen::VectorXcd load(setup.along.count());
    for (int a = 0; a < setup.along.count(); ++a) {
      const bool slope = setup.along.per_vertex == 2 && (a == 1 || a == setup.along.count() - 1);
      load[a] = basis.value[static_cast<std::size_t>(a)] * (slope ? assembler.slope_factor(*e) : 1);
    }
    const auto& k = inverse[static_cast<std::size_t>(e - elements.begin())];
    const Eigen::Index skipped = e == elements.begin() ? setup.along.per_vertex : 0;
    const Eigen::VectorXcd acts = load.segment(skipped, k.rows());
    answer.push_back(unit * (acts.transpose() * k * acts)(0, 0));
  }
  return answer;
}

}  // namespace turnpoint::physics
