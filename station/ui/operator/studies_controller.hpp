#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <QVariantList>
#include <vector>

#include "station/session/prepare.hpp"
#include "station/ui/operator/check_protocol.hpp"
#include "station/ui/platform/newest_job.hpp"
#include "station/view/choices.hpp"

namespace turnpoint::ui {

/// The page of studies: the protocols of the station's folder, and everything that a check of one of them
/// says. The check runs on a separate thread; choosing another protocol abandons it. GUI thread only.
class StudiesController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  /// protocols as {id, title, file, usable}
  Q_PROPERTY(QVariantList protocols READ protocols NOTIFY changed)
  Q_PROPERTY(int selected READ selected NOTIFY changed)
  Q_PROPERTY(bool checking READ checking NOTIFY changed)
  /// state of the check: checking, good, warned or bad; "" if no protocol is chosen
  Q_PROPERTY(QString verdict READ verdict NOTIFY changed)
  /// remarks of the check as {kind: problem | warning | note, file, line, what, hint}
  Q_PROPERTY(QVariantList remarks READ remarks NOTIFY changed)
  Q_PROPERTY(QVariantList facts READ facts NOTIFY changed)
  /// cues that could give the right answer away, as {name, says (the finding in words), leaks (whether it
  /// does), advice}
  Q_PROPERTY(QVariantList cues READ cues NOTIFY changed)
  Q_PROPERTY(QString folder READ folder CONSTANT)

 public:
  /// `checker` runs on the worker thread.
  explicit StudiesController(session::StationRequest request, Checker checker = check_protocol,
                             QObject* parent = nullptr);

  QVariantList protocols() const;
  int selected() const { return selected_; }
  bool checking() const { return checking_; }
  QString verdict() const;
  QVariantList remarks() const;
  QVariantList facts() const;
  QVariantList cues() const;
  QString folder() const { return QString::fromStdString(request_.protocols); }

  /// Reads the folder again, and checks the chosen protocol again, because its file may have changed.
  Q_INVOKABLE void open();
  Q_INVOKABLE void select(int index);
  /// Selects the protocol in this file, if the file is in the station's folder.
  Q_INVOKABLE void selectFile(const QString& path);
  Q_INVOKABLE QString path(int index) const;

 Q_SIGNALS:
  void changed();

 private:
  void take(view::CheckWords words);

  session::StationRequest request_;
  Checker checker_;
  std::vector<view::ProtocolEntry> protocols_;
  view::CheckWords words_;
  int selected_ = -1;
  bool checking_ = false;
  NewestJob
      worker_;  // The last member, so that its thread ends before the objects that it uses are destroyed.
};

}  // namespace turnpoint::ui
