#include "station/sensing/friction_profile.hpp"

#include <cmath>
#include <limits>

#include "station/analysis/quantile.hpp"

namespace turnpoint::sensing {
namespace {

struct Sums {
  double lateral_N = 0, normal_N = 0;

  void add(const FingerPoint& point) {
    if (!point.contact || !(point.normal_N >= least_normal_N)) return;
    lateral_N += std::abs(point.lateral_N);
    normal_N += point.normal_N;
  }
  double friction() const { return lateral_N / normal_N; }  // NaN if there was no point
};

}  // namespace

FrictionProfile friction_profile(std::span<const FingerPoint> track, std::span<const Stroke> strokes,
                                 const Bins& bins) {
  FrictionProfile profile{bins, {}};
  for (const Stroke& stroke : strokes) {
    std::vector<Sums> sums(bins.count);
    for (const auto& point : track.subspan(stroke.first, stroke.end - stroke.first)) {
      const double bin = std::floor((point.position_mm - bins.from_mm) / bins.width_mm);
      if (bin >= 0 && bin < static_cast<double>(bins.count)) sums[static_cast<std::size_t>(bin)].add(point);
    }
    StrokeFriction one{stroke.direction, {}};
    for (const Sums& sum : sums) one.friction.push_back(sum.friction());
    profile.strokes.push_back(std::move(one));
  }
  return profile;
}

MeanFriction FrictionProfile::mean(int direction) const {
  MeanFriction result;
  for (std::size_t bin = 0; bin < bins.count; ++bin) {
    std::vector<double> values;
    for (const auto& stroke : strokes)
      if (stroke.direction == direction && !std::isnan(stroke.friction[bin]))
        values.push_back(stroke.friction[bin]);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const auto n = static_cast<double>(values.size());
    result.friction.push_back(values.empty() ? none : analysis::mean(values));
    result.se.push_back(values.size() < 2 ? none : std::sqrt(analysis::variance(values) / n));
  }
  return result;
}

double mean_friction(std::span<const FingerPoint> track, std::span<const Stroke> strokes,
                     const StripPart& part) {
  Sums sums;
  for (const auto& stroke : strokes)
    for (const auto& point : track.subspan(stroke.first, stroke.end - stroke.first))
      if (point.position_mm >= part.from_mm && point.position_mm <= part.to_mm) sums.add(point);
  return sums.friction();
}

}  // namespace turnpoint::sensing
