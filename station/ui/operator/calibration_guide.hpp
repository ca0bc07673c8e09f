#pragma once
#include <QElapsedTimer>
#include <QObject>
#include <QQmlEngine>
#include <QScopedPointer>
#include <QTimer>
#include <QVariantList>
#include <QVariantMap>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/maintenance/guided_series.hpp"
#include "station/ui/operator/latency_controller.hpp"
#include "station/ui/participant/surface_drawing.hpp"
#include "station/ui/platform/newest_job.hpp"
#include "station/ui/shared/phrases.hpp"

namespace turnpoint::ui {

/// Leads an operator through the measurements of a calibration. Each measurement is a series of points: the
/// station plays a tone, the operator reads an instrument or the edge of the sand, and enters the reading.
/// The calibration is written when the series is finished. GUI thread only.
class CalibrationGuide : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  /// measurements as {name, measured}: the series response, boundaries, friction and sound, and the latency
  /// of the touch panel against a button (panel_button) and against a photodiode (panel_photodiode)
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
  /// what the pick-ups read of the tone that plays or played last, as {channel, um, percent}: the
  /// displacement,
  /// "" without a calibrated scale, and the share of the converter's full scale
  Q_PROPERTY(QVariantList readings READ readings NOTIFY read)
  Q_PROPERTY(double remainingSeconds READ remaining_s NOTIFY ticked)  ///< of the tone
  Q_PROPERTY(bool mayFinish READ may_finish NOTIFY changed)
  /// outline of the rig's surface
  Q_PROPERTY(turnpoint::ui::SurfaceOutline surface READ surface NOTIFY changed)
  /// the measurement of the touch panel's latency; null unless one is going on
  Q_PROPERTY(turnpoint::ui::LatencyController* latency READ latency NOTIFY changed)
  Q_PROPERTY(QVariant problem READ problem NOTIFY changed)
  /// after a series: the name of the calibration file, and the figure with readings, fit and residuals
  Q_PROPERTY(QString file READ file NOTIFY changed)
  Q_PROPERTY(QVariant figure READ figure NOTIFY changed)

 public:
  /// Opens the devices for measuring the panel's latency. Throws the errors of LatencyController::open().
  using OpenPanel = std::function<void(LatencyController&, const rig::Rig&)>;

  explicit CalibrationGuide(std::string rig, QObject* parent = nullptr);
  ~CalibrationGuide() override;
  /// Replaces the rig's panel and button lines; for tests.
  void open_panel_with(OpenPanel open_panel) { open_panel_ = std::move(open_panel); }

  QVariantList series() const;
  QString chosen() const;
  int at() const { return at_; }
  int count() const { return static_cast<int>(points_.size()); }
  int entered() const;
  QVariantMap point() const;
  bool real() const { return real_; }
  bool playing() const { return playing_; }
  bool may_play() const { return !points_.empty() && !playing_ && !rest_.isActive(); }
  QVariantList readings() const { return readings_; }
  double remaining_s() const;
  bool may_finish() const;
  SurfaceOutline surface() const { return surface_; }
  LatencyController* latency() const { return latency_.get(); }
  QVariant problem() const { return to_variant(problem_); }
  QString file() const { return file_; }
  QVariant figure() const { return figure_; }

  /// Begins a series with its first point, or a measurement of the panel's latency, which needs the rig's
  /// button lines: no session can run meanwhile.
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
  void read();
  void ticked();
  void finished();

 private:
  void take(const std::vector<maintenance::ToneReading>& readings);
  bool refuse(const core::Phrase& problem);
  void begin_latency(rig::LatencyReference reference);
  void keep_latency();

  std::string path_;
  OpenPanel open_panel_ = &LatencyController::open;
  std::optional<rig::Rig> rig_;  ///< with its calibration, for the tones
  std::optional<maintenance::Series> chosen_;
  std::vector<maintenance::SeriesPoint> points_;
  int at_ = 0;
  bool real_ = false, playing_ = false;
  QElapsedTimer begun_;
  QTimer tick_, rest_;
  SurfaceOutline surface_;
  QVariantList readings_;
  /// Deleted by the event loop, because it ends its own measurement by a signal.
  std::unique_ptr<LatencyController, QScopedPointerDeleteLater> latency_;
  core::Phrase problem_;
  QString file_;
  QVariant figure_;
  // The last member, so that its thread ends before the objects that it uses are destroyed.
  NewestJob job_;
};

}  // namespace turnpoint::ui
