#include "station/sensing/friction_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "station/core/draws.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::sensing {
namespace {

constexpr std::size_t fewest_strokes_of_level = 3;
/// ln friction must fall by at least this much from level to level, so that the displacement can be computed
/// from the friction.
constexpr double least_fall = 1e-6;

/// For each displacement: the values of ln friction of the strokes at this displacement, relative to the
/// strokes at rest just before and after.
using ByLevel = std::map<double, std::vector<double>>;

/// Returns the sequence that never rises and is closest to the values in weighted least squares: pool
/// adjacent violators (Ayer et al. 1955).
std::vector<double> falling(const std::vector<double>& values, const std::vector<double>& weights) {
  struct Pool {
    double value, weight;
    std::size_t count;
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].value < pools.back().value) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& into = pools.back();
      const double weight = into.weight + last.weight;
      into = {(into.value * into.weight + last.value * last.weight) / weight, weight,
              into.count + last.count};
    }
  }
  std::vector<double> result;
  for (const Pool& pool : pools) result.insert(result.end(), pool.count, pool.value);
  return result;
}

/// Lowers values where necessary, so that all are below 0 and each is below the one before.
std::vector<double> strictly(std::vector<double> values) {
  double before = 0;
  for (double& value : values) before = value = std::min(value, before - least_fall);
  return values;
}

std::optional<double> half_displacement_m(const std::vector<double>& displacements_m,
                                          const std::vector<double>& ln_friction) {
  std::vector<physics::FrictionPoint> points{{0, 1, 0}};
  for (std::size_t i = 0; i < ln_friction.size(); ++i)
    points.push_back({displacements_m[i], std::exp(ln_friction[i]), 0});
  return physics::FrictionMap(std::move(points)).displacement_m(0.5);
}

/// One bootstrap replicate: draws the strokes of each level with replacement, and returns the means of the
/// levels. Deviations are enlarged by sqrt(n / (n - 1)), because deviations from the mean of the n strokes
/// themselves are too small.
std::vector<double> redrawn(const ByLevel& by_level, const std::vector<double>& means, core::Draws& draws) {
  std::vector<double> result;
  for (const auto& [displacement_m, values] : by_level) {
    const double mean = means[result.size()], n = static_cast<double>(values.size());
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) sum += values[draws.below(values.size())] - mean;
    result.push_back(mean + std::sqrt(n / (n - 1)) * sum / n);
  }
  return result;
}

ByLevel by_level(std::span<const TableStroke> strokes, int& unused) {
  ByLevel result;
  const auto at_rest = [&](std::size_t i) {
    return i < strokes.size() && strokes[i].displacement_m == 0 && strokes[i].friction > 0;
  };
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const auto& [displacement_m, friction] = strokes[i];
    if (displacement_m == 0) continue;
    // Keep a level without usable strokes, so that the error message can name it.
    auto& values = result[displacement_m];
    if (i > 0 && at_rest(i - 1) && at_rest(i + 1) && friction > 0)
      values.push_back(std::log(friction) -
                       (std::log(strokes[i - 1].friction) + std::log(strokes[i + 1].friction)) / 2);
    else
      ++unused;
  }
  return result;
}

analysis::Interval around(double value, double half_width) {
  return {value - half_width, value + half_width};
}

}  // namespace

std::vector<physics::FrictionPoint> FrictionTable::points() const {
  std::vector<physics::FrictionPoint> result{{0, 1, 0}};
  for (const auto& level : levels)
    result.push_back({level.displacement_m, level.relative_friction, level.sd});
  return result;
}

FrictionTable friction_table(std::span<const TableStroke> strokes, std::uint64_t seed, int replicates) {
  FrictionTable table;
  const ByLevel levels = by_level(strokes, table.unused);
  if (levels.empty()) throw core::UsageError("friction table: no strokes over the vibrating surface");
  std::vector<double> displacements_m, means, counts;
  for (const auto& [displacement_m, values] : levels) {
    if (values.size() < fewest_strokes_of_level)
      throw core::UsageError(fmt::format("friction table: {} usable strokes at {:.3g} um, {} are needed",
                                         values.size(), 1e6 * displacement_m, fewest_strokes_of_level));
    displacements_m.push_back(displacement_m);
    means.push_back(analysis::mean(values));
    counts.push_back(static_cast<double>(values.size()));
  }
  const auto best = strictly(falling(means, counts));
  table.half_displacement_m = half_displacement_m(displacements_m, best);

  std::vector<std::vector<double>> redrawn_levels(means.size());
  std::vector<double> halves;
  core::Draws draws({seed, core::Stream::bootstrap});
  for (int i = 0; i < replicates; ++i) {
    const auto ln_friction = falling(redrawn(levels, means, draws), counts);
    for (std::size_t k = 0; k < means.size(); ++k) redrawn_levels[k].push_back(ln_friction[k]);
    if (const auto half = half_displacement_m(displacements_m, strictly(ln_friction)))
      halves.push_back(*half);
  }
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double sd = std::sqrt(analysis::variance(redrawn_levels[k])), friction = std::exp(best[k]);
    const auto ends = around(best[k], analysis::student_t_975(static_cast<int>(counts[k]) - 1) * sd);
    table.levels.push_back({displacements_m[k],
                            static_cast<int>(counts[k]),
                            std::exp(means[k]),
                            friction,
                            friction * sd,
                            {std::exp(ends.low), std::min(1.0, std::exp(ends.high))}});
  }
  if (table.half_displacement_m && halves.size() > 1) {
    // The displacement that halves friction is interpolated between two levels, so use the degrees of freedom
    // of two levels.
    const double scatter_of_two = 2 * (*std::ranges::min_element(counts) - 1);
    table.half_displacement_sd_m = std::sqrt(analysis::variance(halves));
    table.half_displacement_interval =
        around(*table.half_displacement_m,
               analysis::student_t_975(static_cast<int>(scatter_of_two)) * table.half_displacement_sd_m);
  }
  return table;
}

}  // namespace turnpoint::sensing
