#include "station/texts/texts.hpp"

#include <stdexcept>

#include "catalogues.hpp"
#include "station/text/toml.hpp"

namespace turnpoint::texts {

namespace {

using Texts = std::map<std::string, std::string>;

void read(const text::Value& table, const std::string& above, Texts& texts) {
  for (const auto& [key, place, value] : table.entries) {
    if (value.kind == text::Value::Kind::table)
      read(value, above + key + ".", texts);
    else
      texts[above + key] = value.string;
  }
}

const std::map<std::string, Texts>& all() {
  static const auto read_once = [] {
    std::map<std::string, Texts> all;
    for (const auto& [language, toml] : catalogues)
      read(text::parse_toml(toml, std::string(language) + ".toml"), "", all[language]);
    return all;
  }();
  return read_once;
}

const Texts& in(const std::string& language) {
  const auto spoken = all().find(language.substr(0, 2));
  return spoken == all().end() ? all().at("en") : spoken->second;
}

}  // namespace

std::vector<std::string> languages() {
  std::vector<std::string> codes;
  for (const auto& [language, texts] : all()) codes.push_back(language);
  return codes;
}

const Texts& catalogue(const std::string& language) { return all().at(language); }

const std::string& text(const std::string& key, const std::string& language) {
  const auto& texts = in(language);
  const auto found = texts.find(key);
  if (found == texts.end()) throw std::logic_error("no text has the key \"" + key + "\"");
  return found->second;
}

FaultText fault_text(terms::FaultKind kind, const std::string& language) {
  const auto key = std::string("fault.") + terms::name(kind);
  const bool own = in(language).count(key + ".safe") > 0;
  return {text(key + ".happened", language), text(own ? key + ".safe" : "fault.safe", language),
          text(key + ".to_do", language)};
}

}  // namespace turnpoint::texts
