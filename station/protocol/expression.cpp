#include "station/protocol/expression.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "station/core/number.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

struct SyntaxError {
  std::size_t at;
  core::Phrase what, allowed;
};

// A recursive-descent parser for an expression, or for one side of a comparison. Every result is linear in
// each of its factors, so its extremes are at the ends of the factors' ranges. Therefore no factor may be
// multiplied by itself.
class Parser {
 public:
  Parser(const std::string& source, std::size_t begin, std::size_t end, const std::vector<Factor>& factors)
      : source_(source), at_(begin), end_(end), factors_(factors) {}

  Linear whole() {
    auto result = sum();
    if (peek() != '\0')
      throw SyntaxError{at_, phrase("\"%1\" is not allowed here", {plain(std::string(1, source_[at_]))}),
                        form()};
    if (!std::isfinite(result.constant)) throw SyntaxError{0, phrase("the result is not finite"), form()};
    for (const auto& [name, coefficient] : result.terms)
      if (!std::isfinite(coefficient))
        throw SyntaxError{0, phrase("the coefficient of %1 is not finite", {plain(name)}), form()};
    for (const auto& product : result.products)
      if (!std::isfinite(product.coefficient))
        throw SyntaxError{0, phrase("a coefficient is not finite"), form()};
    if (factors_in(result).size() > most_factors)
      throw SyntaxError{0, phrase("the expression depends on more than 10 factors"), form()};
    return result;
  }

 private:
  static core::Phrase form() {
    return phrase(
        "allowed: sums and products of factors, such as %1 or %2, or abs(...) around the whole expression",
        {plain("\"150 - 0.5 * spread_mm\""), plain("\"ref * (1 + weber)\"")});
  }
  static constexpr std::size_t most_factors = 10;

  char peek() {
    while (at_ < end_ && (source_[at_] == ' ' || source_[at_] == '\t')) ++at_;
    return at_ < end_ ? source_[at_] : '\0';
  }
  bool accept(char c) { return peek() == c && ++at_ > 0; }

  Linear sum() {
    auto left = product();
    for (;;) {
      const auto at = (peek(), at_);
      const double sign = accept('+') ? 1 : accept('-') ? -1 : 0;
      if (sign == 0) return left;
      add(left, product(), sign, at);
    }
  }

  Linear product() {
    auto left = signed_term();
    for (;;) {
      const auto at = (peek(), at_);
      if (accept('*')) {
        left = multiplied(left, signed_term(), at);
      } else if (accept('/')) {
        const auto right = signed_term();
        if (!right.is_constant())
          throw SyntaxError{at, phrase("dividing by a factor is not allowed"), form()};
        if (right.constant == 0) throw SyntaxError{at, phrase("division by 0"), form()};
        scale(left, 1 / right.constant, at);
      } else {
        return left;
      }
    }
  }

  Linear signed_term() {
    const auto at = (peek(), at_);
    if (accept('+')) return signed_term_deeper();
    if (!accept('-')) return primary();
    auto term = signed_term_deeper();
    scale(term, -1, at);
    return term;
  }
  Linear signed_term_deeper() {
    if (++depth_ > 50) throw SyntaxError{at_, phrase("the expression is nested too deeply"), form()};
    auto term = signed_term();
    --depth_;
    return term;
  }

