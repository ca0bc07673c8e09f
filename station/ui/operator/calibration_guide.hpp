#pragma once
#include <QElapsedTimer>
#include <QObject>
#include <QQmlEngine>
#include <QTimer>
#include <QVariantList>
#include <QVariantMap>
#include <optional>
#include <string>
#include <vector>

#include "station/maintenance/guided_series.hpp"
#include "station/ui/platform/newest_job.hpp"

namespace turnpoint::ui {

/// Leads an operator through the measurements of a calibration. Each measurement is a series of points: the
/// station plays a tone, the operator reads an instrument or the edge of the sand, and enters the reading.
/// The calibration is written when the series is finished. GUI thread only.
class CalibrationGuide : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  /// series as {name, measured}; the names are response, boundaries, friction and sound
  Q_PROPERTY(QVariantList series READ series NOTIFY changed)
  Q_PROPERTY(QString chosen READ chosen NOTIFY changed)  ///< name of the series that is measured; may be ""
  Q_PROPERTY(int at READ at NOTIFY changed)              ///< number of the point, from 0
  Q_PROPERTY(int count READ count NOTIFY changed)
  Q_PROPERTY(int entered READ entered NOTIFY changed)  ///< number of points with a value
  /// the point as {transducer, kHz, um, percent, value, phase}; value and phase are "" before they are
  /// entered
  Q_PROPERTY(QVariantMap point READ point NOTIFY changed)
  Q_PROPERTY(bool real READ real NOTIFY changed)  ///< whether a tone arms an amplifier
  Q_PROPERTY(bool playing READ playing NOTIFY changed)
  Q_PROPERTY(bool mayPlay READ may_play NOTIFY changed)
  Q_PROPERTY(double remainingSeconds READ remaining_s NOTIFY ticked)  ///< of the tone
  Q_PROPERTY(bool mayFinish READ may_finish NOTIFY changed)
  /// outline of the rig's surface: {lengthMm, wideHalfWidthMm, narrowHalfWidthMm, wideEndLeft}
  Q_PROPERTY(QVariantMap surface READ surface NOTIFY changed)
  Q_PROPERTY(QString problem READ problem NOTIFY changed)
  /// after a series: the name of the calibration file, and the figure with readings, fit and residuals
  Q_PROPERTY(QString file READ file NOTIFY changed)
  Q_PROPERTY(QVariant figure READ figure NOTIFY changed)

 public:
  explicit CalibrationGuide(std::string rig, QObject* parent = nullptr);

  QVariantList series() const;
  QString chosen() const;
  int at() const { return at_; }
  int count() const { return static_cast<int>(points_.size()); }
  int entered() const;
  QVariantMap point() const;
  bool real() const { return real_; }
  bool playing() const { return playing_; }
  bool may_play() const { return !points_.empty() && !playing_ && !rest_.isActive(); }
  double remaining_s() const;
  bool may_finish() const;
  QVariantMap surface() const { return surface_; }
  QString problem() const { return problem_; }
  QString file() const { return file_; }
  QVariant figure() const { return figure_; }

  /// Begins a series with its first point.
  Q_INVOKABLE void begin(const QString& series);
  Q_INVOKABLE void play();
  Q_INVOKABLE void stop();
  /// Enters what was read, and the phase of a response. Returns false, with `problem`, for what cannot be.
  Q_INVOKABLE bool enter(const QString& typed);
  Q_INVOKABLE bool enterPhase(const QString& typed);
  Q_INVOKABLE void show(int point);
  Q_INVOKABLE void finish();
  /// Leaves the series; readings that were not finished are forgotten.
  Q_INVOKABLE void leave();

 Q_SIGNALS:
  void changed();
  void ticked();
  void finished();

 private:
  bool refuse(const QString& problem);

  std::string path_;
  std::optional<rig::Rig> rig_;  ///< with its calibration, for the tones
  std::optional<maintenance::Series> chosen_;
  std::vector<maintenance::SeriesPoint> points_;
  int at_ = 0;
  bool real_ = false, playing_ = false;
  QElapsedTimer begun_;
  QTimer tick_, rest_;
  QVariantMap surface_;
  QString problem_, file_;
  QVariant figure_;
  // The last member, so that its thread ends before the objects that it uses are destroyed.
  NewestJob job_;
};

}  // namespace turnpoint::ui
