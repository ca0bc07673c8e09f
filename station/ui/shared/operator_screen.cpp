#include "station/ui/shared/operator_screen.hpp"

#include <QLocale>
#include <QSettings>
#include <algorithm>
#include <utility>

#include "station/core/texts.hpp"
#include "station/system/fonts.hpp"

namespace turnpoint::ui {

QString own_name(const std::string& language) {
  if (language == "en") return "English";  // Qt names the largest country, too
  if (language == "es") return "Español";
  const auto name = QLocale(QString::fromStdString(language)).nativeLanguageName();
  return name.left(1).toUpper() + name.mid(1);
}

OperatorScreen::OperatorScreen(std::function<bool(char32_t)> drawable, QObject* parent)
    : QObject(parent), drawable_(std::move(drawable)) {}

OperatorScreen::OperatorScreen(QObject* parent) : OperatorScreen(system::drawable, parent) {}

/// A font for a language has the letters of the language's own name. Every font has those of Europe, up to
/// U+024F.
bool OperatorScreen::is_drawable(const QString& language) const {
  const auto letters = own_name(language.toStdString()).toStdU32String();
  return std::all_of(letters.begin(), letters.end(),
                     [this](char32_t letter) { return letter <= 0x24F || drawable_(letter); });
}

QVariantList OperatorScreen::languages() const {
  QVariantList list;
  for (const auto& code : core::languages())
    if (const auto language = QString::fromStdString(code); is_drawable(language))
      list += QVariantMap{{"code", language}, {"name", own_name(code)}};
  return list;
}

void OperatorScreen::set_language(const QString& language) {
  const auto spoken = core::languages();
  if (std::find(spoken.begin(), spoken.end(), language.toStdString()) == spoken.end()) return;
  if (!is_drawable(language)) return;
  language_ = language;
  keep();
  Q_EMIT changed();
}

void OperatorScreen::set_dark(bool dark) {
  dark_ = dark;
  keep();
  Q_EMIT changed();
}

void OperatorScreen::set_text_percent(int percent) {
  text_percent_ = std::clamp(percent, 100, 200);
  keep();
  Q_EMIT changed();
}

void OperatorScreen::keep_in(const QString& file) {
  file_.clear();
  const QSettings settings(file, QSettings::IniFormat);
  set_language(settings.value("language", language_).toString());
  set_dark(settings.value("dark", dark_).toBool());
  const int percent = settings.value("text_percent", text_percent_).toInt();
  if (percent >= 100 && percent <= 200) set_text_percent(percent);
  file_ = file;
}

void OperatorScreen::keep() const {
  if (file_.isEmpty()) return;
  QSettings settings(file_, QSettings::IniFormat);
  settings.setValue("language", language_);
  settings.setValue("dark", dark_);
  settings.setValue("text_percent", text_percent_);
}

}  // namespace turnpoint::ui

#include "moc_operator_screen.cpp"
