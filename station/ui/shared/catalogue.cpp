#include "station/ui/shared/catalogue.hpp"

#include <QDate>
#include <QLocale>

#include "station/core/texts.hpp"

namespace turnpoint::ui {

QString Catalogue::text(const QString& key, const QString& language) {
  return QString::fromStdString(core::text(key.toStdString(), language.toStdString()));
}

bool Catalogue::mirrored(const QString& language) {
  return QLocale(language).textDirection() == Qt::RightToLeft;
}

QString Catalogue::day(const QString& day, const QString& language) {
  auto said = QLocale(language).toString(QDate::fromString(day, Qt::ISODate), QLocale::LongFormat);
  for (auto& sign : said)
    if (sign.isDigit()) sign = QChar('0' + sign.digitValue());
  return said;
}

QString Catalogue::family() const {
  const QLocale locale(shown_);
  if (locale.language() == QLocale::Korean) return "Noto Sans CJK KR";
  if (locale.language() != QLocale::Chinese) return "Inter";
  if (locale.script() != QLocale::TraditionalHanScript) return "Noto Sans CJK SC";
  return locale.territory() == QLocale::HongKong ? "Noto Sans CJK HK" : "Noto Sans CJK TC";
}

}  // namespace turnpoint::ui

#include "moc_catalogue.cpp"
