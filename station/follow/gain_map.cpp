#include "station/follow/gain_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace turnpoint::follow {
namespace {

constexpr int fine_levels = 513;
constexpr double unmet_step_m = 0.1e-3;

/// The value of the line through (x, y) at a place.
double line_at(std::span<const double> x, std::span<const double> y, double place) {
  const auto after = std::upper_bound(x.begin() + 1, x.end() - 1, place);
  const auto i = static_cast<std::size_t>(after - x.begin());
  const double t = (place - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + std::clamp(t, 0.0, 1.0) * (y[i] - y[i - 1]);
}

}  // namespace

GainMap::GainMap(std::span<const double> x_m, std::span<const double> displacement_m,
                 std::span<const double> finger_share, const physics::FrictionMap& friction,
                 double fingertip_m, double most_gain)
    : most_gain_(most_gain) {
  if (!(std::isfinite(most_gain) && most_gain > 0)) throw std::invalid_argument("most_gain must be above 0");
  for (const double value : displacement_m)
    if (!(std::isfinite(value) && value >= 0)) throw std::invalid_argument("a displacement is below 0");
  if (!finger_share.empty() && finger_share.size() != x_m.size())
    throw std::invalid_argument("the finger's share has another number of places than the displacement");
  for (const double share : finger_share)
    if (!(share >= 0 && share <= 1 + 1e-9))
      throw std::invalid_argument("the finger's share is not from 0 to 1");
  if (!(std::isfinite(fingertip_m) && fingertip_m >= 0))
    throw std::invalid_argument("the length of the fingertip is below 0");
  for (std::size_t i = 1; i < x_m.size(); ++i)
    if (!(x_m[i] > x_m[i - 1])) throw std::invalid_argument("the places do not ascend");
  const auto under = physics::fingertip_average(x_m, displacement_m, fingertip_m);
  first_m_ = x_m.front();
  step_m_ = (x_m.back() - x_m.front()) / (kPlaces - 1);
  std::array<double, kPlaces> left;
  for (std::size_t p = 0; p < kPlaces; ++p)
    left[p] = finger_share.empty()
                  ? 1
                  : std::min(1.0, line_at(x_m, finger_share, first_m_ + static_cast<double>(p) * step_m_));
  // at[level][place]: friction of the free surface's field at even steps of gain. A finger that takes a share
  // of the whole field under it feels this friction at a gain that is smaller by that share.
  std::vector<std::array<double, kPlaces>> at(fine_levels);
  std::vector<double> values(x_m.size());
  for (int level = 0; level < fine_levels; ++level) {
    const double gain = most_gain * level / (fine_levels - 1);
    for (std::size_t i = 0; i < x_m.size(); ++i)
      values[i] = friction.relative_friction(gain * displacement_m[i]);
    const auto mean = physics::fingertip_average(x_m, values, fingertip_m);
    for (int p = 0; p < kPlaces; ++p)
      at[static_cast<std::size_t>(level)][static_cast<std::size_t>(p)] =
          std::min(1.0, line_at(x_m, mean, first_m_ + p * step_m_));
  }
  constexpr int per_level = (fine_levels - 1) / (kLevels - 1);
  for (std::size_t p = 0; p < kPlaces; ++p) {
    displacement_m_[p] = static_cast<float>(most_gain * left[p] *
                                            line_at(x_m, under, first_m_ + static_cast<double>(p) * step_m_));
    std::array<double, fine_levels> drop;  // the square root of 1 - friction at even steps of gain
    for (std::size_t level = 0; level < fine_levels; ++level) {
      const double free = left[p] * static_cast<double>(level);
      const auto below = std::min(static_cast<std::size_t>(free), static_cast<std::size_t>(fine_levels - 2));
      const double low = std::sqrt(1 - at[below][p]), high = std::sqrt(1 - at[below + 1][p]);
      drop[level] = low + (free - static_cast<double>(below)) * (high - low);
    }
    lowest_[p] = static_cast<float>(1 - drop.back() * drop.back());
    for (std::size_t level = 0; level < kLevels; ++level)
      drop_[p][level] = static_cast<float>(drop[level * per_level]);
    std::size_t fine = 0;
    for (std::size_t level = 0; level < kLevels; ++level) {
      const double wanted = drop.back() * static_cast<double>(level) / (kLevels - 1);
      while (fine + 2 < fine_levels && drop[fine + 1] < wanted) ++fine;
      const double low = drop[fine], high = drop[fine + 1];
      const double t = high > low ? std::clamp((wanted - low) / (high - low), 0.0, 1.0) : 0;
      gain_[p][level] = static_cast<float>(most_gain * (static_cast<double>(fine) + t) / (fine_levels - 1));
    }
  }
}

GainMap::Between GainMap::between(double place_m) const noexcept {
  const double steps = (place_m - first_m_) / step_m_;
  const double at = steps > 0 ? std::min(steps, static_cast<double>(kPlaces - 1)) : 0;  // NaN: 0
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kPlaces - 2));
  return {i, at - static_cast<double>(i)};
}

