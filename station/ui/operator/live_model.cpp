#include "station/ui/operator/live_model.hpp"

#include <utility>

#include "station/ui/operator/facts.hpp"

namespace turnpoint::ui {

LiveModel::LiveModel(SessionBridge& bridge, QObject* parent) : QObject(parent), bridge_(bridge) {
  connect(bridge_.page(), &PageModel::changed, this, &LiveModel::hold_or_show);
}

void LiveModel::take(view::LiveState state) {
  QMetaObject::invokeMethod(
      this,
      [this, state = std::move(state)]() mutable {
        waiting_ = std::move(state);
        hold_or_show();
      },
      Qt::QueuedConnection);
}

void LiveModel::take(std::optional<view::FingerGauges> gauges) {
  QMetaObject::invokeMethod(
      this,
      [this, gauges = std::move(gauges)]() mutable {
        gauges_ = std::move(gauges);
        Q_EMIT gaugesMoved();
      },
      Qt::QueuedConnection);
}

void LiveModel::hold_or_show() {
  const auto kind = bridge_.page()->kind();
  const bool hold = kind == PageModel::Kind::Stimulus || kind == PageModel::Kind::Pause ||
                    kind == PageModel::Kind::Response || kind == PageModel::Kind::Adjust;
  if (hold != held_) {
    held_ = hold;
    Q_EMIT heldChanged();
  }
  if (!waiting_ || (held_ && kind != PageModel::Kind::Adjust)) return;
  state_.heading = waiting_->heading;
  state_.scene = waiting_->scene;
  state_.course = waiting_->course;
  state_.limits = waiting_->limits;
  state_.sensors = waiting_->sensors;
  Q_EMIT wordsChanged();
  if (held_) return;
  state_ = std::move(*waiting_);
  waiting_.reset();
  Q_EMIT picturesChanged();
}

namespace {

QList<double> gauge_of(const view::Gauge& gauge) { return {gauge.value.value_or(-1), gauge.low, gauge.high}; }

}  // namespace

QList<double> LiveModel::force_gauge() const { return gauges_ ? gauge_of(gauges_->force) : QList<double>{}; }
QList<double> LiveModel::speed_gauge() const { return gauges_ ? gauge_of(gauges_->speed) : QList<double>{}; }
QList<double> LiveModel::position_gauge() const {
  return gauges_ ? gauge_of(gauges_->position) : QList<double>{};
}
QStringList LiveModel::gauge_figures() const {
  if (!gauges_) return {"", "", ""};
  return {QString::fromStdString(gauges_->force.figure), QString::fromStdString(gauges_->speed.figure),
          QString::fromStdString(gauges_->position.figure)};
}

QVariantList LiveModel::scene() const { return to_list(state_.scene); }
QVariantList LiveModel::course() const { return to_list(state_.course); }
QVariantList LiveModel::limits() const { return to_list(state_.limits); }
QVariantList LiveModel::sensors() const { return to_list(state_.sensors); }
QVariantList LiveModel::surfaces() const {
  QVariantList list;
  for (const auto& surface : state_.surfaces) list += to_variant(surface);
  return list;
}

}  // namespace turnpoint::ui

#include "moc_live_model.cpp"
