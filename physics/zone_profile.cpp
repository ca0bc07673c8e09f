#include "physics/zone_profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/nnls.hpp"
#include "physics/root.hpp"
#include "physics/smooth_sides.hpp"
#include "physics/statement.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

constexpr double grid_step_m = 0.5e-3;
constexpr int candidates_per_spacing = 3;
constexpr int most_candidate_tones = 40;
// A further tone is used only if it reduces the unevenness of the zone to this fraction or less.
constexpr double worthwhile = 0.97;

double interpolate_crossing(double x0, double x1, double y0, double y1, double level) {
  return x0 + (x1 - x0) * (level - y0) / (y1 - y0);
}

}  // namespace

ZoneProfile::ZoneProfile(const Surface& surface, const FrictionMap& friction, ZoneRequest request,
                         double highest_Hz)
    : surface_(surface), friction_(friction), request_(std::move(request)) {
  const int count = std::clamp(static_cast<int>(std::ceil(surface.length_m / grid_step_m)), 200, 2000);
  for (int i = 0; i <= count; ++i) x_.push_back(surface.length_m * i / count);
  weights_of_mean_ = mean_weights();
  choose_tones(highest_Hz);
}

ToneShape ZoneProfile::shape(double f) const {
  const auto line = make_centre_line(surface_, f, Model::mode);
  const auto peak = line->last_peak_m();
  if (!peak)
    throw Refused(make_statement("no-peak-at", "a tone of %1 Hz has no last maximum on this surface", {f}));
  const double ln_peak = line->value(*peak).ln_magnitude();
  std::vector<std::complex<double>> v(x_.size());
  std::vector<double> ln(x_.size());
  line->evaluate(x_, 1.0, ln_peak, v, ln);
  ToneShape one;
  one.frequency_Hz = f;
  one.drive_gain = std::exp(line->value(0).ln_magnitude() - ln_peak);
  for (const auto& value : v) one.square.push_back(std::norm(value));
  return one;
}

// Returns non-negative weights of the tones for which the weighted sum of squared amplitudes is as close to 1
// in the zone as possible.
std::vector<double> ZoneProfile::fit(const std::vector<const ToneShape*>& shapes, double& residual) const {
  std::vector<double> columns, wanted;
  for (const ToneShape* one : shapes) {
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (in_zone(i)) columns.push_back(one->square[i]);
    }
  }
  wanted.assign(columns.size() / shapes.size(), 1.0);
  const NnlsResult result = nnls(columns, wanted.size(), wanted);
  residual = result.residual_norm / std::sqrt(static_cast<double>(wanted.size()));
  return result.x;
}

