#pragma once
#include <QStringList>
#include <QVariantList>
#include <QVariantMap>
#include <string>
#include <utility>
#include <vector>

namespace turnpoint::ui {

/// Converts (label, value) pairs to a list of {label, value} for QML.
inline QVariantList to_list(const std::vector<std::pair<std::string, std::string>>& facts) {
  QVariantList list;
  for (const auto& [label, value] : facts)
    list += QVariantMap{{"label", QString::fromStdString(label)}, {"value", QString::fromStdString(value)}};
  return list;
}

inline QStringList to_list(const std::vector<std::string>& texts) {
  QStringList list;
  for (const auto& text : texts) list += QString::fromStdString(text);
  return list;
}

}  // namespace turnpoint::ui
