#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QString>

namespace turnpoint::ui {

/// A participant's code as it is typed on the station's own keypad: capital letters, digits and '-', up to
/// `maximumLength`, beginning with a letter or digit. Never a name.
class ParticipantCode : public QObject {
  Q_OBJECT
  QML_ELEMENT
  Q_PROPERTY(QString text READ text NOTIFY changed)
  Q_PROPERTY(bool valid READ valid NOTIFY changed)
  Q_PROPERTY(int maximumLength READ maximum_length CONSTANT)

 public:
  using QObject::QObject;
  QString text() const { return text_; }
  bool valid() const { return !text_.isEmpty(); }
  int maximum_length() const { return 8; }

  /// Appends one character if it is allowed; ignores anything else.
  Q_INVOKABLE void type(const QString& character);
  Q_INVOKABLE void erase();
  Q_INVOKABLE void clear();

 Q_SIGNALS:
  void changed();

 private:
  QString text_;
};

}  // namespace turnpoint::ui
