#pragma once
#include <QVariant>

#include "station/core/texts.hpp"

namespace turnpoint::ui {

/// Converts a phrase for QML, where Texts.say() says it: to a string if it is the same in every language,
/// otherwise to {key, values}; the key "" stands for values that are said one after another.
inline QVariant to_variant(const core::Phrase& phrase) {
  const auto words = QString::fromStdString(phrase.words);
  if (phrase.key.empty() && phrase.values.empty()) return words;
  QVariantList values;
  if (!words.isEmpty()) values += words;
  for (const auto& value : phrase.values) values += to_variant(value);
  return QVariantMap{{"key", QString::fromStdString(phrase.key)}, {"values", values}};
}

}  // namespace turnpoint::ui
