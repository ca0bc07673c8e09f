#include "station/analysis/psychometric_function.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "station/analysis/proportion.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

namespace {
constexpr double kPerDecibel = std::numbers::ln10 / 20;
}

double sigmoid(Function function, double z) {
  switch (function) {
    case Function::weibull:
      return -std::expm1(-std::exp(z));
    case Function::normal:
      return normal_cdf(z);
    case Function::logistic:
      break;
  }
  return 1 / (1 + std::exp(-z));
}

double sigmoid_derivative(Function function, double z) {
  switch (function) {
    case Function::weibull:
      return z > 700 ? 0 : std::exp(z - std::exp(z));
    case Function::normal:
      return normal_density(z);
    case Function::logistic:
      break;
  }
  const double p = 1 / (1 + std::exp(-z));
  return p * (1 - p);
}

double sigmoid_inverse(Function function, double p) {
  if (!(p > 0 && p < 1))
    throw std::invalid_argument("inverse of a psychometric function at " + core::number(p) +
                                ": it must be above 0 and below 1");
  switch (function) {
    case Function::weibull:
      return std::log(-std::log1p(-p));
    case Function::normal:
      return normal_quantile(p);
    case Function::logistic:
      break;
  }
  return std::log(p / (1 - p));
}

double axis_position(Function function, Scale scale, double level) {
  if (scale == Scale::linear) return level;
  if (!(level > 0))
    throw std::invalid_argument("level " + core::number(level) + " on a log10 scale: it must be above 0");
  return (function == Function::weibull ? 20 : 1) * std::log10(level);
}

double level_from_axis(Function function, Scale scale, double u) {
  if (scale == Scale::linear) return u;
  return std::pow(10.0, u / (function == Function::weibull ? 20 : 1));
}

double rate_from_slope(Function function, double slope) {
  switch (function) {
    case Function::weibull:
      return kPerDecibel * slope;
    case Function::normal:
      return 1 / slope;
    case Function::logistic:
      break;
  }
  return slope;
}

double slope_from_rate(Function function, double rate) {
  switch (function) {
    case Function::weibull:
      return rate / kPerDecibel;
    case Function::normal:
      return 1 / rate;
    case Function::logistic:
      break;
  }
  return rate;
}

double probability(Function function, Scale scale, const Psychometric& parameters, double level) {
  const double z =
      rate_from_slope(function, parameters.slope) *
      (axis_position(function, scale, level) - axis_position(function, scale, parameters.threshold));
  return parameters.guess + (1 - parameters.guess - parameters.lapse) * sigmoid(function, z);
}

std::optional<double> level_at(Function function, Scale scale, const Psychometric& parameters, double p) {
  const double inside = (p - parameters.guess) / (1 - parameters.guess - parameters.lapse);
  if (!(inside > 0 && inside < 1)) return std::nullopt;
  const double u = axis_position(function, scale, parameters.threshold) +
                   sigmoid_inverse(function, inside) / rate_from_slope(function, parameters.slope);
  return level_from_axis(function, scale, u);
}

}  // namespace turnpoint::analysis
