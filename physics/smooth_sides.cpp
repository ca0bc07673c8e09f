#include "physics/smooth_sides.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "physics/dispersion.hpp"
#include "physics/taper.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {
namespace {

// In half-widths: points closer together than `close_by` are smoothed over stretches of `stretch`, and no
// stretch is shorter than `close_by`. Elements much shorter than their neighbours would be lost in rounding.
constexpr double close_by = 0.15, stretch = 0.6;
constexpr double second_margin = 2;

// A stretch of the table that a single cubic replaces. Values and slopes at the ends of a kept one are those
// of the table.
struct Stretch {
  double x0, x1;
  bool kept;
};

// Calls work(piece, x, weight) at the points of a quadrature of the table between x0 and x1.
template <class Work>
void integrate(const std::vector<Cubic>& pieces, double x0, double x1, Work work) {
  static const Quadrature rule = gauss_legendre(4);
  auto piece =
      std::partition_point(pieces.begin(), pieces.end(), [x0](const Cubic& p) { return p.x1 <= x0; });
  for (; piece != pieces.end() && piece->x0 < x1; ++piece) {
    const double from = std::max(x0, piece->x0), size = std::min(x1, piece->x1) - from;
    for (std::size_t q = 0; q < rule.x.size(); ++q) work(*piece, from + size * rule.x[q], size * rule.w[q]);
  }
}

// Returns the stretch that begins at x, inside the first of these pieces.
Stretch stretch_from(double x, double w, std::span<const Cubic> pieces) {
  const double end = pieces.back().x1, least = close_by * w;
  const auto at_end = [&](double to) { return to > end - least; };
  if (const double to = pieces[0].x1; to >= x + least && (to == end || !at_end(to))) return {x, to, true};
  double to = x;
  for (const Cubic& p : pieces) {
    const bool wide = to > x + least && p.x1 > p.x0 + least;
    if (wide || p.x1 > x + stretch * w) break;
    to = p.x1;
  }
  if (to < x + least) to = x + 2 * least;  // a part of the wide piece that follows
  return {x, at_end(to) ? end : to, false};
}

std::vector<Stretch> divide(const MonotoneCubic& table) {
  std::span<const Cubic> left = table.pieces();
  std::vector<Stretch> all;
  const double end = left.back().x1;
  for (double x = 0; x < end; x = all.back().x1) {
    while (left[0].x1 <= x) left = left.subspan(1);
    all.push_back(stretch_from(x, table(x), left));
  }
  return all;
}

// The four functions of a cubic on [0, 1] with given values and slopes at its ends.
Eigen::Vector4d hermite(double t) {
  const double u = 1 - t;
  return {u * u * (1 + 2 * t), t * u * u, t * t * (1 + 2 * u), -t * t * u};
}

using Node = Eigen::Vector2d;  // half-width and slope

// Least squares for the half-widths and slopes at the ends of the stretches.
std::vector<Node> fit(const MonotoneCubic& table, const std::vector<Stretch>& stretches) {
  constexpr double exactly = 1e12;  // weight of the values that are known
  const std::size_t count = stretches.size();
  std::vector<Eigen::Matrix2d> diagonal(count + 1, Eigen::Matrix2d::Zero()), upper(count);
  std::vector<Node> nodes(count + 1, Node::Zero());
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x0, x1, kept] = stretches[i];
    const double h = x1 - x0;
    const Eigen::Vector4d unit(1, h, 1, h);
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    integrate(table.pieces(), x0, x1, [&, from = x0](const Cubic& piece, double x, double weight) {
      const Eigen::Vector4d values = unit.cwiseProduct(hermite((x - from) / h));
      a += weight * values * values.transpose();
      b += weight * piece.value(x) * values;
    });
    if (kept) {
      const Eigen::Vector4d weight = exactly * h * unit.cwiseProduct(unit);
      a.diagonal() += weight;
      b += weight.cwiseProduct(Eigen::Vector4d(table(x0), table.slope(x0), table(x1), table.slope(x1)));
    }
    diagonal[i] += a.topLeftCorner<2, 2>();
    diagonal[i + 1] += a.bottomRightCorner<2, 2>();
    upper[i] = a.topRightCorner<2, 2>();
    nodes[i] += b.head<2>();
    nodes[i + 1] += b.tail<2>();
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Matrix2d share = upper[i].transpose() * diagonal[i].inverse();
    diagonal[i + 1] -= share * upper[i];
    nodes[i + 1] -= share * nodes[i];
  }
  nodes[count] = diagonal[count].inverse() * nodes[count];
  for (std::size_t i = count; i-- > 0;)
    nodes[i] = diagonal[i].inverse() * (nodes[i] - upper[i] * nodes[i + 1]);
  return nodes;
}

