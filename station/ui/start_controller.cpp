#include "station/ui/start_controller.hpp"

#include <QLocale>
#include <utility>

namespace turnpoint::ui {

StartController::StartController(QStringList languages, QString language, QString participant, Known known,
                                 QObject* parent)
    : QObject(parent),
      languages_(std::move(languages)),
      language_(std::move(language)),
      participant_(std::move(participant)),
      known_(std::move(known)) {
  if (language_.isEmpty() && languages_.size() == 1) language_ = languages_.front();
}

StartController::Stage StartController::stage() const {
  if (language_.isEmpty() && !languages_.isEmpty()) return Stage::Language;
  return participant_.isEmpty() ? Stage::Code : Stage::Session;
}

QStringList StartController::language_names() const {
  QStringList names;
  for (const auto& code : languages_) {
    // A language is offered under the name that its own speakers give it; English ones by the plain word.
    const QString own = code == "en" ? "English" : QLocale(code).nativeLanguageName();
    names += own.isEmpty() ? code : own;
  }
  return names;
}

QString StartController::language() const {
  return language_.isEmpty() && !languages_.isEmpty() ? languages_.front() : language_;
}

void StartController::chooseLanguage(int index) {
  if (index < 0 || index >= languages_.size()) return;
  language_ = languages_[index];
  emit changed();
  begin();
}

void StartController::enterCode(const QString& code) {
  if (code.isEmpty()) return;
  participant_ = code;
  emit changed();
  begin();
}

void StartController::begin() {
  if (stage() == Stage::Session) emit ready();
}

}  // namespace turnpoint::ui
