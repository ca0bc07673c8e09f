#include "physics/condensed.hpp"

#include <Eigen/LU>
#include <cmath>

#include "tests/support/catch.hpp"

using turnpoint::physics::Condensed;

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Returns a symmetric matrix of numbers from -1 to 1 that depend on `phase`, with `diagonal` added on the
// diagonal.
MatrixXd symmetric(Index n, double diagonal, double phase) {
  MatrixXd a(n, n);
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j <= i; ++j)
      a(i, j) = a(j, i) = std::sin(phase + static_cast<double>(7 * i * i + 3 * j)) + (i == j ? diagonal : 0);
  }
  return a;
}

}  // namespace

TEST_CASE("a condensed element gives the same solution as the whole matrix", "[physics]") {
  for (const Index bubbles : {0, 1, 4, 7, 30}) {  // whole and broken panels of the elimination
    const Index left = 3, right = 2, n = left + bubbles + right;
    CAPTURE(bubbles);
    const MatrixXd re = symmetric(n, 2.0 * static_cast<double>(n), 0.3), im = symmetric(n, 1, 1.1);
    const Eigen::MatrixXcd whole = re + std::complex<double>(0, 1) * im;
    const Condensed one(re, im, left, right);
    REQUIRE(one.bubbles() == bubbles);
    const auto inner = whole.block(left, left, bubbles, bubbles).eval();
    Eigen::MatrixXcd coupling(bubbles, left + right), ends(left + right, left + right);
    coupling << whole.block(left, 0, bubbles, left), whole.block(left, left + bubbles, bubbles, right);
    ends << whole.topLeftCorner(left, left), whole.topRightCorner(left, right),
        whole.bottomLeftCorner(right, left), whole.bottomRightCorner(right, right);
    const Eigen::MatrixXcd solved = inner.partialPivLu().solve(coupling);
    CHECK((one.ends() - (ends - coupling.transpose() * solved)).norm() < 1e-12 * ends.norm());

    const Eigen::VectorXcd at_ends = symmetric(left + right, 0, 2).col(0).cast<std::complex<double>>();
    CHECK((one.follow(at_ends) + solved * at_ends).norm() <= 1e-12 * at_ends.norm());
    if (bubbles == 0) continue;
    const Eigen::VectorXcd load = symmetric(bubbles, 0, 3).col(0).cast<std::complex<double>>();
    const Eigen::VectorXcd answer = inner.partialPivLu().solve(load);
    const Eigen::VectorXcd reduced = one.reduce(load);
    CHECK(std::abs(one.quadratic(reduced) - (load.transpose() * answer)(0, 0)) < 1e-12);
    CHECK((one.load_on_ends(reduced) + coupling.transpose() * answer).norm() < 1e-12);
  }
}
