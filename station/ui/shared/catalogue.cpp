#include "station/ui/shared/catalogue.hpp"

#include "station/texts/texts.hpp"

namespace turnpoint::ui {

QString Catalogue::text(const QString& key, const QString& language) {
  return QString::fromStdString(texts::text(key.toStdString(), language.toStdString()));
}

}  // namespace turnpoint::ui
