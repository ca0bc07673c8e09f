#include "station/ui/operator/precision.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "station/core/number.hpp"
#include "station/rehearsal/parallel.hpp"
#include "station/rehearsal/power_figure.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/operator/figure_view.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::ui {

namespace {

/// A first look after a moment, and then numbers that can be relied on: the relative error of an SD from n
/// sessions is 1 / sqrt(2 n).
constexpr int kFirst = 20, kAll = 200;
constexpr int kResamples = 100;

QVariantMap number_of(const rehearsal::Recovery& recovery) {
  // No more digits than the spread between sessions justifies.
  const double spread = recovery.upper_quartile - recovery.lower_quartile;
  const auto shown = [spread](const std::optional<double>& value) {
    return value && std::isfinite(*value) ? QString::fromStdString(core::estimated(*value, spread))
                                          : QString();
  };
  const bool tailed = recovery.heavy_tailed;
  return {{"name", QString::fromStdString(recovery.source + ": " + recovery.parameter +
                                          (recovery.unit.empty() ? "" : " (" + recovery.unit + ")"))},
          {"truth", shown(recovery.truth)},
          {"estimate", shown(tailed ? recovery.median : recovery.mean)},
          {"spread", shown(tailed ? spread / 2 : recovery.sd)},
          {"tailed", tailed},
          {"width", shown(recovery.interval_width)},
          {"coverage",
           recovery.coverage ? QString::number(std::lround(100 * recovery.coverage->value)) : QString()}};
}

}  // namespace

Precision::Precision(QObject* parent) : QObject(parent), job_(*this) {}

void Precision::follow(const protocol::Protocol& protocol) {
  protocol_ = protocol;
  stale_ = true;
  ++draft_;
  job_.abandon();
  busy_ = false;
  if (watched_) start();
  Q_EMIT changed();
}

void Precision::forget() {
  protocol_.reset();
  power_.reset();
  figure_ = {};
  problem_ = {};
  busy_ = false;
  ++draft_;
  job_.abandon();
  Q_EMIT changed();
}

void Precision::set_watched(bool watched) {
  if (watched == watched_) return;
  watched_ = watched;
  if (watched && stale_ && protocol_) start();
  if (!watched && busy_) {
    job_.abandon();
    busy_ = false;
    stale_ = true;
  }
  Q_EMIT changed();
}

void Precision::start() {
  busy_ = true;
  stale_ = false;
  progress_ = 0;
  problem_ = {};
  job_.start(
      [this, protocol = *protocol_, draft = draft_](const std::stop_token& stop) -> std::function<void()> {
        rehearsal::PowerOptions options;
        options.replicates = kResamples;
        options.threads = std::max(1, rehearsal::processors() - 1);
        options.stop = stop;
        rehearsal::Power found;
        try {
          for (const int sessions : {kFirst, kAll}) {
            options.observers = sessions;
            options.interval_sessions = sessions / 2;
            options.progress = [this, sessions, draft](int done, int) {
              const double share = (done + (sessions == kAll ? kFirst : 0.0)) / (kFirst + kAll);
              QMetaObject::invokeMethod(
                  this,
                  [this, share, draft] {
                    if (draft != draft_ || !busy_) return;
                    progress_ = share;
                    Q_EMIT progressed();
                  },
                  Qt::QueuedConnection);
            };
            found = rehearsal::power(protocol, options);
            if (stop.stop_requested()) return {};
            QMetaObject::invokeMethod(
                this, [this, found, draft] { take(found, draft); }, Qt::QueuedConnection);
          }
        } catch (const std::exception& error) {
          return [this, problem = explanation_of(error)] {
            power_.reset();
            figure_ = {};
            problem_ = problem;
            busy_ = false;
            Q_EMIT changed();
          };
        }
        return [this] {
          busy_ = false;
          Q_EMIT changed();
        };
      });
}

void Precision::take(const rehearsal::Power& power, int draft) {
  if (draft != draft_) return;
  power_ = power;
  auto figure = rehearsal::figure_of(power, protocol_->title);
  figure.columns = 1;
  figure.caption.clear();
  figure_ = figure.charts.empty() ? QVariant() : to_variant(view::drawing_of(std::move(figure)));
  Q_EMIT changed();
}

QVariantList Precision::numbers() const {
  QVariantList list;
  if (power_)
    for (const auto& recovery : power_->recoveries)
      if (!recovery.estimates.empty()) list += number_of(recovery);
  return list;
}

}  // namespace turnpoint::ui

#include "moc_precision.cpp"