namespace {

template <class Row>
double level_of(const Row& row, double share) {
  const double at = share * (GainMap::kLevels - 1);
  const auto i = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(GainMap::kLevels - 2));
  return static_cast<double>(row[i]) +
         (at - static_cast<double>(i)) * static_cast<double>(row[i + 1] - row[i]);
}

double mix(double a, double b, double t) { return a + t * (b - a); }

}  // namespace

double GainMap::relative_friction(double place_m, double gain) const noexcept {
  const auto [i, t] = between(place_m);
  const double share = gain > 0 ? std::min(gain / most_gain_, 1.0) : 0;  // NaN: 0
  const double drop = mix(level_of(drop_[i], share), level_of(drop_[i + 1], share), t);
  return 1 - drop * drop;
}

double GainMap::gain(double place_m, double relative_friction) const noexcept {
  const auto [i, t] = between(place_m);
  const double deepest =
      mix(1.0 - static_cast<double>(lowest_[i]), 1.0 - static_cast<double>(lowest_[i + 1]), t);
  if (!(relative_friction < 1) || !(deepest > 0)) return 0;
  const double share = std::sqrt(std::min(1.0, (1 - relative_friction) / deepest));
  return mix(level_of(gain_[i], share), level_of(gain_[i + 1], share), t);
}

double GainMap::gain_for_displacement(double place_m, double displacement_m) const noexcept {
  const double most = most_displacement_m(place_m);
  if (!(displacement_m > 0)) return 0;
  return displacement_m >= most ? most_gain_ : most_gain_ * std::max(0.0, displacement_m / most);
}

double GainMap::lowest_friction(double place_m) const noexcept {
  const auto [i, t] = between(place_m);
  return mix(static_cast<double>(lowest_[i]), static_cast<double>(lowest_[i + 1]), t);
}

double GainMap::most_displacement_m(double place_m) const noexcept {
  const auto [i, t] = between(place_m);
  return mix(static_cast<double>(displacement_m_[i]), static_cast<double>(displacement_m_[i + 1]), t);
}

namespace {

/// The part as a constant at the lowest or the highest value that it takes in a cycle.
Part extreme_of(const Pattern& pattern, const Part& part, bool highest) {
  float share = highest ? 1 : 0;
  if (part.shape == Shape::table) {
    const auto* samples = pattern.table.data() + part.table_first;
    share = highest ? *std::max_element(samples, samples + part.table_count)
                    : *std::min_element(samples, samples + part.table_count);
  }
  Part constant = part;
  constant.shape = Shape::constant;
  constant.to = part.from + (part.to - part.from) * static_cast<double>(share);
  return constant;
}

/// The pattern with its parts that vary in time at each combination of their extremes: in time, each place
/// meets them.
std::vector<Pattern> extremes_of(const Pattern& pattern) {
  std::vector<Pattern> all{pattern};
  for (std::size_t i = 0; i < static_cast<std::size_t>(pattern.part_count); ++i) {
    if (pattern.parts[i].cycles_per_s == 0) continue;
    const auto count = all.size();
    for (std::size_t k = 0; k < count; ++k) {
      all.push_back(all[k]);
      all[k].parts[i] = extreme_of(pattern, pattern.parts[i], false);
      all.back().parts[i] = extreme_of(pattern, pattern.parts[i], true);
    }
  }
  return all;
}

}  // namespace

std::vector<Unmet> unmet(const Pattern& pattern, const GainMap& map, double resting_friction, double begin_m,
                         double end_m, double tolerance) {
  PatternState none, all;
  all.active.fill(true);
  for (std::size_t i = 0; i < all.since_s.size(); ++i) all.since_s[i] = -pattern.parts[i].trigger.delay_s;
  const auto patterns = extremes_of(pattern);
  std::vector<Unmet> found;
  double worst = 0, last_m = 0;
  const auto steps = static_cast<int>(std::floor((end_m - begin_m) / unmet_step_m + 1e-9));
  for (int k = 0; k <= steps; ++k) {
    const double place_m = begin_m + k * unmet_step_m;
    const bool friction = pattern.asked == Asked::friction;
    const double least = friction ? resting_friction * map.lowest_friction(place_m) : 0;
    const double most = friction ? resting_friction : map.most_displacement_m(place_m);
    double miss = 0, asked = 0;
    for (const auto& extreme : patterns)
      for (const PatternState* state : {&none, &all}) {
        const double value = asked_at(extreme, *state, place_m, 0);
        const double by = std::max(least - value, value - most);
        if (by > miss) miss = by, asked = value;
      }
    if (!(miss > tolerance)) continue;
    if (found.empty() || place_m - last_m > 1.5 * unmet_step_m) found.push_back({place_m}), worst = 0;
    last_m = found.back().to_m = place_m;
    if (miss > worst) {
      worst = miss;
      found.back().at_m = place_m, found.back().asked = asked;
      found.back().least = least, found.back().most = most;
    }
  }
  return found;
}

}  // namespace turnpoint::follow
