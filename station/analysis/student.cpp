#include "station/analysis/student.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

namespace turnpoint::analysis {

namespace {

double average(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Estimate student(double value, double error, double degrees) {
  const boost::math::students_t student(degrees);
  const double half = boost::math::quantile(student, 0.975) * error;
  const double p = error > 0
                       ? 2 * boost::math::cdf(boost::math::complement(student, std::fabs(value) / error))
                       : (value == 0 ? 1 : 0);
  return {value, {value - half, value + half, 0.95}, p};
}

}  // namespace

std::optional<Estimate> student_mean(const std::vector<double>& values) {
  if (values.size() < 3) return std::nullopt;
  const double n = static_cast<double>(values.size()), mean = average(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return student(mean, std::sqrt(squares / (n - 1) / n), n - 1);
}

std::optional<Estimate> student_proportion(const std::vector<double>& values) {
  auto estimate = student_mean(values);
  if (!estimate || estimate->value <= 0 || estimate->value >= 1) return estimate;
  const double mean = estimate->value, logit = std::log(mean / (1 - mean));
  const double half = (estimate->interval.high - mean) / (mean * (1 - mean));
  const auto back = [](double at) { return 1 / (1 + std::exp(-at)); };
  estimate->interval = {back(logit - half), back(logit + half), 0.95};
  return estimate;
}

std::optional<Estimate> student_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() < 3 || b.size() < 3) return std::nullopt;
  double error = 0, weights = 0;
  for (const auto* sample : {&a, &b}) {
    const double n = static_cast<double>(sample->size()), mean = average(*sample);
    double squares = 0;
    for (const double value : *sample) squares += (value - mean) * (value - mean);
    const double of_mean = squares / (n - 1) / n;
    error += of_mean, weights += of_mean * of_mean / (n - 1);
  }
  if (error <= 0) return std::nullopt;
  return student(average(a) - average(b), std::sqrt(error), error * error / weights);
}

std::optional<Estimate> student_slope(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() < 3) return std::nullopt;
  const double n = static_cast<double>(x.size()), x_mean = average(x), y_mean = average(y);
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = x[i] - x_mean, dy = y[i] - y_mean;
    xx += dx * dx, xy += dx * dy, yy += dy * dy;
  }
  if (xx <= 0) return std::nullopt;
  const double slope = xy / xx;
  return student(slope, std::sqrt(std::max(yy - slope * xy, 0.0) / (n - 2) / xx), n - 2);
}

std::optional<Estimate> student_ratio(const std::vector<double>& y, const std::vector<double>& x) {
  if (x.size() < 3 || average(x) <= 0) return std::nullopt;
  const double n = static_cast<double>(x.size()), ratio = average(y) / average(x);
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) squares += (y[i] - ratio * x[i]) * (y[i] - ratio * x[i]);
  return student(ratio, std::sqrt(squares / (n - 1) / n) / average(x), n - 1);
}

}  // namespace turnpoint::analysis