  Linear primary() {
    const char c = peek();
    if (c == '(') return parenthesised();
    if ((c >= '0' && c <= '9') || c == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(c)) || c == '_') return name();
    throw SyntaxError{at_,
                      c == '\0' ? phrase("the expression ends too early")
                                : phrase("\"%1\" is not allowed here", {plain(std::string(1, c))}),
                      form()};
  }

  Linear parenthesised() {
    ++at_;
    if (++depth_ > 50) throw SyntaxError{at_, phrase("the expression is nested too deeply"), form()};
    auto inner = sum();
    --depth_;
    if (!accept(')')) throw SyntaxError{at_, phrase("a \")\" is missing"), form()};
    return inner;
  }

  Linear number() {
    Linear result;
    const auto [end, error] = std::from_chars(source_.data() + at_, source_.data() + end_, result.constant);
    if (error != std::errc() || !std::isfinite(result.constant))
      throw SyntaxError{at_, phrase("not a number"), form()};
    at_ = static_cast<std::size_t>(end - source_.data());
    return result;
  }

  Linear name() {
    const auto begin = at_;
    while (at_ < end_ && (std::isalnum(static_cast<unsigned char>(source_[at_])) || source_[at_] == '_'))
      ++at_;
    const auto word = source_.substr(begin, at_ - begin);
    if (word == "abs" && peek() == '(') {
      auto inner = parenthesised();
      inner.absolute = !inner.is_constant();
      inner.constant = inner.absolute ? inner.constant : std::fabs(inner.constant);
      return inner;
    }
    const auto* factor = find_factor(factors_, word);
    if (!factor)
      throw SyntaxError{begin, phrase("unknown factor \"%1\"", {plain(word)}),
                        core::suggestion(word, names(factors_))};
    if (!span(*factor) && !is_broken(*factor))
      throw SyntaxError{begin, phrase("the factor \"%1\" has names as values, not numbers", {plain(word)}),
                        form()};
    Linear result;
    result.terms.emplace_back(word, 1.0);
    return result;
  }

  static void add(Linear& left, const Linear& right, double sign, std::size_t at) {
    if (left.absolute || right.absolute)
      throw SyntaxError{at, phrase("abs(...) is not allowed inside a sum"), form()};
    left.constant += sign * right.constant;
    for (const auto& [name, coefficient] : right.terms) {
      const auto same = [&, word = name](const auto& term) { return term.first == word; };
      const auto found = std::find_if(left.terms.begin(), left.terms.end(), same);
      if (found == left.terms.end())
        left.terms.emplace_back(name, sign * coefficient);
      else
        found->second += sign * coefficient;
    }
    for (const auto& product : right.products) {
      const auto same = [&](const auto& other) { return other.factors == product.factors; };
      const auto found = std::find_if(left.products.begin(), left.products.end(), same);
      if (found == left.products.end())
        left.products.push_back({product.factors, sign * product.coefficient});
      else
        found->coefficient += sign * product.coefficient;
    }
  }

  // The coefficients of a sum. The key of each is the list of factors that it multiplies; the empty list
  // stands for the constant.
  using Parts = std::map<std::vector<std::string>, double>;

  static Parts parts_of(const Linear& sum) {
    Parts parts{{{}, sum.constant}};
    for (const auto& [name, coefficient] : sum.terms) parts[{name}] += coefficient;
    for (const auto& product : sum.products) parts[product.factors] += product.coefficient;
    return parts;
  }

  static Linear multiplied(const Linear& left, const Linear& right, std::size_t at) {
    if (left.absolute || right.absolute)
      throw SyntaxError{at, phrase("abs(...) is not allowed inside a product"), form()};
    Linear result = left.is_constant() ? right : left;
    if (left.is_constant() || right.is_constant()) {
      scale(result, left.is_constant() ? left.constant : right.constant, at);
      return result;
    }
    Parts parts;
    for (const auto& [a, x] : parts_of(left))
      for (const auto& [b, y] : parts_of(right)) {
        std::vector<std::string> both;
        std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
        if (std::adjacent_find(both.begin(), both.end()) != both.end())
          throw SyntaxError{at, phrase("a factor is multiplied by itself"), form()};
        if (x * y != 0) parts[both] += x * y;
      }
    result = {};
    for (const auto& [names, coefficient] : parts) {
      if (names.empty()) result.constant = coefficient;
      if (names.size() == 1) result.terms.emplace_back(names.front(), coefficient);
      if (names.size() > 1) result.products.push_back({names, coefficient});
    }
    return result;
  }

  static void scale(Linear& expression, double by, std::size_t at) {
    if (expression.absolute)
      throw SyntaxError{at, phrase("abs(...) is not allowed inside a product"), form()};
    expression.constant *= by;
    for (auto& term : expression.terms) term.second *= by;
    for (auto& product : expression.products) product.coefficient *= by;
  }

  const std::string& source_;
  std::size_t at_, end_;
  const std::vector<Factor>& factors_;
  int depth_ = 0;
};

// Returns the place in the file of one character of an expression's text. The text starts one column after
// its opening quote. Columns count characters, not bytes.
core::Place inside(const core::Place& place, const std::string& source, std::size_t at) {
  const auto end = source.begin() + static_cast<std::ptrdiff_t>(std::min(at, source.size()));
  const auto characters = std::count_if(
      source.begin(), end, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return {place.file, place.line, place.column + 1 + static_cast<int>(characters)};
}

std::optional<Linear> side(const std::string& source, std::size_t begin, std::size_t end,
                           const core::Place& place, const std::vector<Factor>& factors,
                           core::Findings& findings) {
  try {
    auto result = Parser(source, begin, end, factors).whole();
    result.source = source.substr(begin, end - begin);
    result.place = place;
    return result;
  } catch (const SyntaxError& error) {
    findings.add(inside(place, source, error.at), phrase("\"%1\": %2", {plain(source), error.what}),
                 error.allowed);
    return std::nullopt;
  }
}

}  // namespace

std::optional<Linear> parse_linear(const std::string& source, const core::Place& place,
                                   const std::vector<Factor>& factors, core::Findings& findings) {
  return side(source, 0, source.size(), place, factors, findings);
}

std::optional<Comparison> parse_comparison(const std::string& source, const core::Place& place,
                                           const std::vector<Factor>& factors, core::Findings& findings) {
  const auto at = source.find_first_of("<>=");
  const std::string two = at == std::string::npos ? "" : source.substr(at, 2);
  Comparison comparison;
  std::size_t length = 2;
  if (two == "<=")
    comparison.relation = Relation::less_equal;
  else if (two == ">=")
    comparison.relation = Relation::greater_equal;
  else if (two == "==")
    comparison.relation = Relation::equal;
  else if (!two.empty() && two[0] != '=') {
    comparison.relation = two[0] == '<' ? Relation::less : Relation::greater;
    length = 1;
  } else {
    findings.add(place, phrase("\"%1\" is not a comparison", {plain(source)}),
                 phrase("write two sides with one of %1 between them, such as %2",
                        {plain("< <= == >= >"), plain("\"offset_mm < 0\"")}));
    return std::nullopt;
  }
  const auto left = side(source, 0, at, place, factors, findings);
  const auto right = side(source, at + length, source.size(), place, factors, findings);
  if (!left || !right) return std::nullopt;
  comparison.left = *left, comparison.right = *right;
  return comparison;
}

