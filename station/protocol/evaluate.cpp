#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

double evaluate(const Linear& expression, const Factors& factors) {
  const auto value_of = [&](const std::string& name) {
    const auto found = factors.find(name);
    const auto* value = found == factors.end() ? nullptr : std::get_if<double>(&found->second);
    if (!value)
      throw std::invalid_argument("\"" + expression.source + "\": the factor \"" + name +
                                  "\" does not have a number as its value");
    return *value;
  };
  double sum = expression.constant;
  for (const auto& [name, coefficient] : expression.terms) sum += coefficient * value_of(name);
  for (const auto& product : expression.products) {
    double value = product.coefficient;
    for (const auto& name : product.factors) value *= value_of(name);
    sum += value;
  }
  return expression.absolute ? std::fabs(sum) : sum;
}

std::vector<std::string> factors_in(const Linear& expression) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const auto& [name, coefficient] : expression.terms) add(name);
  for (const auto& product : expression.products)
    for (const auto& name : product.factors) add(name);
  return names;
}

bool holds(const Comparison& comparison, const Factors& factors) {
  const double left = evaluate(comparison.left, factors), right = evaluate(comparison.right, factors);
  switch (comparison.relation) {
    case Relation::less:
      return left < right;
    case Relation::less_equal:
      return left <= right;
    case Relation::equal:
      return left == right;
    case Relation::greater_equal:
      return left >= right;
    case Relation::greater:
      return left > right;
  }
  return false;
}

}  // namespace turnpoint::protocol
