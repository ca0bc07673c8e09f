#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QString>

namespace turnpoint::ui {

/// Gives pages the station's own texts, from core::text(), and says how texts of a language are shown.
class Catalogue : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_SINGLETON

  /// language of the texts on the screen, which decides `family`
  Q_PROPERTY(QString shown MEMBER shown_ NOTIFY shownChanged)
  /// The font family of all texts on the screen. Chinese, Japanese and Korean share characters that each
  /// language draws in its own way, so each of them needs its own family. For other scripts, the
  /// application's fonts replace one another where a glyph is missing.
  Q_PROPERTY(QString family READ family NOTIFY shownChanged)

 public:
  Q_INVOKABLE static QString text(const QString& key, const QString& language);
  /// Says whether a language is written from right to left.
  Q_INVOKABLE static bool mirrored(const QString& language);
  /// Returns a day such as 2026-11-24 as the language writes it, with the day of the week. Its digits are
  /// 0 to 9, like those of all other numbers on the pages.
  Q_INVOKABLE static QString day(const QString& day, const QString& language);
  QString family() const;

 Q_SIGNALS:
  void shownChanged();

 private:
  QString shown_;
};

}  // namespace turnpoint::ui