std::optional<Linear> linear_from(const core::Value& value, const std::string& key, const core::Range& range,
                                  const std::vector<Factor>& factors, core::Findings& findings) {
  std::optional<Linear> result;
  if (value.kind == core::Value::Kind::string) {
    result = parse_linear(value.string, value.place, factors, findings);
    if (!result) return std::nullopt;
  } else if (value.kind == core::Value::Kind::number || value.kind == core::Value::Kind::integer) {
    result.emplace();
    result->constant = value.number;
    result->source = core::exact(value.number);
    result->place = value.place;
  } else {
    findings.add(value.place, phrase("\"%1\" is %2", {plain(key), describe(value)}),
                 phrase("write a number, or a linear expression of factors in quotes, such as %1",
                        {plain("\"mark_mm + offset_mm\"")}));
    return std::nullopt;
  }
  const auto broken = [&](const std::string& name) { return is_broken(*find_factor(factors, name)); };
  const auto used = factors_in(*result);
  if (std::any_of(used.begin(), used.end(), broken)) return result;
  const auto [low, high] = bounds(*result, factors);
  if (core::inside_range(low, range) && inside_range(high, range)) return result;
  if (result->is_constant())
    findings.add(value.place, phrase("\"%1\" is %2", {plain(key), plain(core::number(low))}),
                 phrase("allowed: %1", {describe(range)}));
  else
    findings.add(value.place,
                 phrase("\"%1\" runs from %2 to %3 depending on the values of its factors",
                        {plain(key), plain(core::number(low)), plain(core::number(high))}),
                 phrase("allowed: %1", {describe(range)}));
  return std::nullopt;
}

std::vector<Factors> corners(const std::vector<const Linear*>& expressions,
                             const std::vector<Factor>& factors) {
  constexpr std::size_t most_corners = 1024;  // an expression has ten factors at most
  std::set<std::string> names;
  for (const auto* expression : expressions)
    for (const auto& name : factors_in(*expression)) names.insert(name);
  std::vector<Factors> all{{}};
  for (const auto& name : names) {
    const auto* factor = find_factor(factors, name);
    const auto ends = (factor ? span(*factor) : std::nullopt).value_or(std::pair(0.0, 0.0));
    const auto count = all.size() < most_corners ? all.size() : 0;
    if (count == 0)
      for (auto& corner : all) corner[name] = ends.first;
    for (std::size_t i = 0; i < count; ++i) {
      all.push_back(all[i]);
      all[i][name] = ends.first, all.back()[name] = ends.second;
    }
  }
  return all;
}

namespace {

/// The smallest and largest value of the expression without abs(). It is linear in each factor, so both are
/// at ends of the factors' ranges.
std::pair<double, double> signed_bounds(Linear expression, const std::vector<Factor>& factors) {
  expression.absolute = false;
  const auto all = corners({&expression}, factors);
  double low = evaluate(expression, all.front()), high = low;
  for (const auto& corner : all) {
    const double value = evaluate(expression, corner);
    low = std::min(low, value), high = std::max(high, value);
  }
  return {low, high};
}

}  // namespace

std::pair<double, double> bounds(const Linear& expression, const std::vector<Factor>& factors) {
  const auto [low, high] = signed_bounds(expression, factors);
  if (!expression.absolute) return {low, high};
  const double furthest = std::max(std::fabs(low), std::fabs(high));
  return {low <= 0 && high >= 0 ? 0 : std::min(std::fabs(low), std::fabs(high)), furthest};
}

std::optional<std::pair<double, double>> span(const Factor& factor) {
  if (factor.range) return factor.range;
  std::optional<std::pair<double, double>> result;
  for (const auto& level : factor.levels) {
    const auto* number = std::get_if<double>(&level);
    if (!number) return std::nullopt;
    if (!result) result = {*number, *number};
    result = {std::min(result->first, *number), std::max(result->second, *number)};
  }
  return result;
}

bool is_broken(const Factor& factor) { return !factor.range && factor.levels.empty(); }

const Factor* find_factor(const std::vector<Factor>& factors, const std::string& name) {
  const auto found =
      std::find_if(factors.begin(), factors.end(), [&](const Factor& f) { return f.name == name; });
  return found == factors.end() ? nullptr : &*found;
}

std::vector<std::string> names(const std::vector<Factor>& factors) {
  std::vector<std::string> list;
  for (const auto& factor : factors) list.push_back(factor.name);
  return list;
}

}  // namespace turnpoint::protocol
