#pragma once
#include <QObject>
#include <QQmlEngine>

#include "station/ui/shared/phrases.hpp"
#include "station/view/report_pages.hpp"

namespace turnpoint::ui {

/// The report of the finished session, for the operator. GUI thread only, except for take().
class ReportModel : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(bool ready READ ready NOTIFY changed)
  Q_PROPERTY(QString title READ title NOTIFY changed)
  /// run mode and status of the session, such as "live" and "completed"; "" if there is no report
  Q_PROPERTY(QString runMode READ run_mode NOTIFY changed)
  Q_PROPERTY(QString status READ status NOTIFY changed)
  /// The parts of the report: {heading, facts: [{label, value}], statements}, all of them phrases.
  Q_PROPERTY(QVariantList sections READ sections NOTIFY changed)
  /// Keys of the names and drawings of the existing figures.
  Q_PROPERTY(QStringList pictureNames READ picture_names NOTIFY changed)
  Q_PROPERTY(QVariantList pictures READ pictures NOTIFY changed)
  /// where the last figure was saved, or why that failed; "" if no figure was saved yet
  Q_PROPERTY(QVariant saved READ saved NOTIFY changed)
  Q_PROPERTY(bool maySave READ may_save NOTIFY changed)

 public:
  using QObject::QObject;

  /// Takes the finished report. May be called on any thread.
  void take(view::ReportPages pages);
  void clear();
  /// Sets the folder in which figures are saved. Each report gets its own folder in it.
  void save_in(const std::string& folder) { folder_ = QString::fromStdString(folder); }

  /// Saves a figure for a paper: SVG and PDF in two sizes, its data, and its caption.
  Q_INVOKABLE void save(int picture);
  QVariant saved() const { return to_variant(saved_); }
  bool may_save() const { return !folder_.isEmpty(); }

  bool ready() const { return ready_; }
  QString title() const { return QString::fromStdString(pages_.title); }
  QString run_mode() const { return QString::fromStdString(pages_.run_mode); }
  QString status() const { return QString::fromStdString(pages_.status); }
  QVariantList sections() const;
  QStringList picture_names() const;
  QVariantList pictures() const;

 Q_SIGNALS:
  void changed();

 private:
  view::ReportPages pages_;
  bool ready_ = false;
  QString folder_;
  core::Phrase saved_;
};

}  // namespace turnpoint::ui
