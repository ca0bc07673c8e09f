#include "station/ui/shared/operator_screen.hpp"

#include <QSettings>
#include <algorithm>

#include "station/core/texts.hpp"

namespace turnpoint::ui {

OperatorScreen::OperatorScreen(QObject* parent) : QObject(parent) {}

void OperatorScreen::set_language(const QString& language) {
  const auto spoken = core::languages();
  if (std::find(spoken.begin(), spoken.end(), language.toStdString()) == spoken.end()) return;
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