void ZoneProfile::choose_tones(double highest_Hz) {
  shapes_ = {shape(highest_Hz)};
  double best = 0;
  weights_ = fit({&shapes_[0]}, best);
  if (request_.tones == 1) return;
  const double step = std::max(request_.band.spacing_Hz / candidates_per_spacing,
                               (highest_Hz - request_.band.low_Hz) / most_candidate_tones);
  std::vector<ToneShape> candidates;
  for (double f = highest_Hz - request_.band.spacing_Hz; f >= request_.band.low_Hz; f -= step) {
    try {
      candidates.push_back(shape(f));
    } catch (const std::domain_error&) {  // a tone without a last maximum cannot be used
      break;
    }
  }
  while (static_cast<int>(shapes_.size()) < request_.tones) {
    const ToneShape* chosen = nullptr;
    double lowest = best * worthwhile;
    for (const ToneShape& candidate : candidates) {
      std::vector<const ToneShape*> trial;
      bool clear = true;
      for (const ToneShape& one : shapes_) {
        trial.push_back(&one);
        clear =
            clear && std::abs(one.frequency_Hz - candidate.frequency_Hz) > 0.999 * request_.band.spacing_Hz;
      }
      if (!clear) continue;
      trial.push_back(&candidate);
      double residual = 0;
      const auto weights = fit(trial, residual);
      // Accept only a set in which the highest tone has a noticeable weight: this tone determines the
      // boundary, so without it the zone would be different.
      if (residual < lowest && weights.front() > 0.05 * weights.back()) {
        lowest = residual;
        chosen = &candidate;
      }
    }
    if (chosen == nullptr) break;
    shapes_.push_back(*chosen);
    std::vector<const ToneShape*> all;
    for (const ToneShape& one : shapes_) all.push_back(&one);
    weights_ = fit(all, best);
  }
  // Remove tones of weight 0 and sort the others by descending frequency.
  for (std::size_t i = shapes_.size(); i-- > 1;) {
    if (weights_[i] > 0) continue;
    shapes_.erase(shapes_.begin() + static_cast<std::ptrdiff_t>(i));
    weights_.erase(weights_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  for (std::size_t i = 1; i < shapes_.size(); ++i) {
    for (std::size_t j = i; j > 1 && shapes_[j].frequency_Hz > shapes_[j - 1].frequency_Hz; --j) {
      std::swap(shapes_[j], shapes_[j - 1]);
      std::swap(weights_[j], weights_[j - 1]);
    }
  }
}

void ZoneProfile::shift_to(double highest_Hz) {
  const double by = highest_Hz - shapes_.front().frequency_Hz;
  shapes_.front() = shape(highest_Hz);
  for (std::size_t i = 1; i < shapes_.size();) {
    const double f = std::max(request_.band.low_Hz, shapes_[i].frequency_Hz + by);
    // at the band's lower end, this tone would be too close to the previous one: remove it
    if (shapes_[i - 1].frequency_Hz - f < 0.999 * request_.band.spacing_Hz) {
      shapes_.erase(shapes_.begin() + static_cast<std::ptrdiff_t>(i));
      weights_.erase(weights_.begin() + static_cast<std::ptrdiff_t>(i));
      continue;
    }
    shapes_[i] = shape(f);
    ++i;
  }
}

std::vector<double> ZoneProfile::summed() const {
  std::vector<double> sum(x_.size(), 0.0);
  for (std::size_t t = 0; t < shapes_.size(); ++t) {
    for (std::size_t i = 0; i < x_.size(); ++i) sum[i] += weights_[t] * shapes_[t].square[i];
  }
  return sum;
}

std::vector<double> ZoneProfile::felt(double scale) const {
  std::vector<double> friction = summed();
  for (double& one : friction) one = friction_.relative_friction(std::sqrt(scale * one));
  return fingertip_average(x_, friction, request_.fingertip_m);
}

double ZoneProfile::zone_mean(const std::vector<double>& values) const {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (!in_zone(i)) continue;
    sum += values[i];
    ++count;
  }
  return sum / std::max(1, count);
}

// Returns the weight with which the friction at each point enters the zone's mean friction. The mean of the
// fingertip averages is a linear function of the friction: each average is an integral over straight pieces,
// and each piece adds to the weights of its two ends.
std::vector<double> ZoneProfile::mean_weights() const {
  std::vector<double> weight(x_.size(), 0.0);
  const double step = x_[1] - x_[0];
  int count = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) count += in_zone(i) ? 1 : 0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    if (!in_zone(i)) continue;
    if (request_.fingertip_m == 0) {
      weight[i] += 1.0 / count;
      continue;
    }
    const double low = std::max(x_.front(), x_[i] - request_.fingertip_m / 2);
    const double high = std::min(x_.back(), x_[i] + request_.fingertip_m / 2);
    const auto first = static_cast<std::size_t>(low / step);
    for (std::size_t j = std::min(first, x_.size() - 2); j + 1 < x_.size() && x_[j] < high; ++j) {
      const double from = std::max(low, x_[j]), to = std::min(high, x_[j + 1]);
      if (!(to > from)) continue;
      const double right = (0.5 * (from + to) - x_[j]) / (x_[j + 1] - x_[j]);
      const double share = (to - from) / (high - low) / count;
      weight[j] += share * (1 - right);
      weight[j + 1] += share * right;
    }
  }
  return weight;
}

void ZoneProfile::scale_to_friction() {
  scaled_.push_back(summed());
  scale(scaled_.back());
}

void ZoneProfile::rescale_to_friction(double friction) {
  request_.friction = friction;
  scale_ = first_scale_m2;
  scaled_before_ = false;
  for (const auto& sum : scaled_) scale(sum);
}

