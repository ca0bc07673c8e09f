#include "station/sensing/force_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "station/core/least_squares.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::sensing {
namespace {

using Matrix = ForceCalibration::Matrix;
constexpr double moved_N = 5e-3, stop_N = 20e-3, rest_N = 2e-3, tare_s = 0.3;

Readings minus(const Readings& left, const Readings& right) {
  Readings result;
  for (std::size_t i = 0; i < bridge_count; ++i) result[i] = left[i] - right[i];
  return result;
}

Force product(const Readings& readings, const Matrix& matrix) {
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < bridge_count; ++i)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += readings[i] * matrix[i][k];
  return {sum[0], sum[1], sum[2]};
}

/// Returns the normal force, lateral force and moment that a weight exerts.
std::array<double, 3> load(const DeadWeight& weight) {
  return {weight.normal_N, weight.lateral_N, weight.normal_N * weight.position_mm};
}

using Loads = std::vector<std::array<double, 3>>;

/// Standard deviations of the normal force, lateral force and moment of each weight.
Loads load_sd(const std::vector<DeadWeight>& weights, const WeightErrors& errors) {
  double reach_mm = 0;
  for (const auto& weight : weights) reach_mm = std::max(reach_mm, std::abs(weight.position_mm));
  Loads all;
  for (const auto& weight : weights) {
    const double normal_N = std::hypot(errors.mass_share * weight.normal_N, errors.reading_N);
    all.push_back({normal_N, std::hypot(errors.pulley_share * weight.lateral_N, errors.reading_N),
                   std::hypot(errors.place_mm * weight.normal_N, normal_N * reach_mm)});
  }
  return all;
}

struct Fit {
  Matrix matrix;
  std::array<double, 3> misfit;
};

Fit fit(const std::vector<DeadWeight>& weights, const Loads& loads, const Loads& sd) {
  std::vector<std::vector<double>> rows;
  for (const auto& weight : weights) rows.emplace_back(weight.readings.begin(), weight.readings.end());
  Fit result{};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> values, importance;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      values.push_back(loads[i][k]);
      importance.push_back(1 / (sd[i][k] * sd[i][k]));
    }
    const auto column = core::least_squares(rows, values, importance);
    for (std::size_t i = 0; i < bridge_count; ++i) result.matrix[i][k] = column.value[i];
    result.misfit[k] = column.sd[0] / column.known_sd[0];
  }
  return result;
}

/// For each source of error: the changes of all loads if this source changes by one standard deviation. The
/// sources are the position of each place, the pulley's friction in each direction, and a common error of all
/// masses.
std::vector<Loads> load_changes(const std::vector<DeadWeight>& weights, const WeightErrors& errors) {
  std::vector<Loads> all;
  const auto source = [&](auto change) {
    Loads loads;
    for (const auto& weight : weights) loads.push_back(change(weight));
    all.push_back(std::move(loads));
  };
  std::set<double> places;
  for (const auto& weight : weights) places.insert(weight.position_mm);
  for (const double place : places)
    source([&](const DeadWeight& w) {
      return std::array{0.0, 0.0, w.position_mm == place ? w.normal_N * errors.place_mm : 0.0};
    });
  for (const double direction : {-1.0, 1.0})
    source([&](const DeadWeight& w) {
      return std::array{0.0, w.lateral_N * direction > 0 ? errors.pulley_share * w.lateral_N : 0.0, 0.0};
    });
  source([&](const DeadWeight& w) {
    const auto whole = load(w);
    return std::array{errors.mass_share * whole[0], errors.mass_share * whole[1],
                      errors.mass_share * whole[2]};
  });
  return all;
}

}  // namespace

Force ForceCalibration::force(const Readings& readings) const { return product(readings, matrix_); }

