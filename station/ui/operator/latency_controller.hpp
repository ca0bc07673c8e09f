#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QString>
#include <QTimer>
#include <QVariant>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "station/maintenance/panel_latency.hpp"

namespace turnpoint::ui {

/// Measures a touch panel's latency. The page flashes at each tap. The reference time comes from a button
/// under the finger, or from a photodiode on the flashing square. GUI thread only, except for edge().
class LatencyController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(bool byButton READ by_button CONSTANT)
  Q_PROPERTY(int taps READ taps NOTIFY changed)
  Q_PROPERTY(int edges READ edges NOTIFY changed)
  Q_PROPERTY(int pairs READ pairs NOTIFY changed)
  /// smallest number of pairs (a tap and an edge of the reference line) for which a result may be accepted
  Q_PROPERTY(int wanted READ wanted CONSTANT)
  /// median and jitter (SD) in ms, and the number of taps without an edge; undefined with fewer than two
  /// pairs
  Q_PROPERTY(QVariant medianMs READ median_ms NOTIFY changed)
  Q_PROPERTY(double jitterMs READ jitter_ms NOTIFY changed)
  Q_PROPERTY(int unmatched READ unmatched NOTIFY changed)
  /// where the time stamps of taps come from: kernel or toolkit
  Q_PROPERTY(QString quality READ quality NOTIFY changed)

 public:
  using KernelTime = std::function<std::optional<std::int64_t>(double x, double y, std::int64_t seen_ns)>;

  explicit LatencyController(rig::LatencyReference reference, QObject* parent = nullptr);

  /// Opens the rig's touch panel and its button lines, one of which gives the reference time. Throws the
  /// errors of maintenance::LatencyDevices.
  void open(const rig::Rig& rig);

  /// From now on, the time of a tap is the kernel's time stamp. A tap without one is ignored.
  void set_kernel_time(KernelTime kernel_time) { kernel_time_ = std::move(kernel_time); }

  /// Adds an edge of the reference line. May be called on any thread.
  void edge(std::int64_t time_ns);

  bool by_button() const { return reference_ == rig::LatencyReference::button; }
  int taps() const { return static_cast<int>(touches_ns_.size()); }
  int edges() const { return static_cast<int>(edges_ns_.size()); }
  int pairs() const { return delay_ ? delay_->pairs : 0; }
  static int wanted() { return rig::kLeastPairs; }
  QVariant median_ms() const { return delay_ ? QVariant(1e3 * delay_->median_s) : QVariant(); }
  double jitter_ms() const { return delay_ ? 1e3 * delay_->sd_s : 0; }
  int unmatched() const { return delay_ ? delay_->unmatched : 0; }
  QString quality() const { return kernel_time_ ? "kernel" : "toolkit"; }

  /// Reports that a finger came down at (x, y). Both run from 0 to 1 across the window.
  Q_INVOKABLE void tap(double x, double y);
  Q_INVOKABLE void again();
  /// Accepts the current result at the operator's request. Does nothing with fewer pairs than `wanted`.
  Q_INVOKABLE void keep();
  std::optional<rig::PanelLatency> kept() const { return kept_; }

 Q_SIGNALS:
  void changed();
  /// Emitted when the page is finished.
  void finished();

 private:
  struct Pending {
    double x = 0, y = 0;
    std::int64_t seen_ns = 0;
  };
  void claim();
  void measure();

  rig::LatencyReference reference_;
  KernelTime kernel_time_;
  std::vector<Pending> pending_;
  QTimer claim_;
  std::vector<std::int64_t> touches_ns_, edges_ns_;
  std::optional<rig::Delay> delay_;
  std::optional<rig::PanelLatency> kept_;
  // The last member, so that its threads end before the objects that they use are destroyed.
  std::unique_ptr<maintenance::LatencyDevices> devices_;
};

}  // namespace turnpoint::ui
