#include "station/ui/station_window.hpp"

#include <QGuiApplication>
#include <QQmlApplicationEngine>
#include <QQuickWindow>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "station/app/touch.hpp"
#include "station/ui/screen.hpp"
#include "station/ui/session_bridge.hpp"
#include "station/ui/start_controller.hpp"

namespace turnpoint::ui {

namespace {

std::int64_t now_ns() {
  // steady_clock is CLOCK_MONOTONIC here, the clock of every time stamp.
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

/// Stands in for a code that the keypad will ask for, so that everything else is checked before a window
/// opens.
constexpr const char* kCodeToCome = "keypad";

/// The window where there is a desktop around it.
constexpr QSize kWindow{1280, 800};

class StationWindow : public QObject {
 public:
  StationWindow(session::Setup setup, bool ask_language, bool ask_code)
      : setup_(std::move(setup)),
        bridge_(now_ns, [this](session::Input input) { inputs_.push(std::move(input)); }),
        start_(ask_language ? languages() : QStringList(),
               ask_language ? QString() : QString::fromStdString(setup_.language),
               ask_code ? QString() : QString::fromStdString(setup_.participant),
               [](const QString&) { return false; }) {
    connect(
        &start_, &StartController::ready, this, [this] { begin(); }, Qt::SingleShotConnection);
  }

  ~StationWindow() override {
    if (session_.joinable()) ask_to_stop();
  }

  session::Summary run() {
    open();
    start_.begin();
    QGuiApplication::exec();
    ask_to_stop();
    if (session_.joinable()) session_.join();
    if (failure_) std::rethrow_exception(failure_);
    if (!summary_)
      throw std::runtime_error("the window was closed before the session began; nothing was recorded");
    return *summary_;
  }

 private:
  QStringList languages() const {
    QStringList list;
    for (const auto& language : setup_.protocol.languages) list += QString::fromStdString(language);
    return list;
  }

  void open() {
    const QScreen* screen = QGuiApplication::primaryScreen();
    if (screen == nullptr) throw std::runtime_error("no screen is connected");
    engine_.addImportPath("qrc:/qt/qml");
    engine_.setInitialProperties({{"bridge", QVariant::fromValue(&bridge_)},
                                  {"start", QVariant::fromValue(&start_)},
                                  {"pixelsPerMm", pixels_per_mm(*screen)},
                                  {"width", std::min(kWindow.width(), screen->size().width())},
                                  {"height", std::min(kWindow.height(), screen->size().height())}});
    engine_.load(QUrl("qrc:/qt/qml/Turnpoint/Main.qml"));
    if (engine_.rootObjects().isEmpty()) throw std::runtime_error("the pages of the touchscreen do not load");
    auto* window = qobject_cast<QQuickWindow*>(engine_.rootObjects().first());
    bridge_.watch(window);
    open_touch();
    connect(window, SIGNAL(sessionClosed()), window, SLOT(close()));
    if (is_bare_panel(*screen)) window->showFullScreen();
  }

  /// Kernel times for touches, where the rig names its panel.
  void open_touch() {
    touch_ = app::open_touch(setup_.rig, [this](panel::TouchPanelState state) {
      if (state == panel::TouchPanelState::back) return;
      session::Input input;
      input.time_ns = now_ns();
      input.kind = session::InputKind::fault;
      input.fault = session::FaultKind::touch_gone;
      input.text = "the touch panel is gone";
      inputs_.push(std::move(input));
    });
    if (!touch_) return;
    bridge_.set_kernel_time(
        [this](double x, double y, std::int64_t seen_ns) { return touch_->claim(x, y, seen_ns); });
  }

  /// A panel of the station's own, or one too small for a window beside others.
  static bool is_bare_panel(const QScreen& screen) {
    const QString platform = QGuiApplication::platformName();
    return platform == "eglfs" || platform == "linuxfb" || screen.size().width() <= kWindow.width();
  }

  void begin() {
    setup_.participant = start_.participant().toStdString();
    setup_.language = start_.language().toStdString();
    session_ = std::jthread([this] {
      try {
        summary_ = session::run(setup_, &bridge_, inputs_);
      } catch (...) {
        failure_ = std::current_exception();
        show_failure();
      }
      over_ = true;
    });
  }

  /// Session thread: says on the screen what ended the session, since nobody may be looking at a terminal.
  void show_failure() {
    session::Page page;
    page.kind = session::PageKind::failed;
    page.language = setup_.language;
    page.run_mode = store::name(setup_.run_mode);
    try {
      std::rethrow_exception(failure_);
    } catch (const std::exception& error) {
      page.text = error.what();
    }
    bridge_.show(page);
  }

  void ask_to_stop() {
    if (over_) return;
    session::Input input;
    input.time_ns = now_ns();
    input.kind = session::InputKind::stop;
    inputs_.push(std::move(input));
  }

  session::Setup setup_;
  session::Inputs inputs_;
  SessionBridge bridge_;
  StartController start_;
  QQmlApplicationEngine engine_;
  std::unique_ptr<panel::TouchReader> touch_;
  std::optional<session::Summary> summary_;
  std::exception_ptr failure_;
  std::atomic<bool> over_ = false;
  std::jthread session_;  // last: joined before anything that it uses goes
};

/// Qt ends the process where it finds no screen; this finds out before, and picks a back end for bare panels.
void choose_platform() {
  if (qEnvironmentVariableIsSet("QT_QPA_PLATFORM") || qEnvironmentVariableIsSet("DISPLAY") ||
      qEnvironmentVariableIsSet("WAYLAND_DISPLAY"))
    return;
  if (std::filesystem::exists("/dev/dri/card0")) {
    qputenv("QT_QPA_PLATFORM", "eglfs");
  } else if (std::filesystem::exists("/dev/fb0")) {
    qputenv("QT_QPA_PLATFORM", "linuxfb");
    qputenv("QT_QUICK_BACKEND", "software");
  } else {
    throw std::invalid_argument(
        "no screen: neither DISPLAY, WAYLAND_DISPLAY, /dev/dri/card0 nor /dev/fb0 is there; give --headless "
        "--observer sim, or --buttons-only");
  }
}

}  // namespace

session::Summary run_on_screen(app::RunRequest request, std::optional<session::Setup> prepared) {
  const bool ask_code = !prepared && request.participant.empty();
  if (ask_code) request.participant = kCodeToCome;
  auto setup = prepared ? std::move(*prepared) : app::prepare(request);
  const bool ask_language = !prepared && request.language.empty() && setup.protocol.languages.size() > 1;
  choose_platform();
  static int argc = 1;
  static char name[] = "turnpoint-ui";
  static char* argv[] = {name, nullptr};
  QGuiApplication application(argc, argv);
  set_fonts();
  StationWindow window(std::move(setup), ask_language, ask_code);
  return window.run();
}

}  // namespace turnpoint::ui
