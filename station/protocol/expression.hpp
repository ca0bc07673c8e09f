#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/core/reader.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// Parses arithmetic on numeric factors: numbers, factor names, + - * / and parentheses, and abs() around the
/// whole expression. A divisor must be a constant, and no factor may be multiplied by itself. Problems give
/// the column inside the text and suggest the nearest factor name.
std::optional<Linear> parse_linear(const std::string& source, const core::Place& place,
                                   const std::vector<Factor>& factors, core::Findings& findings);

/// Parses a comparison: two linear expressions with one of < <= == >= > between them.
std::optional<Comparison> parse_comparison(const std::string& source, const core::Place& place,
                                           const std::vector<Factor>& factors, core::Findings& findings);

/// Reads a number or a text with linear arithmetic. For all values of its factors the result must be within
/// `range`.
std::optional<Linear> linear_from(const core::Value& value, const std::string& key, const core::Range& range,
                                  const std::vector<Factor>& factors, core::Findings& findings);

/// Returns the combinations of the smallest and largest values of the factors in these expressions. Where
/// there would be more than 1024, the last factors keep their smallest value.
std::vector<Factors> corners(const std::vector<const Linear*>& expressions,
                             const std::vector<Factor>& factors);

/// Returns the smallest and largest value of the expression if each factor varies over its range or levels
/// independently of the others.
std::pair<double, double> bounds(const Linear& expression, const std::vector<Factor>& factors);

/// The smallest and the largest value of a numeric factor; empty for a text factor.
std::optional<std::pair<double, double>> span(const Factor& factor);

/// True if the factor's values could not be read. The reader has already reported that, so problems that only
/// follow from it should not be reported.
bool is_broken(const Factor& factor);

const Factor* find_factor(const std::vector<Factor>& factors, const std::string& name);
std::vector<std::string> names(const std::vector<Factor>& factors);

}  // namespace turnpoint::protocol
