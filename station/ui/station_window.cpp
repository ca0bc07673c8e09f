#include "station/ui/station_window.hpp"

#include <time.h>
#include <unistd.h>
#include <QLoggingCategory>
#include <QQmlApplicationEngine>
#include <QQuickWindow>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "station/ui/latency_controller.hpp"
#include "station/ui/operator_controller.hpp"
#include "station/ui/platform.hpp"
#include "station/ui/preview_controller.hpp"
#include "station/ui/screen.hpp"
#include "station/ui/session_runner.hpp"
#include "station/ui/start_controller.hpp"

namespace turnpoint::ui {

namespace {

/// Stands in for a code that the keypad will ask for, so that everything else is checked before a window
/// opens.
constexpr const char* kCodeToCome = "keypad";

/// `QT_LOGGING_RULES=turnpoint.startup=true` says how long the first page took.
Q_LOGGING_CATEGORY(startup, "turnpoint.startup", QtWarningMsg)

/// Milliseconds since the kernel started this process, to its 10 ms.
double process_age_ms() {
  std::ifstream stat("/proc/self/stat");
  const std::string line{std::istreambuf_iterator<char>(stat), {}};
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) fields >> field;  // 22: start time in ticks since boot
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  const double started_s = std::stod(field) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  return 1e3 * (static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) - started_s);
}

void tell_first_page(QQuickWindow& window) {
  if (!startup().isInfoEnabled()) return;
  QObject::connect(
      &window, &QQuickWindow::frameSwapped, &window,
      [] { qCInfo(startup) << "first page after" << process_age_ms() << "ms"; },
      static_cast<Qt::ConnectionType>(Qt::DirectConnection | Qt::SingleShotConnection));
}

QQuickWindow& load(QQmlApplicationEngine& engine, const QString& page, const QVariantMap& properties) {
  engine.addImportPath("qrc:/qt/qml");
  engine.setInitialProperties(properties);
  engine.load(QUrl("qrc:/qt/qml/Turnpoint/" + page));
  auto* window =
      engine.rootObjects().isEmpty() ? nullptr : qobject_cast<QQuickWindow*>(engine.rootObjects().first());
  if (window == nullptr)
    throw std::runtime_error("the pages of the touchscreen do not load: " + page.toStdString());
  return *window;
}

/// The station's one window: the participant's pages, before them the operator's where there is one.
class StationWindow : public QObject {
 public:
  StationWindow(const Application& application, OperatorController* operating, const std::string& database,
                const std::string& operator_code)
      : operating_(operating), start_([database](const QString& code) { return is_known(database, code); }) {
    connect(&start_, &StartController::ready, this, [this] { begin(); });
    connect(&start_, &StartController::closed, this, [this] { close(); });
    if (operating_ != nullptr)
      connect(operating_, &OperatorController::chosen, this,
              [this](const ChosenSession& chosen) { ask(chosen); });
    window_ = &load(engine_, "Main.qml",
                    {{"bridge", QVariant::fromValue(&runner_.bridge())},
                     {"start", QVariant::fromValue(&start_)},
                     {"live", QVariant::fromValue(&runner_.live())},
                     {"report", QVariant::fromValue(&runner_.report())},
                     {"operating", QVariant::fromValue(operating_)},
                     {"operatorCode", QString::fromStdString(operator_code)},
                     {"pixelsPerMm", pixels_per_mm(application.screen())},
                     {"width", application.window_size().width()},
                     {"height", application.window_size().height()}});
    tell_first_page(*window_);
    runner_.watch(window_);
    if (application.is_bare_panel()) window_->showFullScreen();
    if (auto* second = application.second_screen()) show_live_window(*second);
  }

  /// Asks the participant what is open, then runs the session.
  void ask(const ChosenSession& chosen) {
    setup_ = chosen.setup;
    arm_ = chosen.arm;
    StartController::Questions questions;
    questions.run_mode = store::name(setup_.run_mode);
    if (!chosen.ask_language) questions.language = QString::fromStdString(setup_.language);
    for (const auto& language : setup_.protocol.languages)
      if (chosen.ask_language) questions.languages += QString::fromStdString(language);
    if (!chosen.ask_code) questions.participant = QString::fromStdString(setup_.participant);
    // Who goes on with a session has consented when it began.
    if (setup_.resume_session.empty())
      questions.consent_version = QString::fromStdString(setup_.consent_version);
    start_.ask(std::move(questions));
  }

