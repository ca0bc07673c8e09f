#include "tests/ui/operator_gallery.hpp"
#include "tests/support/simulated_run.hpp"

#include <QTemporaryDir>
#include <cmath>
#include <condition_variable>
#include <mutex>

#include "station/session/planned_session.hpp"
#include "station/session/prepare.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/view/report_data.hpp"

namespace turnpoint::ui {

namespace {

session::RunRequest request_for(const std::string& protocol, const std::string& database) {
  auto request = simulated_run(TURNPOINT_SOURCE_DIR "/protocols/" + protocol + ".toml", database, 20261121);
  request.participant = "P03";
  return request;
}

/// Passes the session's first trials on to another monitor, then ends the session.
struct FirstTrials : session::Monitor {
  session::Monitor& to;
  int left;
  FirstTrials(session::Monitor& monitor, int trials) : to(monitor), left(trials) {}
  void trial_begins(const trial::TrialSpec& spec, const protocol::Block& block,
                    const session::PlanAhead::Plans& plans) override {
    to.trial_begins(spec, block, plans);
    if (left == 0) throw std::runtime_error("enough");
  }
  void trial_ended(const trial::TrialSpec& spec, const core::TrialRow& row) override {
    --left;
    to.trial_ended(spec, row);
  }
};

void run_first(const session::RunRequest& request, session::Monitor& monitor, int trials) {
  session::Inputs inputs;
  FirstTrials first(monitor, trials);
  try {
    session::run(session::prepare(request), nullptr, inputs, &first);
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

view::LiveState live_exhibit(const std::string& protocol, int trials, const std::string& language) {
  const QTemporaryDir folder;
  const auto request = request_for(protocol, folder.filePath("a.sqlite").toStdString());
  const auto setup = session::prepare(request);
  std::mutex mutex;
  std::condition_variable told;
  view::LiveState state;
  int news = 0;
  view::LiveView view(
      setup.protocol, setup.rig,
      [&](view::LiveState next) {
        const std::lock_guard lock(mutex);
        state = std::move(next);
        ++news;
        told.notify_one();
      },
      language);
  run_first(request, view, trials);
  std::unique_lock lock(mutex);
  told.wait(lock, [&] { return news == 2 * trials + 1; });
  return state;
}

view::ReportPages report_exhibit(const std::string& protocol, const std::string& language) {
  const QTemporaryDir folder;
  const auto database = folder.filePath("a.sqlite").toStdString();
  session::Inputs inputs;
  const auto summary = session::run(session::prepare(request_for(protocol, database)), nullptr, inputs);
  return view::report_pages(database, summary.session_id, language);
}

view::ReportPages forces_exhibit(const std::string& protocol, const std::string& language) {
  const QTemporaryDir folder;
  const auto database = folder.filePath("a.sqlite").toStdString();
  session::Inputs inputs;
  const auto session = session::run(session::prepare(request_for(protocol, database)), nullptr, inputs);
  auto data = view::report_data(database, session.session_id).front();
  data.language = language;
  for (const auto& trial : data.trials) {
    const double wave = std::sin(2.1 * trial.trial_index), other = std::cos(1.3 * trial.trial_index);
    const bool fast = trial.instruction == "speed";
    const double planned_mm = 150 + 40 * trial.level.value_or(0);
    data.finger.push_back({trial.trial_index, trial.instruction, true, (fast ? 0.42 : 0.55) + 0.06 * wave,
                           (fast ? 118 : 82) + 12 * other, 0.35 + 0.03 * wave, 0.8 + 0.05 * other, planned_mm,
                           planned_mm + 0.4 * wave - 0.3 * other, 0.4});
  }
  return view::report_pages(report::summarise(data));
}

std::string interrupted_exhibit(const std::string& folder) {
  auto request = request_for("boundary-constant", folder + "/lab.sqlite");
  session::Monitor nobody;
  run_first(request, nobody, 7);
  return request.database;
}

std::string today_exhibit(const std::string& folder) {
  const auto path = folder + "/today.sqlite";
  core::SessionStart today;
  today.participant = "P01", today.protocol_id = "friction-training", today.planned_session = 1;
  today.run_mode = core::RunMode::pilot;
  today.station_id = store::suggested_station_name(), today.started_local = session::local_time();
  store::SessionLog::begin(path, today, {}).finish(core::SessionStatus::completed, "");
  return path;
}

}  // namespace turnpoint::ui
