#include "station/ui/operator/calibration_guide.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <sstream>
#include <utility>

#include "station/core/number.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/maintenance/play_armed.hpp"
#include "station/rig/apply.hpp"
#include "station/rig/calibration.hpp"
#include "station/session/prepare.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/operator/figure_view.hpp"
#include "station/view/preview.hpp"
#include "station/view/scene_figures.hpp"

namespace turnpoint::ui {

namespace {

using maintenance::Series;

constexpr std::pair<Series, const char*> kSeries[] = {{Series::response, "response"},
                                                      {Series::boundaries, "boundaries"},
                                                      {Series::friction, "friction"},
                                                      {Series::sound, "sound"}};
/// What the touch panel's latency is measured against.
constexpr std::pair<rig::LatencyReference, const char*> kPanel[] = {
    {rig::LatencyReference::button, "panel_button"}, {rig::LatencyReference::photodiode, "panel_photodiode"}};
constexpr int kTick_ms = 100;

bool has(const rig::Calibration& made, Series series) {
  switch (series) {
    case Series::response:
      return !made.transducers.empty();
    case Series::boundaries:
      return made.boundary.has_value();
    case Series::friction:
      return made.friction.has_value();
    case Series::sound:
      return !made.sound.empty();
  }
  return false;
}

QString shown(const std::optional<double>& value) {
  return value ? QString::fromStdString(core::number(*value, 5)) : QString();
}

/// A number as people type it, also with a decimal comma.
std::optional<double> number_in(QString typed) {
  bool fine = false;
  const double value = typed.trimmed().replace(',', '.').toDouble(&fine);
  return fine && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

CalibrationGuide::CalibrationGuide(std::string rig, QObject* parent)
    : QObject(parent), path_(std::move(rig)), job_(*this) {
  tick_.setInterval(kTick_ms);
  connect(&tick_, &QTimer::timeout, this, &CalibrationGuide::ticked);
  rest_.setSingleShot(true);
  connect(&rest_, &QTimer::timeout, this, &CalibrationGuide::changed);
}

// There may be no event loop any more that would delete it, and its threads must end.
CalibrationGuide::~CalibrationGuide() { delete latency_.release(); }

QVariantList CalibrationGuide::series() const {
  std::optional<rig::Calibration> made;
  try {
    if (const auto newest = rig::newest_for(path_); !newest.empty()) made = rig::load_calibration(newest);
  } catch (const std::exception&) {
    // the page says elsewhere that the calibration cannot be read
  }
  QVariantList list;
  for (const auto& [series, name] : kSeries)
    list += QVariantMap{{"name", name}, {"measured", made.has_value() && has(*made, series)}};
  for (const auto& [reference, name] : kPanel) {
    const auto panel = made ? made->panel : std::nullopt;
    const bool by_button = reference == rig::LatencyReference::button;
    const bool measured = panel && (by_button ? panel->touch : panel->flash);
    list += QVariantMap{{"name", name}, {"measured", measured}};
  }
  return list;
}

QString CalibrationGuide::chosen() const {
  const auto found = std::find_if(std::begin(kSeries), std::end(kSeries),
                                  [&](const auto& one) { return one.first == chosen_; });
  return found == std::end(kSeries) ? QString() : found->second;
}

bool CalibrationGuide::refuse(const core::Phrase& problem) {
  problem_ = problem;
  Q_EMIT changed();
  return false;
}

void CalibrationGuide::begin_latency(rig::LatencyReference reference) {
  leave();
  try {
    latency_.reset(new LatencyController(reference));
    open_panel_(*latency_, rig::load(path_));
    connect(latency_.get(), &LatencyController::finished, this, &CalibrationGuide::keep_latency);
  } catch (const std::exception& error) {
    latency_.reset();
    problem_ = explanation_of(error);
  }
  Q_EMIT changed();
}

void CalibrationGuide::keep_latency() {
  try {
    file_ = QString::fromStdString(maintenance::keep_panel(rig::load(path_), latency_->kept().value()));
  } catch (const std::exception& error) {
    problem_ = explanation_of(error);
  }
  latency_.reset();
  Q_EMIT changed();
  Q_EMIT finished();
}

void CalibrationGuide::begin(const QString& series) {
  for (const auto& [reference, name] : kPanel)
    if (series == name && !playing_) return begin_latency(reference);
  const auto found = std::find_if(std::begin(kSeries), std::end(kSeries),
                                  [&](const auto& one) { return series == one.second; });
  if (found == std::end(kSeries) || playing_) return;
  leave();
  try {
    std::ostringstream messages;  // the page says elsewhere which calibration is used
    rig_ = session::calibrated_rig(path_, "", messages);
    points_ = maintenance::series_points(*rig_, found->first);
    chosen_ = found->first;
    real_ = maintenance::can_be_felt(*rig_);
    surface_ = {rig::outline_of(*rig_)};
  } catch (const std::exception& error) {
    problem_ = explanation_of(error);
  }
  Q_EMIT changed();
}

void CalibrationGuide::play() {
  if (!may_play()) return;
  playing_ = true;
  problem_ = {};
  take({});
  begun_.start();
  tick_.start();
  Q_EMIT changed();
  job_.start([this, rig = *rig_, point = points_[static_cast<std::size_t>(at_)]](
                 const std::stop_token& stop) -> std::function<void()> {
    core::Phrase problem;
    try {
      maintenance::play_point(rig, point, stop,
                              [this](const std::vector<maintenance::ToneReading>& readings) {
                                QMetaObject::invokeMethod(
                                    this, [this, readings] { take(readings); }, Qt::QueuedConnection);
                              });
    } catch (const std::exception& error) {
      problem = explanation_of(error);
    }
    return [this, problem, rest_s = maintenance::rest_after_tone_s(rig)] {
      playing_ = false;
      problem_ = problem;
      tick_.stop();
      if (real_) rest_.start(static_cast<int>(1e3 * rest_s));
      Q_EMIT changed();
    };
  });
}

void CalibrationGuide::take(const std::vector<maintenance::ToneReading>& readings) {
  readings_.clear();
  for (const auto& reading : readings)
    readings_ += QVariantMap{
        {"channel", reading.channel},
        {"um", reading.displacement_um ? QString::fromStdString(core::number(*reading.displacement_um, 3))
                                       : QString()},
        {"percent", 100 * reading.amplitude}};
  Q_EMIT read();
}

void CalibrationGuide::stop() {
  if (playing_) job_.stop();
}

double CalibrationGuide::remaining_s() const {
  if (!playing_ || !rig_) return 0;
  return std::max(0.0, maintenance::tone_length_s(*rig_) - 1e-3 * static_cast<double>(begun_.elapsed()));
}

bool CalibrationGuide::enter(const QString& typed) {
  if (points_.empty()) return false;
  auto& point = points_[static_cast<std::size_t>(at_)];
  const auto value = number_in(typed);
  const auto [low, high] = maintenance::possible_values(*rig_, *chosen_);
  if (!typed.trimmed().isEmpty() && (!value || *value < low || *value > high))
    return refuse(core::plain(QString("%1 … %2").arg(low).arg(high).toStdString()));
  point.value = value;
  problem_ = {};
  Q_EMIT changed();
  return true;
}

bool CalibrationGuide::enterPhase(const QString& typed) {
  if (points_.empty()) return false;
  const auto value = number_in(typed);
  if (!value || std::abs(*value) > 360) return refuse(core::plain("-360 … 360"));
  points_[static_cast<std::size_t>(at_)].phase_deg = value;
  problem_ = {};
  Q_EMIT changed();
  return true;
}

void CalibrationGuide::show(int point) {
  if (playing_ || point < 0 || point >= count()) return;
  at_ = point;
  problem_ = {};
  take({});
  Q_EMIT changed();
}

int CalibrationGuide::entered() const {
  return static_cast<int>(std::count_if(points_.begin(), points_.end(),
                                        [](const auto& point) { return point.value.has_value(); }));
}

bool CalibrationGuide::may_finish() const {
  return chosen_ && !playing_ && entered() >= maintenance::least_points(*chosen_);
}

QVariantMap CalibrationGuide::point() const {
  if (points_.empty()) return {};
  const auto& point = points_[static_cast<std::size_t>(at_)];
  return {{"transducer", QString::fromStdString(point.transducer)},
          {"kHz", QString::number(1e-3 * point.frequency_Hz, 'f', 2)},
          {"um", QString::fromStdString(core::number(point.displacement_um, 3))},
          {"percent", QString::fromStdString(core::number(100 * point.full_scale, 3))},
          {"value", shown(point.value)},
          {"phase", shown(point.phase_deg)}};
}

void CalibrationGuide::finish() {
  if (!may_finish()) return;
  try {
    // the fit begins from the rig file, as `turnpoint calibrate` does
    const auto result = maintenance::finish_series(rig::load(path_), *chosen_, points_);
    file_ = QString::fromStdString(result.file);
    figure_ = to_variant(view::drawing_of(result.figure));
    chosen_.reset();
    points_.clear();
    at_ = 0;
    problem_ = {};
  } catch (const std::exception& error) {
    refuse(explanation_of(error));
    return;
  }
  Q_EMIT changed();
  Q_EMIT finished();
}

void CalibrationGuide::leave() {
  stop();
  chosen_.reset();
  latency_.reset();
  points_.clear();
  at_ = 0;
  take({});
  problem_ = {}, file_.clear();
  figure_ = {};
  Q_EMIT changed();
}

}  // namespace turnpoint::ui

#include "moc_calibration_guide.cpp"
