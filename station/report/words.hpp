#pragma once
#include <initializer_list>
#include <string>
#include <utility>

#include "station/texts/texts.hpp"

namespace turnpoint::report {

/// Says the words of figures and tables in one language.
class Words {
 public:
  explicit Words(std::string language) : language_(std::move(language)) {}
  std::string operator()(const char* key) const { return texts::text(key, language_); }
  std::string operator()(const texts::Phrase& phrase) const { return texts::say(phrase, language_); }
  /// The text with `value` in its place %1.
  std::string operator()(const char* key, const std::string& value) const {
    return texts::say({key, "", {texts::plain(value)}}, language_);
  }
  /// The text with these values in its places %1, %2 and so on.
  std::string operator()(const char* key, std::initializer_list<std::string> values) const {
    texts::Phrase phrase{key, "", {}};
    for (const auto& value : values) phrase.values.push_back(texts::plain(value));
    return texts::say(phrase, language_);
  }

 private:
  std::string language_;
};

}  // namespace turnpoint::report