// Makes the sides fall everywhere, although what is left of noise may let them rise here and there. They stay
// as wide as the table's narrowest point, which a cubic fitted to a steep end may undershoot, even below
// zero.
TabulatedTaper falling(const std::vector<Stretch>& stretches, const std::vector<Node>& nodes, double least) {
  TabulatedTaper table;
  std::vector<double> lowest, highest;
  for (const Node& node : nodes) lowest.push_back(std::max(node[0], least));
  highest = lowest;
  std::partial_sum(lowest.begin(), lowest.end(), lowest.begin(),
                   [](double a, double b) { return std::min(a, b); });
  std::partial_sum(highest.rbegin(), highest.rend(), highest.rbegin(),
                   [](double a, double b) { return std::max(a, b); });
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double x = i == 0 ? 0 : stretches[i - 1].x1, w = 0.5 * (lowest[i] + highest[i]);
    table.points.push_back({x, i == 0 ? w : std::min(w, table.points.back().half_width_m * (1 - 1e-12))});
    table.slopes.push_back(std::min(0.0, nodes[i][1]));
  }
  // A cubic is monotone if its slopes are at most three times that of its chord.
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const auto &a = table.points[i], &b = table.points[i + 1];
    const double steepest = 3 * (b.half_width_m - a.half_width_m) / (b.x_m - a.x_m);
    for (const std::size_t end : {i, i + 1}) table.slopes[end] = std::max(table.slopes[end], steepest);
  }
  return table;
}

}  // namespace

Surface smooth_sides(const Surface& surface) {
  const auto* table = std::get_if<TabulatedTaper>(&surface.taper);
  if (table == nullptr || !table->slopes.empty()) return surface;
  const Taper taper(surface);
  const std::vector<Stretch> stretches = divide(taper.table());
  if (std::ranges::all_of(stretches, &Stretch::kept)) return surface;
  Surface smooth = surface;
  const double least = std::ranges::min(table->points, {}, &TaperPoint::half_width_m).half_width_m;
  smooth.taper = falling(stretches, fit(taper.table(), stretches), least);
  return smooth;
}

Surface narrowed_sides(const Surface& surface, const Surface& smooth, double f) {
  const Dispersion dispersion(surface);
  const double k = dispersion.wavenumber_per_m(f), nu = surface.poisson;
  const bool supported = dispersion.bending && !dispersion.clamped;
  const double spring = supported ? second_margin * (1 - nu) * dispersion.stiffness_N_m /
                                        (2 * dispersion.stiffness_N_m * k * k + dispersion.tension_N_per_m)
                                  : 0;
  // Clamped sides are the most that a spring can come to. They are like a strip narrower by pi/4 of 1/k.
  const auto limited = [k](double by, double w) { return std::min({by, 0.8 / k, 0.5 * w}); };
  Surface narrow = smooth;
  if (auto* exponential = std::get_if<ExponentialTaper>(&narrow.taper))  // kappa is W / decay_length^2
    exponential->half_width_m *= 1 - std::min(0.5, spring / std::pow(exponential->decay_length_m, 2));
  auto* table = std::get_if<TabulatedTaper>(&narrow.taper);
  if (table == nullptr) return narrow;
  const Taper rough(surface), even(smooth);
  std::vector<double> by(table->points.size(), 0);
  for (std::size_t i = 0; i + 1 < by.size(); ++i) {
    const Cubic& fit = even.table().pieces()[i];
    double off = 0, d0 = 0, d1 = 0, d2 = 0;  // largest |d|; integrals of the squares of d, d' and d''
    integrate(rough.table().pieces(), fit.x0, fit.x1, [&](const Cubic& p, double x, double weight) {
      const double d = fit.value(x) - p.value(x), slope = fit.slope(x) - p.slope(x);
      const double bend = 2 * (fit.c2 - p.c2) + 6 * (fit.c3 * (x - fit.x0) - p.c3 * (x - p.x0));
      off = std::max(off, std::abs(d));
      d0 += weight * d * d, d1 += weight * slope * slope, d2 += weight * bend * bend;
    });
    const double length = fit.x1 - fit.x0;
    const double bend = std::max(std::abs(fit.c2), std::abs(fit.c2 + 3 * fit.c3 * length)) * 2;
    const double inwards =
        std::min(off, second_margin * (dispersion.clamped_bending() ? 2 : 1) * std::sqrt(d0 * d1) / length) +
        spring * (bend + 0.5 * (3 + nu) * std::sqrt(d1 * d2) / length);
    for (const std::size_t end : {i, i + 1}) by[end] = std::max(by[end], inwards);
  }
  for (std::size_t i = 0; i < by.size(); ++i)
    table->points[i].half_width_m -= limited(by[i], table->points[i].half_width_m);
  return narrow;
}

}  // namespace turnpoint::physics
