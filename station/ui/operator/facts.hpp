#pragma once
#include <QStringList>
#include <QVariantList>
#include <QVariantMap>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "station/core/problem.hpp"
#include "station/core/texts.hpp"
#include "station/store/error.hpp"
#include "station/ui/shared/phrases.hpp"

namespace turnpoint::ui {

inline QVariantList to_list(const std::vector<std::pair<core::Phrase, core::Phrase>>& facts) {
  QVariantList list;
  for (const auto& [label, value] : facts)
    list += QVariantMap{{"label", to_variant(label)}, {"value", to_variant(value)}};
  return list;
}

/// Converts (label, value) pairs to a list of {label, value} for QML.
inline QVariantList to_list(const std::vector<std::pair<std::string, std::string>>& facts) {
  QVariantList list;
  for (const auto& [label, value] : facts)
    list += QVariantMap{{"label", QString::fromStdString(label)}, {"value", QString::fromStdString(value)}};
  return list;
}

inline QVariantList to_list(const std::vector<core::Phrase>& phrases) {
  QVariantList list;
  for (const auto& phrase : phrases) list += to_variant(phrase);
  return list;
}

inline QStringList to_list(const std::vector<std::string>& texts) {
  QStringList list;
  for (const auto& text : texts) list += QString::fromStdString(text);
  return list;
}

/// Returns what an error says: each problem of a file, or the error's message. The message of a database is
/// English, so before it stands what kind of error it is, in the language of the screen.
inline std::vector<core::Phrase> phrases_of(const std::exception& error) {
  if (const auto* store = dynamic_cast<const store::StoreError*>(&error))
    return {core::phrase(std::string("store_error.") + store::error_name(store->kind())),
            core::plain(store->what())};
  const auto* bad = dynamic_cast<const core::BadInput*>(&error);
  if (bad == nullptr) return {core::phrase_of(error)};
  std::vector<core::Phrase> phrases;
  for (const auto& problem : bad->problems()) phrases.push_back(phrase_of(problem));
  return phrases;
}

/// Joins phrases, each on a line of its own.
inline core::Phrase in_lines(const std::vector<core::Phrase>& phrases) {
  if (phrases.size() == 1) return phrases.front();
  core::Phrase lines;
  for (const auto& one : phrases) {
    if (!lines.values.empty()) lines.values.push_back(core::plain("\n"));
    lines.values.push_back(one);
  }
  return lines;
}

/// Returns everything that an error says as one phrase, each problem of a file on a line of its own.
inline core::Phrase explanation_of(const std::exception& error) { return in_lines(phrases_of(error)); }

}  // namespace turnpoint::ui
