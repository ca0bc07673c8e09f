#include "station/ui/participant/start_controller.hpp"

#include <QLocale>
#include <utility>

namespace turnpoint::ui {

StartController::StartController(Known known, QObject* parent) : QObject(parent), known_(std::move(known)) {}

void StartController::await_operator() {
  with_operator_ = true;
  questions_ = {};
  Q_EMIT changed();
}

void StartController::ask(Questions questions) {
  questions_ = std::move(questions);
  if (questions_.language.isEmpty() && questions_.languages.size() == 1)
    questions_.language = questions_.languages.front();
  with_operator_ = consented_ = false;
  asked_ = questions_;
  proceed();
}

StartController::Stage StartController::stage() const {
  if (with_operator_) return Stage::Operator;
  if (questions_.language.isEmpty() && !questions_.languages.isEmpty()) return Stage::Language;
  if (!questions_.consent_version.isEmpty() && !consented_) return Stage::Consent;
  return questions_.participant.isEmpty() ? Stage::Code : Stage::Session;
}

QStringList StartController::language_names() const {
  QStringList names;
  for (const auto& code : questions_.languages) {
    // Show each language under its own name. If the locale names no country, Qt takes the largest one and
    // writes "American English" and "español de España", so use shorter names for these two.
    const QLocale locale(code);
    const QString own = code == "en" ? "English" : code == "es" ? "Español" : locale.nativeLanguageName();
    names += own.isEmpty() ? code : locale.toUpper(own.left(1)) + own.mid(1);
  }
  return names;
}

QString StartController::language() const {
  const auto& languages = questions_.languages;
  return questions_.language.isEmpty() && !languages.isEmpty() ? languages.front() : questions_.language;
}

void StartController::chooseLanguage(int index) {
  if (index < 0 || index >= questions_.languages.size()) return;
  questions_.language = questions_.languages[index];
  proceed();
}

void StartController::consent() {
  consented_ = true;
  proceed();
}

bool StartController::back() {
  if (std::exchange(consented_, false)) {
    Q_EMIT changed();
    return true;
  }
  if (questions_.language == asked_.language) return false;
  questions_.language = asked_.language;
  Q_EMIT changed();
  return true;
}

void StartController::enterCode(const QString& code) {
  if (code.isEmpty()) return;
  questions_.participant = code;
  proceed();
}

void StartController::proceed() {
  Q_EMIT changed();
  if (stage() == Stage::Session) Q_EMIT ready();
}

}  // namespace turnpoint::ui

#include "moc_start_controller.cpp"
