#include "station/ui/platform/platform.hpp"

#include <QTemporaryFile>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "station/cli/screens.hpp"
#include "station/maintenance/doctor.hpp"
#include "station/session/places.hpp"
#include "station/ui/platform/screen.hpp"

namespace turnpoint::ui {

namespace {

/// Writes a configuration file that makes eglfs use a graphics card with a connector. (By itself, eglfs uses
/// the first card, which may have none.) Returns nothing if the user has already set one.
std::unique_ptr<QTemporaryFile> eglfs_config(const std::string& card) {
  if (qEnvironmentVariableIsSet("QT_QPA_EGLFS_KMS_CONFIG")) return nullptr;
  auto file = std::make_unique<QTemporaryFile>();
  if (!file->open())
    throw std::runtime_error("screen: cannot make a temporary file: " + file->errorString().toStdString());
  file->write(QByteArray("{\"device\": \"") + card.c_str() + "\"}\n");
  file->close();
  qputenv("QT_QPA_EGLFS_KMS_CONFIG", file->fileName().toUtf8());
  return file;
}

/// Hides the mouse pointer, which has no place on a participant's page. If the user has set Qt's environment
/// variable for it (0 shows the pointer), that setting stays.
void hide_pointer() {
  for (const char* variable : {"QT_QPA_EGLFS_HIDECURSOR", "QT_QPA_FB_HIDECURSOR"})
    if (!qEnvironmentVariableIsSet(variable)) qputenv(variable, "1");
}

/// Chooses Qt's platform plug-in. Returns a configuration file that must exist until the plug-in has started;
/// may be null.
std::unique_ptr<QTemporaryFile> choose_platform() {
  const auto wanted = qgetenv("QT_QPA_PLATFORM");
  const bool desktop = qEnvironmentVariableIsSet("DISPLAY") || qEnvironmentVariableIsSet("WAYLAND_DISPLAY");
  if (wanted.isEmpty() ? desktop : !wanted.startsWith("eglfs")) return nullptr;
  if (const auto card = session::screen_card(); !card.empty()) {
    if (wanted.isEmpty()) qputenv("QT_QPA_PLATFORM", "eglfs");
    return eglfs_config(card);
  }
  if (!wanted.isEmpty()) return nullptr;  // other plug-ins of eglfs find their screen by themselves
  if (!std::filesystem::exists("/dev/fb0"))
    throw cli::NoScreen(
        "no screen: no DISPLAY, no WAYLAND_DISPLAY, no graphics card with a connector and no /dev/fb0");
  qputenv("QT_QPA_PLATFORM", "linuxfb");
  qputenv("QT_QUICK_BACKEND", "software");
  return nullptr;
}

/// Says why Qt has no screen. Qt calls this when it gives up, which happens if no display answers.
void explain_no_screen() {
  std::string tried;
  for (const char* variable : {"QT_QPA_PLATFORM", "WAYLAND_DISPLAY", "DISPLAY"})
    if (const auto value = qgetenv(variable); !value.isEmpty())
      tried += (tried.empty() ? "" : ", ") + std::string(variable) + "=" + value.toStdString();
  std::cerr << "turnpoint: no screen: nothing answers at " << tried
            << "; name a display that runs, or unset the variable to use a screen of this machine\n";
}

/// Replaces Qt's list of plug-ins, which it prints before it aborts, by one sentence. Prints other messages
/// of Qt later, and only if Qt does not give up.
class StartMessages {
 public:
  StartMessages() : before_(qInstallMessageHandler(take)) {}
  StartMessages(const StartMessages&) = delete;
  StartMessages& operator=(const StartMessages&) = delete;
  ~StartMessages() {
    qInstallMessageHandler(before_);
    for (const auto& text : texts()) std::cerr << text << "\n";
    texts().clear();
  }

 private:
  static std::vector<std::string>& texts() {
    static std::vector<std::string> all;
    return all;
  }
  static void take(QtMsgType type, const QMessageLogContext&, const QString& text) {
    if (type != QtFatalMsg) return texts().push_back(text.toStdString());
    explain_no_screen();
    std::_Exit(2);  // end the process here, because Qt would abort it when this function returns
  }
  QtMessageHandler before_;
};

/// Reports the input devices that Qt cannot open, because Qt does not report them.
void tell_refused_input() {
  const QString platform = QGuiApplication::platformName();
  if (platform != "eglfs" && platform != "linuxfb") return;
  for (const auto& device : io::try_input_devices().refused)
    std::cerr << "input: " << device
              << "; touches and keys of this device are not received (see turnpoint doctor)\n";
}

}  // namespace

Application::Application() {
  hide_pointer();
  const auto read_at_start = choose_platform();
  qputenv("QT_QPA_NO_SIGNAL_HANDLER", "1");  // StopSignals handles the stop signals instead of Qt
  {
    const StartMessages messages;
    application_ = std::make_unique<QGuiApplication>(argc_, argv_);
  }
  tell_refused_input();
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
