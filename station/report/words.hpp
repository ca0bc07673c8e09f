#pragma once
#include <initializer_list>
#include <string>
#include <utility>

#include "station/core/texts.hpp"

namespace turnpoint::report {

/// Says the words of figures and tables in one language.
class Words {
 public:
  explicit Words(std::string language) : language_(std::move(language)) {}
  std::string operator()(const char* key) const { return core::text(key, language_); }
  std::string operator()(const core::Phrase& phrase) const { return core::say(phrase, language_); }
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
