#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <functional>

namespace turnpoint::ui {

/// Asks on the screen for what is missing before a session can begin: the language, if the protocol has
/// several and none was given; consent, if the study has a consent form; the participant's code, if none was
/// given. If there is an operator's page, it comes first. GUI thread only.
class StartController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(Stage stage READ stage NOTIFY changed)
  Q_PROPERTY(QStringList languageNames READ language_names NOTIFY changed)
  Q_PROPERTY(QString language READ language NOTIFY changed)
  Q_PROPERTY(QString participant READ participant NOTIFY changed)
  Q_PROPERTY(QString consentVersion READ consent_version NOTIFY changed)
  Q_PROPERTY(QString runMode READ run_mode NOTIFY changed)

 public:
  enum class Stage { Operator, Language, Consent, Code, Session };
  Q_ENUM(Stage)
  /// Returns true for a participant code that is already in the database.
  using Known = std::function<bool(const QString& code)>;

  /// What to ask the participant. The language and the participant's code are asked for if they are "",
  /// consent if its version is not "".
  struct Questions {
    QStringList languages;
    QString language, participant, consent_version;
    QString run_mode;  ///< live | pilot | simulated; shown on these pages as on the session's pages
  };

  explicit StartController(Known known, QObject* parent = nullptr);

  /// Goes back to the operator's page.
  void await_operator();
  /// Asks the questions. Emits ready() when all are answered, which may be at once.
  void ask(Questions questions);

  Stage stage() const;
  QStringList language_names() const;
  /// The chosen language. Until one is chosen, the first language of the protocol.
  QString language() const;
  QString participant() const { return questions_.participant; }
  QString consent_version() const { return questions_.consent_version; }
  QString run_mode() const { return questions_.run_mode; }

  Q_INVOKABLE void chooseLanguage(int index);
  Q_INVOKABLE bool isKnown(const QString& code) const { return known_(code); }
  Q_INVOKABLE void consent();
  /// Call this if the participant does not consent, or when the last page is left.
  Q_INVOKABLE void close() { Q_EMIT closed(); }
  /// Goes back to the previous question. Returns false if this is the first one.
  Q_INVOKABLE bool back();
  Q_INVOKABLE void enterCode(const QString& code);

 Q_SIGNALS:
  void changed();
  /// Emitted when everything has been answered and the session may begin.
  void ready();
  /// Emitted when these pages are no longer needed.
  void closed();

 private:
  void proceed();

  Questions questions_, asked_;  ///< the questions with the answers so far filled in, and as they were asked
  Known known_;
  bool with_operator_ = true, consented_ = false;
};

}  // namespace turnpoint::ui