ForceSd ForceCalibration::sd(const Readings& readings) const {
  const Force at = force(readings);
  ForceSd sum;
  for (const Matrix& change : changes_) {
    const Force by = product(readings, change);
    sum.normal_N += by.normal_N * by.normal_N;
    sum.lateral_N += by.lateral_N * by.lateral_N;
    sum.position_mm += std::pow((by.moment_Nmm - by.normal_N * at.moment_Nmm / at.normal_N) / at.normal_N, 2);
    sum.friction += std::pow((by.lateral_N - by.normal_N * at.lateral_N / at.normal_N) / at.normal_N, 2);
  }
  return {std::sqrt(sum.normal_N), std::sqrt(sum.lateral_N), std::sqrt(sum.position_mm),
          std::sqrt(sum.friction)};
}

WeightFit fit_weights(const std::vector<DeadWeight>& weights, const WeightErrors& errors) {
  if (weights.size() <= bridge_count)
    throw core::UsageError("the calibration of the forces needs more than three weights");
  Loads loads;
  for (const auto& weight : weights) loads.push_back(load(weight));
  const Loads sd = load_sd(weights, errors);
  const Fit best = fit(weights, loads, sd);

  std::vector<Matrix> changes;
  for (const Loads& change : load_changes(weights, errors)) {
    // The fit is linear in the loads, so it turns a change of the loads into a change of the matrix.
    Matrix by = fit(weights, change, sd).matrix;
    for (auto& row : by)
      for (std::size_t k = 0; k < 3; ++k) row[k] *= std::max(1.0, best.misfit[k]);
    changes.push_back(by);
  }
  WeightFit result{{best.matrix, std::move(changes)}, {}, best.misfit};
  for (const auto& weight : weights) {
    const Force force = result.calibration.force(weight.readings);
    result.residuals.push_back({force.normal_N - weight.normal_N, force.lateral_N - weight.lateral_N,
                                force.moment_Nmm / force.normal_N - weight.position_mm});
  }
  return result;
}

std::vector<double> deviations(const std::vector<DeadWeight>& weights, const WeightErrors& errors) {
  std::vector<double> all;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    auto others = weights;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    double largest = 0;
    try {
      const auto without = fit_weights(others, errors);
      const auto at = without.calibration.force(weights[i].readings);
      const auto stated = load(weights[i]);
      const auto sd = load_sd({weights[i]}, errors).front();
      const std::array measured{at.normal_N, at.lateral_N, at.moment_Nmm};
      for (std::size_t k = 0; k < 3; ++k)
        largest =
            std::max(largest, std::abs(measured[k] - stated[k]) / (sd[k] * std::max(1.0, without.misfit[k])));
    } catch (const core::UsageError&) {
      largest = 0;
    }
    all.push_back(largest);
  }
  return all;
}

Tare tare(std::span<const BridgePoint> points, Band band, const ForceCalibration& calibration,
          const Readings& before) {
  Tare result;
  const auto count = static_cast<double>(points.size());
  if (count < tare_s * points_per_second(band)) return result;
  for (const auto& point : points) {
    if (point.fault != WireFault::none || std::isnan(point.ratio[0])) return result;
    for (std::size_t i = 0; i < bridge_count; ++i) result.readings[i] += point.ratio[i] / count;
  }
  double normal = 0, lateral = 0;
  for (const auto& point : points) {
    const Force off = calibration.force(minus(point.ratio, result.readings));
    normal += off.normal_N * off.normal_N;
    lateral += off.lateral_N * off.lateral_N;
  }
  result.sd_N = std::sqrt(std::max(normal, lateral) / (count - 1));
  const Force moved = calibration.force(minus(result.readings, before));
  result.moved_N = std::max(std::abs(moved.normal_N), std::abs(moved.lateral_N));
  result.state = result.sd_N >= rest_N      ? TareState::restless
                 : result.moved_N > stop_N  ? TareState::stopped
                 : result.moved_N > moved_N ? TareState::moved
                                            : TareState::ok;
  return result;
}

ForcePoint force_point(const BridgePoint& point, const ForceCalibration& calibration, const Readings& tare) {
  if (point.fault == WireFault::none) return {point.index, calibration.force(minus(point.ratio, tare))};
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {point.index, {none, none, none}};
}

}  // namespace turnpoint::sensing
