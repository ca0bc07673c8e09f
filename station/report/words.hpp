#pragma once
#include <initializer_list>
#include <string>
#include <utility>

#include "station/analysis/estimate.hpp"
#include "station/core/number.hpp"
#include "station/core/texts.hpp"

namespace turnpoint::report {

/// The name of a condition, or "all trials" if there is only one condition.
inline core::Phrase name_of(const std::string& condition) {
  return condition.empty() ? core::phrase("figure.all_trials") : core::plain(condition);
}

inline core::Phrase second_minus_first(const std::string& first, const std::string& second) {
  return {"", "", {name_of(second), core::plain(" \u2212 "), name_of(first)}};
}

/// A name with its unit, if it has one.
inline core::Phrase in_unit(core::Phrase name, core::Phrase unit) {
  if (unit.empty()) return name;
  return {"", "", {std::move(name), core::plain(" ("), std::move(unit), core::plain(")")}};
}

/// With a typographic minus sign.
inline std::string with_minus(std::string number) {
  return number.starts_with('-') ? "\u2212" + number.substr(1) : number;
}

/// Formats an estimate with the digits that its interval justifies, as tables show it, and with a typographic
/// minus sign. Without an interval it has three digits.
inline std::string in_digits(double value, const analysis::Interval* interval) {
  return with_minus(interval == nullptr
                        ? core::number(value, 3)
                        : core::estimated(value, core::uncertainty(value, interval->low, interval->high)));
}

/// Says the words of figures and tables in one language.
class Words {
 public:
  explicit Words(std::string language) : language_(std::move(language)) {}
  std::string operator()(const char* key) const { return core::text(key, language_); }
  std::string operator()(const core::Phrase& phrase) const { return core::say(phrase, language_); }
  /// These texts, one after another.
  std::string together(std::initializer_list<const char*> keys) const {
    std::string all;
    for (const auto* key : keys) all += (all.empty() ? "" : " ") + (*this)(key);
    return all;
  }
  /// The text with `value` in its place %1.
  std::string operator()(const char* key, const std::string& value) const {
    return core::say({key, "", {core::plain(value)}}, language_);
  }
  /// The text with these values in its places %1, %2 and so on.
  std::string operator()(const char* key, std::initializer_list<std::string> values) const {
    core::Phrase phrase{key, "", {}};
    for (const auto& value : values) phrase.values.push_back(core::plain(value));
    return core::say(phrase, language_);
  }

 private:
  std::string language_;
};

}  // namespace turnpoint::report
