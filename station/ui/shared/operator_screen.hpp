#pragma once
#include <QtQml/qqmlregistration.h>
#include <QObject>
#include <QString>
#include <QVariantList>
#include <functional>
#include <string>

namespace turnpoint::ui {

/// The name of a language in this language, such as "Deutsch".
QString own_name(const std::string& language);

/// How the operator's pages look: language, light or dark theme, and size of the text. The participant's
/// pages do not depend on it, because they are part of the study. GUI thread only.
class OperatorScreen : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_SINGLETON
  /// language of everything except what the system and devices report
  Q_PROPERTY(QString language READ language WRITE set_language NOTIFY changed)
  /// The languages that the fonts of this machine can draw, as {code, name}; each is called by its own name.
  Q_PROPERTY(QVariantList languages READ languages CONSTANT)
  Q_PROPERTY(bool dark READ dark WRITE set_dark NOTIFY changed)
  Q_PROPERTY(int textPercent READ text_percent WRITE set_text_percent NOTIFY changed)  ///< 100 to 200

 public:
  /// `drawable` says whether a character can be drawn.
  explicit OperatorScreen(std::function<bool(char32_t)> drawable, QObject* parent = nullptr);
  explicit OperatorScreen(QObject* parent = nullptr);

  QString language() const { return language_; }
  QVariantList languages() const;
  bool dark() const { return dark_; }
  int text_percent() const { return text_percent_; }
  void set_language(const QString& language);
  void set_dark(bool dark);
  void set_text_percent(int percent);

  /// Reads the choices from a file, and writes every later choice to it. If the file is missing, or a value
  /// in it is not allowed, the default stays.
  void keep_in(const QString& file);

 Q_SIGNALS:
  void changed();

 private:
  void keep() const;
  bool is_drawable(const QString& language) const;

  std::function<bool(char32_t)> drawable_;

  QString file_, language_ = "en";
  bool dark_ = false;
  int text_percent_ = 100;
};

}  // namespace turnpoint::ui