  /// Until the window is closed.
  std::optional<session::Summary> run() {
    QGuiApplication::exec();
    return runner_.finish();
  }

 private:
  static bool is_known(const std::string& database, const QString& code) {
    const auto known = app::known_participants(database);
    return std::find(known.begin(), known.end(), code.toStdString()) != known.end();
  }

  void show_live_window(QScreen& screen) {
    auto& window = load(live_engine_, "LiveWindow.qml",
                        {{"live", QVariant::fromValue(&runner_.live())},
                         {"bridge", QVariant::fromValue(&runner_.bridge())},
                         {"pixelsPerMm", pixels_per_mm(screen)}});
    window.setScreen(&screen);
    window.showFullScreen();
  }

  void begin() {
    setup_.participant = start_.participant().toStdString();
    if (!start_.language().isEmpty()) setup_.language = start_.language().toStdString();
    runner_.begin(setup_);
    if (arm_) runner_.bridge().arm();
  }

  void close() {
    if (operating_ == nullptr) return void(window_->close());
    if (runner_.running()) return;
    start_.await_operator();
    operating_->refresh();
  }

  OperatorController* operating_;
  session::Setup setup_;
  bool arm_ = false;
  SessionRunner runner_;
  StartController start_;
  QQmlApplicationEngine engine_, live_engine_;
  QQuickWindow* window_ = nullptr;
};

}  // namespace

session::Summary run_on_screen(app::RunRequest request, std::optional<session::Setup> prepared) {
  ChosenSession chosen;
  chosen.ask_code = !prepared && request.participant.empty();
  if (chosen.ask_code) request.participant = kCodeToCome;
  chosen.setup = prepared ? std::move(*prepared) : app::prepare(request);
  chosen.ask_language = !prepared && request.language.empty() && chosen.setup.protocol.languages.size() > 1;
  chosen.arm = true;  // the command was the operator's
  const Application application;
  StationWindow window(application, nullptr, chosen.setup.database, request.operator_code);
  window.ask(chosen);
  const auto summary = window.run();
  if (!summary)
    throw std::runtime_error("the window was closed before the session began; nothing was recorded");
  return *summary;
}

void run_station(const app::StationRequest& request) {
  const Application application;
  OperatorController operating(request);
  StationWindow window(application, &operating, request.database, request.operator_code);
  try {
    window.run();
  } catch (const std::exception&) {
    // What ended a session stood on the screen; leaving the station afterwards is no failure.
  }
}

void show_preview(const app::PreviewRequest& request) {
  const Application application;
  PreviewController controller(request);
  QQmlApplicationEngine engine;
  auto& window = load(engine, "PreviewWindow.qml",
                      {{"controller", QVariant::fromValue(&controller)},
                       {"pixelsPerMm", pixels_per_mm(application.screen())},
                       {"width", application.window_size().width()},
                       {"height", application.window_size().height()}});
  if (application.is_bare_panel()) window.showFullScreen();
  QGuiApplication::exec();
}

std::optional<calibration::PanelLatency> measure_latency(const app::LatencyRequest& request) {
  const Application application;
  LatencyController controller(request.reference);
  app::LatencyDevices devices(rig::load(request.rig),
                              [&controller](std::int64_t time_ns) { controller.edge(time_ns); });
  if (devices.has_kernel_times())
    controller.set_kernel_time(
        [&devices](double x, double y, std::int64_t seen_ns) { return devices.claim(x, y, seen_ns); });
  QQmlApplicationEngine engine;
  auto& window = load(engine, "LatencyWindow.qml",
                      {{"controller", QVariant::fromValue(&controller)},
                       {"pixelsPerMm", pixels_per_mm(application.screen())},
                       {"width", application.window_size().width()},
                       {"height", application.window_size().height()}});
  if (application.is_bare_panel()) window.showFullScreen();
  QGuiApplication::exec();
  return controller.kept();
}

}  // namespace turnpoint::ui
