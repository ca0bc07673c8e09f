#include "station/sensing/felt_step.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"

namespace turnpoint::sensing {
namespace {

constexpr std::size_t fewest_strokes = 3, fewest_bins = 6;
// Even in pure noise, the fit finds some step. Therefore a step counts only if it exceeds the half-width of
// its 95 % interval by this factor.
constexpr double certain_rise = 2;
// The final fit uses only the bins within `reach_widths` widths of the step, or within `least_reach_mm` if
// that is farther. Still farther away, friction changes again, because the vibration has nodes.
constexpr double least_reach_mm = 20, reach_widths = 2.5;
// A bin whose error the fit follows by more than this counts as if it were this much.
constexpr double most_followed = 0.9;
constexpr double narrowest_mm = 0.5, widest_mm = 17;

struct Bin {
  double position_mm, friction;
  double se = 0;  ///< standard error of the friction, from the scatter of the strokes
};

/// The model: friction = below + rise * Phi((x - place) / width), where x is the position and Phi is the
/// normal distribution function. Friction under a fingertip is a mean over its length, so it approaches its
/// values on both sides faster than a logistic function does.
struct Step {
  double place_mm = 0, width_mm = 1, below = 0, rise = 0;

  double z(double x) const { return (x - place_mm) / width_mm; }
  double share(double x) const { return 0.5 * std::erfc(-z(x) / std::numbers::sqrt2); }
  double miss(const Bin& bin) const { return bin.friction - below - rise * share(bin.position_mm); }
  double slope(double x) const {
    return rise * std::exp(-0.5 * z(x) * z(x)) / (width_mm * std::sqrt(2 * std::numbers::pi));
  }
  /// derivatives with respect to place, logarithm of width, `below` and `rise`
  Eigen::Vector4d derivatives(double x) const { return {-slope(x), -slope(x) * (x - place_mm), 1, share(x)}; }
};

double square_sum(const Step& step, const std::vector<Bin>& bins) {
  double sum = 0;
  for (const Bin& bin : bins) sum += step.miss(bin) * step.miss(bin);
  return sum;
}

/// Sets `below` and `rise` by least squares, for the given place and width.
Step with_levels(Step step, const std::vector<Bin>& bins) {
  double s = 0, ss = 0, y = 0, sy = 0;
  const auto n = static_cast<double>(bins.size());
  for (const Bin& bin : bins) {
    const double share = step.share(bin.position_mm);
    s += share, ss += share * share, y += bin.friction, sy += share * bin.friction;
  }
  const double spread = ss - s * s / n;
  step.rise = spread > 1e-9 ? (sy - s * y / n) / spread : 0;
  step.below = (y - step.rise * s) / n;
  return step;
}

Step search(const std::vector<Bin>& bins) {
  Step best;
  double least = std::numeric_limits<double>::infinity();
  for (const double width_mm : {1.0, 2.0, 4.0, 7.0})
    for (const Bin& bin : bins) {
      const Step step = with_levels({bin.position_mm, width_mm}, bins);
      const double sum = square_sum(step, bins);
      if (sum < least) least = sum, best = step;
    }
  return best;
}

/// Returns the scale of the loss function: residuals larger than this scale have a limited influence on the
/// fit. It is 1.48 times the median residual, which is the standard deviation if the noise is normal.
double scale_of(const Step& step, const std::vector<Bin>& bins) {
  std::vector<double> size;
  for (const Bin& bin : bins) size.push_back(std::abs(step.miss(bin)));
  return std::max(1.4826 * analysis::quantile(size, 0.5), 1e-9);
}

double soft_l1(const Step& step, const std::vector<Bin>& bins, double scale) {
  double sum = 0;
  for (const Bin& bin : bins) sum += std::sqrt(1 + std::pow(step.miss(bin) / scale, 2)) - 1;
  return sum;
}

/// The weight of a bin in the soft-L1 loss.
double weight_of(const Step& step, const Bin& bin, double scale) {
  return 1 / std::sqrt(1 + std::pow(step.miss(bin) / scale, 2));
}

/// Minimises the soft-L1 loss by Gauss-Newton steps with reweighting and Levenberg damping.
Step refine(Step step, const std::vector<Bin>& bins, double scale) {
  double loss = soft_l1(step, bins, scale), damping = 1e-3;
  for (int i = 0; i < 60 && damping < 1e8; ++i) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (const Bin& bin : bins) {
      const auto by = step.derivatives(bin.position_mm);
      const double weight = weight_of(step, bin, scale);
      normal += weight * by * by.transpose();
      right += weight * step.miss(bin) * by;
    }
    normal.diagonal() *= 1 + damping;
    normal.diagonal().array() += 1e-12;
    const Eigen::Vector4d change = normal.ldlt().solve(right);
    Step next = step;
    next.place_mm += std::clamp(change(0), -5.0, 5.0);
    next.width_mm =
        std::clamp(next.width_mm * std::exp(std::clamp(change(1), -1.0, 1.0)), narrowest_mm, widest_mm);
    next.below += change(2);
    next.rise += change(3);
    const double next_loss = soft_l1(next, bins, scale);
    if (!(next_loss < loss)) {
      damping *= 10;
      continue;
    }
    const bool done = loss - next_loss < 1e-10 * loss;
    step = next, loss = next_loss, damping /= 10;
    if (done) break;
  }
  return step;
}

std::vector<Bin> near(const Step& step, const std::vector<Bin>& bins) {
  const double within_mm = std::max(least_reach_mm, reach_widths * step.width_mm);
  std::vector<Bin> close;
  for (const Bin& bin : bins)
    if (std::abs(bin.position_mm - step.place_mm) <= within_mm) close.push_back(bin);
  return close;
}

/// Returns the position at which friction is `level` times the friction at larger positions, or, without a
/// level, the position half-way up the step. NaN if friction does not rise through that level.
double crossing_mm(const Step& step, std::optional<double> level) {
  if (!level) return step.place_mm;
  const double share = (*level * (step.below + step.rise) - step.below) / step.rise;
  if (!(step.rise > 0 && share > 0 && share < 1)) return std::numeric_limits<double>::quiet_NaN();
  return step.place_mm + step.width_mm * analysis::normal_quantile(share);
}

std::vector<Bin> usable(const FrictionProfile& profile, int direction) {
  const auto mean = profile.mean(direction);
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < mean.friction.size(); ++i)
    if (!std::isnan(mean.friction[i]))
      bins.push_back({profile.bins.centre_mm(i), mean.friction[i], std::isnan(mean.se[i]) ? 0 : mean.se[i]});
  return bins;
}