void ZoneProfile::scale(const std::vector<double>& sum) {
  const auto miss = [&](double ln) {
    const double scale = std::exp(ln);
    double mean = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (weights_of_mean_[i] > 0)
        mean += weights_of_mean_[i] * friction_.relative_friction(std::sqrt(scale * sum[i]));
    }
    return mean - request_.friction;
  };
  // Mean friction falls as the level rises. Widen an interval of levels on a logarithmic scale, starting from
  // the previous level, until it contains the solution; then find the solution by false position.
  double low = std::log(scale_), high = low;
  double f_low = miss(low), f_high = f_low;
  double step = scaled_before_ ? 0.01 : 0.3;
  for (; f_low < 0 && low > -120; step *= 2) f_low = miss(low -= step);
  for (; f_high > 0 && high < 10; step *= 2) f_high = miss(high += step);
  if (f_low < 0 || f_high > 0)
    throw Refused(make_statement("zone-mean-friction", "mean friction %1 is not reachable in the zone",
                                 {request_.friction}));
  // If the lower end already is the solution, no search is needed.
  const double x = std::abs(f_low) < 1e-9 ? low
                                          : false_position({low, f_low, high, f_high}, miss, {8, true}, 1e-9,
                                                           [](const Chord& c) { return c.width() <= 1e-12; });
  scale_ = std::exp(x);
  scaled_before_ = true;
}

std::optional<double> ZoneProfile::edge_m() const {
  if (request_.edge.kind == Edge::Kind::turning) return turning_point_m(surface_, highest_Hz());
  if (request_.edge.kind == Edge::Kind::friction) {
    const std::vector<double> friction = felt(scale_);
    for (std::size_t i = x_.size() - 1; i > 0; --i) {
      if (friction[i] > request_.edge.level && friction[i - 1] <= request_.edge.level) {
        return interpolate_crossing(x_[i - 1], x_[i], friction[i - 1], friction[i], request_.edge.level);
      }
    }
    return std::nullopt;
  }
  const std::vector<double> sum = summed();
  std::size_t peak = x_.size() - 1;
  while (peak > 0 && sum[peak - 1] >= sum[peak]) --peak;
  if (peak == 0 || peak + 1 >= x_.size()) return std::nullopt;
  // The maximum of a parabola through the three highest samples.
  const double a = sum[peak - 1], b = sum[peak], c = sum[peak + 1];
  const double bend = a - 2 * b + c;
  const double offset = bend < 0 ? 0.5 * (a - c) / bend : 0;
  if (request_.edge.kind == Edge::Kind::peak) return x_[peak] + offset * (x_[1] - x_[0]);
  const double top = b - 0.25 * (a - c) * offset;
  const double level = request_.edge.level * request_.edge.level * top;
  for (std::size_t i = peak; i + 1 < x_.size(); ++i) {
    if (sum[i] >= level && sum[i + 1] < level) {
      return interpolate_crossing(x_[i], x_[i + 1], std::log(sum[i]), std::log(sum[i + 1]), std::log(level));
    }
  }
  return std::nullopt;
}

double ZoneProfile::edge_slope_m_per_Hz() const {
  const Taper taper(smooth_sides(surface_));
  const double f = highest_Hz();
  const Dispersion dispersion(surface_);
  const auto above = taper.position_continued_m(dispersion.cut_off_half_width_m(f * 1.001));
  const auto below = taper.position_continued_m(dispersion.cut_off_half_width_m(f * 0.999));
  return above && below ? (*above - *below) / (0.002 * f) : surface_.length_m / f;
}

std::vector<Tone> ZoneProfile::tones() const {
  std::vector<Tone> list;
  for (std::size_t t = 0; t < shapes_.size(); ++t) {
    list.push_back({shapes_[t].frequency_Hz, std::sqrt(scale_ * weights_[t]) * shapes_[t].drive_gain, 0});
  }
  return list;
}

void ZoneProfile::measure(ZoneDesign& design) const {
  const std::vector<double> sum = summed();
  const std::vector<double> friction = felt(scale_);
  design.friction = zone_mean(friction);
  design.boundary_m = edge_m().value_or(0);
  double variance = 0, lowest = std::numeric_limits<double>::infinity(), total = 0;
  int count = 0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    double in_phase = 0;
    for (std::size_t t = 0; t < shapes_.size(); ++t) {
      in_phase += std::sqrt(scale_ * weights_[t] * shapes_[t].square[i]);
    }
    design.peak_displacement_m = std::max(design.peak_displacement_m, in_phase);
    if (!in_zone(i)) continue;
    variance += std::pow(friction[i] - design.friction, 2);
    lowest = std::min(lowest, sum[i]);
    total += sum[i];
    ++count;
  }
  design.residual = std::sqrt(variance / std::max(1, count));
  design.node_fill = total > 0 ? lowest * count / total : 0;
}

}  // namespace turnpoint::physics
