#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>

namespace turnpoint::ui {

/// Gives pages the station's own texts, from texts::text().
class Catalogue : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_SINGLETON

 public:
  Q_INVOKABLE static QString text(const QString& key, const QString& language);
};

}  // namespace turnpoint::ui
