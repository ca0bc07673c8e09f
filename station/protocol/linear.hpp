#pragma once
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "station/core/problem.hpp"

namespace turnpoint::protocol {

using core::Place;

/// Values of the factors in one trial: a number for a numeric factor, a name for a text factor.
using FactorValue = std::variant<double, std::string>;
using Factors = std::map<std::string, FactorValue>;

/// A product of different numeric factors and a coefficient, such as `2 * ref * weber`.
struct FactorProduct {
  std::vector<std::string> factors;  ///< the names of two or more factors, sorted
  double coefficient = 0;
  bool operator==(const FactorProduct&) const = default;
};

/// A sum of numeric factors and their products, such as `150 - 0.5 * spread_mm`, `ref * (1 + weber)` or
/// `-30`. It is linear in each of its factors. If `absolute` is set, its value is the magnitude of the sum,
/// as in `abs(change)`.
struct Linear {
  double constant = 0;
  std::vector<std::pair<std::string, double>> terms;  ///< each factor's name with its coefficient
  std::vector<FactorProduct> products;
  bool absolute = false;
  std::string source;
  Place place;
  bool is_constant() const { return terms.empty() && products.empty(); }
};

/// The factors on which the expression depends, each once.
std::vector<std::string> factors_in(const Linear& expression);

/// Evaluates the expression for these factors. Throws std::invalid_argument naming a factor that has no
/// number.
double evaluate(const Linear& expression, const Factors& factors);

enum class Relation { less, less_equal, equal, greater_equal, greater };

/// Two linear expressions and a relation, such as `offset_mm < 0`.
struct Comparison {
  Linear left, right;
  Relation relation = Relation::less;
};
bool holds(const Comparison& comparison, const Factors& factors);

}  // namespace turnpoint::protocol
