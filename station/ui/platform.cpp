#include "station/ui/platform.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "station/ui/screen.hpp"

namespace turnpoint::ui {

namespace {

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
        "--observer sim, or --buttons-only (turnpoint preview: --out DIR)");
  }
}

}  // namespace

Application::Application() {
  choose_platform();
  qputenv("QT_QPA_NO_SIGNAL_HANDLER", "1");  // the stop signals are ours, see there
  application_ = std::make_unique<QGuiApplication>(argc_, argv_);
  set_fonts();
  watchdog_ = std::make_unique<ServiceWatchdog>();
  stop_signals_ = std::make_unique<StopSignals>();
}

QScreen& Application::screen() const {
  auto* screen = QGuiApplication::primaryScreen();
  if (screen == nullptr) throw std::runtime_error("no screen is connected");
  return *screen;
}

QScreen* Application::second_screen() const {
  const auto screens = QGuiApplication::screens();
  return screens.size() > 1 ? screens[1] : nullptr;
}

bool Application::is_bare_panel() const {
  const QString platform = QGuiApplication::platformName();
  return platform == "eglfs" || platform == "linuxfb" || screen().size().width() <= kWindow.width();
}

QSize Application::window_size() const { return kWindow.boundedTo(screen().size()); }

}  // namespace turnpoint::ui
