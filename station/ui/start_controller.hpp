#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <functional>

namespace turnpoint::ui {

/// What has to be asked on the screen before a session can begin: the language where the protocol has several
/// and none was given, then the participant's code where none was given. GUI thread only.
class StartController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(Stage stage READ stage NOTIFY changed)
  Q_PROPERTY(QStringList languageNames READ language_names CONSTANT)
  Q_PROPERTY(QString language READ language NOTIFY changed)
  Q_PROPERTY(QString participant READ participant NOTIFY changed)

 public:
  enum class Stage { Language, Code, Session };
  Q_ENUM(Stage)
  /// True for a participant code that the database has seen.
  using Known = std::function<bool(const QString& code)>;

  /// `language` and `participant` as given on the command line, "" to ask.
  StartController(QStringList languages, QString language, QString participant, Known known,
                  QObject* parent = nullptr);

  Stage stage() const;
  QStringList language_names() const;
  /// The language chosen; until then the protocol's first.
  QString language() const;
  QString participant() const { return participant_; }

  Q_INVOKABLE void chooseLanguage(int index);
  Q_INVOKABLE bool isKnown(const QString& code) const { return known_(code); }
  Q_INVOKABLE void enterCode(const QString& code);
  /// Emits ready() if nothing is left to ask; for the program, once its window is there.
  void begin();

 signals:
  void changed();
  /// Everything has been asked: the session may begin.
  void ready();

 private:
  QStringList languages_;
  QString language_, participant_;
  Known known_;
};

}  // namespace turnpoint::ui
