#include <cmath>
#include <stdexcept>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

double evaluate(const Linear& expression, const Factors& factors) {
  double sum = expression.constant;
  for (const auto& [name, coefficient] : expression.terms) {
    const auto found = factors.find(name);
    const auto* value = found == factors.end() ? nullptr : std::get_if<double>(&found->second);
    if (!value)
      throw std::invalid_argument("\"" + expression.source + "\": the factor \"" + name +
                                  "\" does not have a number as its value");
    sum += coefficient * *value;
  }
  return expression.absolute ? std::fabs(sum) : sum;
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
