#include "tests/ui/operator_desk.hpp"

#include <QDate>
#include <QDir>
#include <QFile>
#include <chrono>

#include "station/session/planned_session.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/view/live_facts.hpp"

namespace turnpoint::ui {

OperatorDesk::OperatorDesk(SessionBridge& bridge, QObject* parent) : QObject(parent), live_(bridge) {
  const QDir shipped(TURNPOINT_SOURCE_DIR "/protocols");
  for (const auto& name : {"demo.toml", "boundary-constant.toml"})
    QFile::copy(shipped.filePath(name), folder_.filePath(name));
  QFile mistaken(folder_.filePath("mistaken.toml"));
  if (mistaken.open(QIODevice::WriteOnly)) mistaken.write("format = \"friction-protocol/1\"\nprotocl = 3\n");
  mistaken.close();
  operating_ = std::make_unique<OperatorController>(session::StationRequest{
      folder_.path().toStdString(), TURNPOINT_SOURCE_DIR "/tests/support/thin_plate.toml",
      folder_.filePath("lab.sqlite").toStdString()});
  connect(operating_.get(), &OperatorController::chosen, this, [this](const ChosenSession& session) {
    const auto& setup = session.setup;
    chosen_ = QString::fromStdString(setup.protocol.id + " " + setup.participant + " " + setup.language +
                                     " " + store::name(setup.run_mode));
    Q_EMIT chosenChanged();
  });
}

OperatorController* OperatorDesk::early() {
  if (early_) return early_.get();
  QFile::copy(TURNPOINT_SOURCE_DIR "/protocols/friction-training.toml",
              early_folder_.filePath("friction-training.toml"));
  const auto database = early_folder_.filePath("lab.sqlite").toStdString();
  core::SessionStart start;
  start.participant = "P01", start.protocol_id = "friction-training", start.planned_session = 1;
  start.run_mode = core::RunMode::pilot;
  start.station_id = store::suggested_station_name(), start.started_local = session::local_time();
  store::SessionLog::begin(database, start, {}).finish(core::SessionStatus::completed, "");
  early_ = std::make_unique<OperatorController>(session::StationRequest{
      early_folder_.path().toStdString(), TURNPOINT_SOURCE_DIR "/tests/support/thin_plate.toml", database});
  connect(early_.get(), &OperatorController::chosen, this,
          [this](const ChosenSession& session) { reason_ = QString::fromStdString(session.setup.early); });
  return early_.get();
}

QString OperatorDesk::today() const { return QDate::currentDate().toString(Qt::ISODate); }
QString OperatorDesk::tomorrow() const { return QDate::currentDate().addDays(1).toString(Qt::ISODate); }

void OperatorDesk::pressed(double ago_ms) {
  const auto now_ns = std::chrono::steady_clock::now().time_since_epoch().count();
  latency_.edge(now_ns - static_cast<std::int64_t>(ago_ms * 1e6));
}

double OperatorDesk::keptLatencyMs() const {
  const auto kept = latency_.kept();
  return kept && kept->touch ? 1e3 * kept->touch->median_s : 0;
}

void OperatorDesk::tellLive(const QString& heading, const QString& language) {
  view::LiveState state;
  state.heading = heading.toStdString();
  view::LiveTrial scored, caught;
  scored.given.correct = caught.given.correct = true;
  caught.type = core::TrialType::catch_trial;
  state.course = view::course_of({scored, caught}, language.toStdString());
  live_.take(state);
}

}  // namespace turnpoint::ui
