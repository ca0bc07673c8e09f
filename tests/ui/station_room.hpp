#pragma once
#include <QObject>
#include <QQuickWindow>
#include <QStringList>
#include <QTemporaryDir>
#include <QTimer>
#include <cstdint>
#include <memory>

#include "station/ui/operator/latency_controller.hpp"
#include "station/ui/operator/operator_controller.hpp"
#include "station/ui/platform/station_window.hpp"
#include "station/ui/shared/operator_screen.hpp"

namespace turnpoint::ui {

/// Runs the whole program for tests, with its own window, real controllers and real sessions. It runs in a
/// temporary folder with one protocol and the simulated rig. Tests read the database by exporting it.
class StationRoom : public QObject {
  Q_OBJECT
  Q_PROPERTY(QQuickItem* screen READ screen NOTIFY opened)  ///< content of the participant's window
  Q_PROPERTY(QQuickItem* second READ second NOTIFY
                 opened)  ///< content of the second screen's window; null before that window opens
  Q_PROPERTY(turnpoint::ui::PageModel* page READ page NOTIFY opened)
  Q_PROPERTY(turnpoint::ui::OperatorController* operating READ operating NOTIFY opened)
  Q_PROPERTY(turnpoint::ui::LatencyController* latency READ latency CONSTANT)
  /// How the operator's pages look. The choice is kept in the folder.
  Q_PROPERTY(turnpoint::ui::OperatorScreen* look READ look NOTIFY opened)

 public:
  explicit StationRoom(QObject* parent = nullptr);
  ~StationRoom() override;

  QQuickItem* screen() const { return station_ ? station_->window().contentItem() : nullptr; }
  QQuickItem* second() const { return second_ != nullptr ? second_->contentItem() : nullptr; }
  PageModel* page() const { return station_ ? station_->runner().bridge().page() : nullptr; }
  OperatorController* operating() const { return operating_.get(); }
  LatencyController* latency() { return &latency_; }
  OperatorScreen* look() const;

  /// Starts the program in an empty folder. `code` is the operator's code.
  Q_INVOKABLE void open(const QString& code);
  /// Changes the title of the protocol in the folder.
  Q_INVOKABLE void entitle(const QString& title);
  /// Ends the program and starts it again in the same folder.
  Q_INVOKABLE void reopen(const QString& code);
  /// Ends the program and starts it again as a locked station, in the same folder.
  Q_INVOKABLE void reopenLocked(const QString& code);
  /// Ends the program, deletes the protocol, and starts the program again.
  Q_INVOKABLE void reopenEmpty(const QString& code);
  /// Lets the latency of the touch panel be measured without a panel and without button lines.
  Q_INVOKABLE void pretendPanel(turnpoint::ui::CalibrationGuide* guide);
  Q_INVOKABLE void close();
  Q_INVOKABLE void resize(int width, int height) { station_->window().resize(width, height); }
  Q_INVOKABLE void addSecondScreen();
  /// Plugs in a USB stick "Test, 16 GB", which is simulated by folders. It is not mounted yet.
  Q_INVOKABLE void plugIn();
  /// What the program has asked udisks to do with the stick: "mount unmount power-off".
  Q_INVOKABLE QString askedUdisks() const;
  /// Files and folders in a folder of the station, sorted; those of the stick are in "stick".
  Q_INVOKABLE QStringList filesIn(const QString& folder) const;
  /// Returns the first bytes of the first file below a folder whose name has this ending.
  Q_INVOKABLE QString startOf(const QString& folder, const QString& ending, int bytes) const;
  /// Presses or releases a key of a keyboard.
  Q_INVOKABLE void pressKey(int key);
  Q_INVOKABLE void releaseKey(int key);
  /// Ends the program and starts it again as a locked station with the built-in code, which a new code
  /// replaces in the folder.
  Q_INVOKABLE void reopenBuiltIn();
  /// Writes a protocol file with two mistakes into the folder of protocols.
  Q_INVOKABLE void addMistaken();
  /// Writes rubbish over the database, or over a new file in its place.
  Q_INVOKABLE void damageDatabase();
  /// Starts the program as on a new machine: an empty folder, the shipped protocols and simulated rig, and
  /// the built-in code.
  Q_INVOKABLE void openNew();

  /// Plans two sessions for each participant, with a day between them, and stores that T1 had the first one
  /// today.
  Q_INVOKABLE void planSessions();

  /// Stores sessions of two people in two studies: P02 in bands, P01 in short, P02 in short, P01 in bands.
  Q_INVOKABLE void recordSessions();

  /// The text of a shipped protocol, and the canonical form of a protocol's text.
  Q_INVOKABLE QString shipped(const QString& protocol) const;
  Q_INVOKABLE QString canonical(const QString& text) const;

  /// Adds simulated pick-ups and force cells to the rig.
  Q_INVOKABLE void addCells();
  /// Makes the protocol guide the finger with bars and the pacer, during stimuli too. Needs cells.
  Q_INVOKABLE void addGuidance();
  /// Writes a calibration of the rig (response, friction, sound level), as `turnpoint calibrate` does.
  Q_INVOKABLE void calibrate();
  /// Simulates a press of the reference button this many milliseconds ago. If the operator accepts a latency,
  /// it is written to the calibration.
  Q_INVOKABLE void pressed(double ago_ms);
  Q_INVOKABLE double keepLatency();

  /// Runs a session of participant T1 on this rig in another process, which is killed in the third trial.
  /// Returns -9 if the process was killed, and 0 if it did not end within a minute.
  Q_INVOKABLE int cutOffSession(const QString& mode);

  /// Returns the levels, in order, of the first session of this protocol if nothing interrupts it.
  Q_INVOKABLE QStringList plannedLevels() const;

  /// lookOn() starts a timer of 60 Hz on the thread of the pages. stallsSeen() stops the timer and returns by
  /// how many refreshes this thread was late, rounded up. In these tests nothing else can delay a page.
  Q_INVOKABLE void lookOn();
  Q_INVOKABLE int stallsSeen();

  /// Presses this item, and returns the time in ms until a frame was shown. Then lifts the finger elsewhere,
  /// so that nothing is chosen. Returns -1 if the picture is the same as before.
  Q_INVOKABLE double pressUntilShown(QQuickItem* item);

  /// Blocks the pages' thread for this time, as if it hung.
  Q_INVOKABLE void block(int ms);

  /// Returns the values of the column `name` of an exported file (trials.csv, events.csv, ...), in the order
  /// of its rows. If `where` is given, only rows are included in which the column `where` has the value `is`.
  Q_INVOKABLE QStringList column(const QString& file, const QString& name, const QString& where = {},
                                 const QString& is = {}) const;

 Q_SIGNALS:
  void opened();

 private:
  enum class Begins { open, locked };
  void start(const view::OperatorCode& code, Begins begins);
  void start_with(const session::StationRequest& request, const view::OperatorCode& code);
  QStringList read(const std::string& database, const QString& file, const QString& name,
                   const QString& where, const QString& is) const;
  maintenance::DiskSources disks() const;
  std::string path(const QString& name) const { return folder_->filePath(name).toStdString(); }

  std::unique_ptr<QTemporaryDir> folder_;
  std::unique_ptr<OperatorController> operating_;
  std::unique_ptr<StationWindow> station_;
  QQuickWindow* second_ = nullptr;
  QTimer beat_;
  std::int64_t beat_ns_ = 0;
  int stalls_ = 0;
  LatencyController latency_{rig::LatencyReference::button};
};

}  // namespace turnpoint::ui
