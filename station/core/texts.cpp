#include "station/core/texts.hpp"

#include <array>
#include <iterator>
#include <mutex>
#include <stdexcept>

#include "catalogues.hpp"
#include "station/core/toml.hpp"

namespace turnpoint::core {
namespace {

using Texts = std::map<std::string, std::string, std::less<>>;

struct Spoken {
  Texts texts;
  Translation translation = Translation::unread;
};

/// Takes the texts of a table and of the tables in it.
void take(const Value& table, const std::string& before, Texts& texts) {
  for (const auto& entry : table.entries)
    if (entry.value.kind == Value::Kind::table)
      take(entry.value, before + entry.key + ".", texts);
    else
      texts[before + entry.key] = entry.value.string;
}

void read(const Catalogue& catalogue, Spoken& spoken) {
  std::string source;
  for (const auto* line : catalogue.lines) (source += line) += '\n';
  take(parse_toml(source, std::string(catalogue.language) + ".toml"), "", spoken.texts);
  const auto read_by = spoken.texts.find("read_by_native_speaker");
  if (read_by == spoken.texts.end()) return;
  if (read_by->second == "all") spoken.translation = Translation::read;
  if (read_by->second == "participant") spoken.translation = Translation::participant_read;
  spoken.texts.erase(read_by);
}

/// Returns the catalogue of a language ("de", "de-CH"), or null if the station does not speak it. Each
/// catalogue is parsed when it is asked for the first time.
const Spoken* find(std::string_view language) {
  static std::array<Spoken, std::size(catalogues)> spoken;
  static std::array<std::once_flag, std::size(catalogues)> parsed;
  for (std::size_t i = 0; i < spoken.size(); ++i) {
    if (language.substr(0, 2) != catalogues[i].language) continue;
    std::call_once(parsed[i], [i] { read(catalogues[i], spoken[i]); });
    return &spoken[i];
  }
  return nullptr;
}

/// Returns the text with this key in the given language, or in English if that catalogue does not have it;
/// null if there is no such text.
const std::string* find_text(std::string_view key, std::string_view language) {
  for (const auto* spoken : {find(language), find("en")}) {
    if (spoken == nullptr) continue;
    if (const auto found = spoken->texts.find(key); found != spoken->texts.end()) return &found->second;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> languages() {
  std::vector<std::string> codes;
  for (const auto& one : catalogues) codes.emplace_back(one.language);
  return codes;
}

const Texts& catalogue(std::string_view language) {
  const auto* spoken = find(language);
  if (spoken == nullptr) throw std::logic_error("no texts in the language \"" + std::string(language) + "\"");
  return spoken->texts;
}

Translation translation(const std::string& language) {
  const auto* spoken = find(language);
  return spoken == nullptr ? Translation::none : spoken->translation;
}

std::string text(std::string_view key, std::string_view language) {
  // A sentence is not a key: keys have no spaces and no places.
  if (key.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.-") != std::string_view::npos)
    return std::string(key);
  if (const auto* found = find_text(key, language)) return *found;
  throw std::logic_error("no text has the key \"" + std::string(key) + "\"");
}

std::string say(const Phrase& phrase, std::string_view language) {
  auto said = phrase.key.empty() ? phrase.words : std::string();
  if (phrase.key.empty()) {
    for (const auto& value : phrase.values) said += say(value, language);
    return said;
  }
  const auto pattern = text(phrase.key, language);
  // In Arabic, which is written from right to left, invisible characters around a value keep its parts in
  // their order ("-30" would be drawn as "30-"). Texts.qml does the same.
  const bool mirrored = language.starts_with("ar");
  const std::string before = mirrored ? "\u2068" : "", after = mirrored ? "\u2069" : "";
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const bool place = pattern[i] == '%' && i + 1 < pattern.size() && pattern[i + 1] >= '1' &&
                       pattern[i + 1] < '1' + static_cast<int>(phrase.values.size());
    if (place)
      said += before + say(phrase.values[static_cast<std::size_t>(pattern[++i] - '1')], language) + after;
    else
      said += pattern[i];
  }
  return said;
}

FaultText fault_text(FaultKind kind, const std::string& language) {
  const auto key = std::string("fault.") + core::name(kind);
  const bool own = find_text(key + ".safe", language) != nullptr;
  return {text(key + ".happened", language), text(own ? key + ".safe" : "fault.safe", language),
          text(key + ".to_do", language)};
}

Phrase phrase_of(const Fault& fault) {
  auto called = phrase(std::string("fault.") + core::name(fault.kind) + ".called");
  if (fault.detail.empty()) return called;
  return {"", "", {std::move(called), plain(": " + fault.detail)}};
}

Phrase phrase_of(ProofCause cause) { return phrase(std::string("proof_cause.") + core::name(cause)); }

}  // namespace turnpoint::core
