#pragma once
#include <QObject>
#include <QQuickWindow>
#include <QStringList>
#include <QTemporaryDir>
#include <QTimer>
#include <cstdint>
#include <memory>

#include "station/ui/latency_controller.hpp"
#include "station/ui/operator_controller.hpp"
#include "station/ui/station_window.hpp"

namespace turnpoint::ui {

/// For tests of the whole program: its own window with the real controllers and sessions behind it, in a
/// folder with one protocol and the simulated rig; the database there is read as an export has it.
class StationRoom : public QObject {
  Q_OBJECT
  Q_PROPERTY(QQuickItem* screen READ screen NOTIFY opened)  ///< what the participant's window shows
  Q_PROPERTY(QQuickItem* second READ second NOTIFY opened)  ///< the second screen's, null before
  Q_PROPERTY(turnpoint::ui::PageModel* page READ page NOTIFY opened)
  Q_PROPERTY(turnpoint::ui::OperatorController* operating READ operating NOTIFY opened)
  Q_PROPERTY(turnpoint::ui::LatencyController* latency READ latency CONSTANT)

 public:
  explicit StationRoom(QObject* parent = nullptr);
  ~StationRoom() override;

  QQuickItem* screen() const { return station_ ? station_->window().contentItem() : nullptr; }
  QQuickItem* second() const { return second_ != nullptr ? second_->contentItem() : nullptr; }
  PageModel* page() const { return station_ ? station_->runner().bridge().page() : nullptr; }
  OperatorController* operating() const { return operating_.get(); }
  LatencyController* latency() { return &latency_; }

  /// Starts the program anew in an empty folder, with this code for the operator.
  Q_INVOKABLE void open(const QString& code);
  /// Gives the folder's protocol another title.
  Q_INVOKABLE void entitle(const QString& title);
  /// Leaves it and starts it again on what is in the folder.
  Q_INVOKABLE void reopen(const QString& code);
  /// The same, locked.
  Q_INVOKABLE void reopenLocked(const QString& code);
  Q_INVOKABLE void close();
  Q_INVOKABLE void addSecondScreen();

  /// Measures the rig: response, friction, sound level; as `turnpoint calibrate` writes it.
  Q_INVOKABLE void calibrate();
  /// The reference button closed so long ago; and what was kept of the panel's latency is written.
  Q_INVOKABLE void pressed(double ago_ms);
  Q_INVOKABLE double keepLatency();

  /// A session of participant T1, on this rig, that was killed in its third trial: exit code, -9 for a
  /// kill, 0 where it did not end within a minute.
  Q_INVOKABLE int cutOffSession(const QString& mode);

  /// The levels of this protocol's first session, in order: of one that nothing interrupted.
  Q_INVOKABLE QStringList plannedLevels() const;

  /// From now on an own beat of 60 Hz on the pages' thread looks on; stallsSeen() ends that and tells how
  /// many refreshes this thread was late by, counted generously: nothing else can have delayed a page here.
  Q_INVOKABLE void lookOn();
  Q_INVOKABLE int stallsSeen();

  /// The thread of the pages does nothing for so long, as one that is hung.
  Q_INVOKABLE void block(int ms);

  /// The values of one column of an exported file (trials.csv, events.csv, ...) in the order of its rows; of
  /// those rows whose column `where` is `is`, where that is given.
  Q_INVOKABLE QStringList column(const QString& file, const QString& name, const QString& where = {},
                                 const QString& is = {}) const;

 signals:
  void opened();

 private:
  enum class Begins { open, locked };
  void start(const QString& digits, Begins begins);
  QStringList read(const std::string& database, const QString& file, const QString& name,
                   const QString& where, const QString& is) const;
  std::string path(const QString& name) const { return folder_->filePath(name).toStdString(); }

  std::unique_ptr<QTemporaryDir> folder_;
  std::unique_ptr<OperatorController> operating_;
  std::unique_ptr<StationWindow> station_;
  QQuickWindow* second_ = nullptr;
  QTimer beat_;
  std::int64_t beat_ns_ = 0;
  int stalls_ = 0;
  LatencyController latency_{calibration::LatencyReference::button};
};

}  // namespace turnpoint::ui