/// Returns the variance of the boundary that comes from the shape of the step, which all strokes share: the
/// variance by what the fit misses in each bin (the sandwich formula HC2 of MacKinnon and White 1985), less
/// the part that the scatter of the strokes explains. It may be negative by chance.
double shape_variance(const Step& step, const std::vector<Bin>& bins, double felt_mm, double scale,
                      std::optional<double> level) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  for (const Bin& bin : bins) {
    const auto by = step.derivatives(bin.position_mm);
    normal += weight_of(step, bin, scale) * by * by.transpose();
  }
  normal.diagonal().array() += 1e-12;
  const Eigen::LDLT<Eigen::Matrix4d> solver(normal);
  // How far the boundary moves with each parameter, so that the fit's friction there keeps its level. The
  // logarithm of the width does not move a boundary that is half-way up.
  const double slope = step.slope(felt_mm);
  Eigen::Vector4d moves(1, 0, 0, 0);
  if (level) moves = (Eigen::Vector4d(0, 0, *level, *level) - step.derivatives(felt_mm)) / slope;
  const Eigen::Vector4d by_parameters = solver.solve(moves);
  double variance = 0;
  for (const Bin& bin : bins) {
    const auto by = step.derivatives(bin.position_mm);
    const double w = weight_of(step, bin, scale), moved_by = w * by.dot(by_parameters);
    // the part of the bin's error that the fit follows, so that it is not in what the fit misses
    const double followed = std::min(most_followed, w * by.dot(solver.solve(by)));
    variance += moved_by * moved_by * (std::pow(step.miss(bin), 2) / (1 - followed) - bin.se * bin.se);
  }
  return variance;
}

