#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/text/reader.hpp"

namespace turnpoint::protocol {

/// Parses linear arithmetic on numeric factors: numbers, factor names, + - * / and parentheses, and abs()
/// around the whole. Problems carry the column inside the text and name the nearest factor.
std::optional<Linear> parse_linear(const std::string& source, const text::Place& place,
                                   const std::vector<Factor>& factors, text::Findings& findings);

/// Two linear sides and one of < <= == >= >.
std::optional<Comparison> parse_comparison(const std::string& source, const text::Place& place,
                                           const std::vector<Factor>& factors, text::Findings& findings);

/// A number or a text with linear arithmetic. Over all values of its factors the result must stay in `range`.
std::optional<Linear> linear_from(const text::Value& value, const std::string& key, const text::Range& range,
                                  const std::vector<Factor>& factors, text::Findings& findings);

/// The least and greatest value while each factor runs over its range or levels independently.
std::pair<double, double> bounds(const Linear& expression, const std::vector<Factor>& factors);

/// The least and greatest value of a numeric factor; nullopt for a text factor.
std::optional<std::pair<double, double>> span(const Factor& factor);

/// The factor's values could not be read: that was reported, and nothing that follows from it needs to be.
bool is_broken(const Factor& factor);

const Factor* find_factor(const std::vector<Factor>& factors, const std::string& name);
std::vector<std::string> names(const std::vector<Factor>& factors);

/// `did you mean "x"? known: a, b, c`.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace turnpoint::protocol
