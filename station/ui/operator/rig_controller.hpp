#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QVariantList>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/io/probe.hpp"
#include "station/session/prepare.hpp"
#include "station/session/self_test.hpp"
#include "station/ui/operator/calibration_guide.hpp"
#include "station/ui/operator/weighing.hpp"
#include "station/ui/platform/newest_job.hpp"

namespace turnpoint::ui {

/// The page about the rig: its calibration and the calibration's age, the doctor (a check of devices and
/// settings), and the self-test with its readings. The doctor and the self-test run on a separate thread, one
/// at a time, and use the devices of the rig; no session may begin meanwhile. GUI thread only.
class RigController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(QString path READ path CONSTANT)
  /// facts as {label, text, value, parts}: keys of texts for the label and for the text into which the value
  /// is put ("": the value alone), or keys of parts that are listed
  Q_PROPERTY(QVariantList calibration READ calibration NOTIFY changed)
  /// good, ageing (it expires within 14 days), bad or none
  Q_PROPERTY(QString calibrationState READ calibration_state NOTIFY changed)
  Q_PROPERTY(QString busy READ busy NOTIFY changed)  ///< doctor, self_test, weights or ""
  Q_PROPERTY(bool hasCells READ has_cells NOTIFY changed)
  /// results of a calibration of the force cells, one row for each weight; the fields are those of `checks`
  Q_PROPERTY(QVariantList weights READ weights NOTIFY changed)
  /// what the operator is asked to do with the weights, as {asked, remark, trouble, unread, converter}.
  /// `remark` says why a step is repeated, `trouble` why a reading failed, and `unread` why there is no live
  /// reading.
  Q_PROPERTY(QVariantMap step READ step NOTIFY changed)
  /// what the three cells read meanwhile, as texts; one text if they cannot be read
  Q_PROPERTY(QStringList reading READ reading NOTIFY changed)
  /// findings of the doctor as {name, status: ok | warning | failed, what, mend}
  Q_PROPERTY(QVariantList findings READ findings NOTIFY changed)
  /// checks of the self-test as {name, verdict, what, share}. The verdict is ok, failed or absent (not
  /// possible); `share` is the reading as a share of its limit, or -1 for a check without a number.
  Q_PROPERTY(QVariantList checks READ checks NOTIFY changed)
  /// what the operator has to do before the self-test or the calibration with weights goes on: press_stop,
  /// release_stop, press_button, weight, repair or ""
  Q_PROPERTY(QString asked READ asked NOTIFY changed)
  Q_PROPERTY(QString askedButton READ asked_button NOTIFY changed)
  Q_PROPERTY(QVariantList errors READ errors NOTIFY changed)
  /// the guided calibration
  Q_PROPERTY(turnpoint::ui::CalibrationGuide* guide READ guide CONSTANT)

 public:
  explicit RigController(const session::StationRequest& request, QObject* parent = nullptr);

  QString path() const { return QString::fromStdString(rig_); }
  QVariantList calibration() const { return calibration_; }
  QString calibration_state() const { return calibration_state_; }
  QString busy() const { return busy_; }
  QVariantList findings() const;
  QVariantList checks() const;
  bool has_cells() const { return has_cells_; }
  QVariantList weights() const { return weights_; }
  QVariantMap step() const { return step_; }
  QStringList reading() const { return reading_; }
  QString asked() const { return asked_; }
  QString asked_button() const { return asked_button_; }
  QVariantList errors() const { return errors_; }
  CalibrationGuide* guide() { return &guide_; }

  /// Reads the calibration again.
  Q_INVOKABLE void open();
  Q_INVOKABLE void examine();
  /// Runs the self-test, which arms the amplifier and plays quiet tones. The page therefore makes the
  /// operator hold a button to start it.
  Q_INVOKABLE void selfTest();
  /// Calibrates the force cells with dead weights. The operator replies by answer(): read, leave_out or stop.
  Q_INVOKABLE void weigh();
  Q_INVOKABLE void answer(const QString& answer);

 Q_SIGNALS:
  void changed();

 private:
  void run(const QString& what, NewestJob::Job job);
  void show(const Weighing::Shown& shown);
  void ask(const QString& what, const QString& button);

  std::string rig_, data_folder_;
  QVariantList calibration_;
  QString calibration_state_ = "none";
  QString busy_, asked_, asked_button_;
  std::vector<io::Finding> findings_;
  std::vector<session::Check> checks_;
  QVariantList errors_;
  bool has_cells_ = false;
  QVariantList weights_;
  QVariantMap step_;
  QStringList reading_;
  Weighing weighing_;
  CalibrationGuide guide_;
  NewestJob
      worker_;  // The last member, so that its thread ends before the objects that it uses are destroyed.
};

}  // namespace turnpoint::ui
