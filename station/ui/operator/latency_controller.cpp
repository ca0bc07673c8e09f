#include "station/ui/operator/latency_controller.hpp"

#include "station/system/clocks.hpp"

namespace turnpoint::ui {

namespace {
/// How long to wait for the kernel's time stamp of a tap. The time stamp comes from the touch reader, which
/// may see the tap later than Qt.
constexpr int kClaim_ms = 100;
}  // namespace

LatencyController::LatencyController(rig::LatencyReference reference, QObject* parent)
    : QObject(parent), reference_(reference) {
  claim_.setSingleShot(true);
  claim_.setInterval(kClaim_ms);
  connect(&claim_, &QTimer::timeout, this, &LatencyController::claim);
}

void LatencyController::open(const rig::Rig& rig) {
  devices_ =
      std::make_unique<maintenance::LatencyDevices>(rig, [this](std::int64_t time_ns) { edge(time_ns); });
  if (devices_->has_kernel_times())
    set_kernel_time(
        [this](double x, double y, std::int64_t seen_ns) { return devices_->claim(x, y, seen_ns); });
  Q_EMIT changed();
}

void LatencyController::edge(std::int64_t time_ns) {
  QMetaObject::invokeMethod(
      this,
      [this, time_ns] {
        edges_ns_.push_back(time_ns);
        measure();
      },
      Qt::QueuedConnection);
}

void LatencyController::tap(double x, double y) {
  pending_.push_back({x, y, system::monotonic_ns()});
  claim_.start();
}

void LatencyController::claim() {
  for (const auto& touch : pending_) {
    const auto time_ns =
        kernel_time_ ? kernel_time_(touch.x, touch.y, touch.seen_ns) : std::optional(touch.seen_ns);
    if (time_ns) touches_ns_.push_back(*time_ns);
  }
  pending_.clear();
  measure();
}

void LatencyController::measure() {
  delay_ = rig::pair_delays(touches_ns_, edges_ns_, reference_);
  Q_EMIT changed();
}

void LatencyController::again() {
  touches_ns_.clear();
  edges_ns_.clear();
  measure();
}

void LatencyController::keep() {
  if (pairs() < wanted()) return;
  rig::PanelLatency panel;
  panel.quality = quality().toStdString();
  (by_button() ? panel.touch : panel.flash) = delay_;
  kept_ = panel;
  Q_EMIT finished();
}

}  // namespace turnpoint::ui

#include "moc_latency_controller.cpp"