/// The step fitted to the strokes in one direction, with the sum of squared deviations of its jackknife
/// pseudo-values.
struct OneWay {
  Step step;
  double felt_mm = 0;
  double place_squares = 0, rise_squares = 0, shape_variance = 0;
  int strokes = 0;
};

std::optional<OneWay> one_way(const FrictionProfile& profile, int direction, std::optional<double> level) {
  const auto bins = usable(profile, direction);
  if (bins.size() < fewest_bins) return std::nullopt;
  const Step rough = search(bins);
  const double scale = scale_of(rough, bins);
  const Step whole = refine(rough, bins, scale);
  const auto close = near(whole, bins);
  if (close.size() < fewest_bins) return std::nullopt;
  OneWay result{refine(whole, close, scale)};
  result.felt_mm = crossing_mm(result.step, level);
  if (!(result.felt_mm > close.front().position_mm && result.felt_mm < close.back().position_mm))
    return std::nullopt;
  result.shape_variance = shape_variance(result.step, close, result.felt_mm, scale, level);
  std::vector<double> places, rises;
  for (std::size_t i = 0; i < profile.strokes.size(); ++i) {
    if (profile.strokes[i].direction != direction) continue;
    ++result.strokes;
    FrictionProfile others{profile.bins, profile.strokes};
    others.strokes.erase(others.strokes.begin() + static_cast<std::ptrdiff_t>(i));
    const auto rest = near(whole, usable(others, direction));
    if (rest.size() < fewest_bins) continue;
    const Step without = refine(result.step, rest, scale);
    const double place_mm = crossing_mm(without, level);
    if (std::isnan(place_mm)) continue;
    places.push_back(place_mm);
    rises.push_back(without.rise);
  }
  if (places.size() > 1) {
    const double factor = std::pow(static_cast<double>(places.size()) - 1, 3);
    result.place_squares = factor * analysis::variance(places);
    result.rise_squares = factor * analysis::variance(rises);
  }
  return result;
}

}  // namespace

std::optional<FeltStep> felt_step(const FrictionProfile& profile, std::optional<double> level) {
  if (profile.strokes.size() < fewest_strokes) return std::nullopt;
  const auto up = one_way(profile, 1, level), down = one_way(profile, -1, level);
  if (!up || !down) return std::nullopt;
  const int degrees = up->strokes + down->strokes - 2;
  const auto se = [&](double squares) {
    return std::sqrt(squares / degrees * (1.0 / up->strokes + 1.0 / down->strokes)) / 2;
  };
  const double t = analysis::student_t_975(degrees), rise = (up->step.rise + down->step.rise) / 2;
  if (!(std::abs(rise) > certain_rise * t * se(up->rise_squares + down->rise_squares))) return std::nullopt;
  FeltStep felt;
  felt.boundary_mm = (up->felt_mm + down->felt_mm) / 2;
  felt.lag_mm = (up->felt_mm - down->felt_mm) / 2;
  const double by_shape = std::max(0.0, (up->shape_variance + down->shape_variance) / 2);
  felt.se_mm = std::hypot(se(up->place_squares + down->place_squares), std::sqrt(by_shape));
  felt.half_interval_mm = t * felt.se_mm;
  felt.friction_below = (up->step.below + down->step.below) / 2;
  felt.friction_above = felt.friction_below + rise;
  return felt;
}

}  // namespace turnpoint::sensing
