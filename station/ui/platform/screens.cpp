#include "station/ui/platform/screens.hpp"

#include <QQmlApplicationEngine>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "station/core/toml.hpp"
#include "station/session/places.hpp"
#include "station/store/error.hpp"
#include "station/ui/operator/design_controller.hpp"
#include "station/ui/operator/latency_controller.hpp"
#include "station/ui/operator/operator_controller.hpp"
#include "station/ui/operator/preview_controller.hpp"
#include "station/ui/platform/load_page.hpp"
#include "station/ui/platform/platform.hpp"
#include "station/ui/platform/screen.hpp"
#include "station/ui/platform/station_window.hpp"

namespace turnpoint::ui {

namespace {

StationWindow::Place place_on(const Application& application, bool fullscreen) {
  return {pixels_per_mm(application.screen()), application.window_size(),
          fullscreen || application.is_bare_panel(), panel_rotation_deg()};
}

/// Makes a stop signal end the event loop, from the moment at which the window shows its first page. Before
/// that, a stop signal kills the process.
void stop_in_order(const Application& application, const QQuickWindow& window) {
  auto& stop = application.stop_signals();
  QObject::connect(
      &window, &QQuickWindow::frameSwapped, &stop, [&stop] { stop.take_over(); },
      static_cast<Qt::ConnectionType>(Qt::AutoConnection | Qt::SingleShotConnection));
}

/// Like the function above, but a stop signal already ends the event loop from the beginning of a session,
/// even if no page has been shown yet.
void stop_in_order(const Application& application, StationWindow& window) {
  application.stop_signals().say_if_held_up(window.runner().kept());
  stop_in_order(application, window.window());
  QObject::connect(&window, &StationWindow::beginning, &application.stop_signals(), &StopSignals::take_over);
}

void use_second_screen(const Application& application, StationWindow& window) {
  if (auto* second = application.second_screen()) window.show_live_window(*second);
}

/// Shows a window with one page and its controller until somebody closes it.
void show_until_closed(const Application& application, const QString& page, const QVariant& controller) {
  QQmlApplicationEngine engine;
  auto& window = load_page(engine, page,
                           {{"controller", controller},
                            {"pixelsPerMm", pixels_per_mm(application.screen())},
                            {"turned", panel_rotation_deg()},
                            {"width", application.window_size().width()},
                            {"height", application.window_size().height()}});
  if (application.is_bare_panel()) window.showFullScreen();
  stop_in_order(application, window);
  QGuiApplication::exec();
}

}  // namespace

session::Summary run_on_screen(session::RunRequest request, std::optional<session::Setup> prepared) {
  ChosenSession chosen;
  chosen.ask_code = !prepared && request.participant.empty();
  if (chosen.ask_code) request.participant = session::kCodeToCome;
  chosen.setup = prepared ? std::move(*prepared) : session::prepare(request);
  chosen.ask_language = !prepared && request.language.empty() && chosen.setup.protocol.languages.size() > 1;
  chosen.arm = true;  // starting a session from the command line is the operator's request to arm
  const Application application;
  StationWindow window(place_on(application, request.fullscreen), {nullptr, view::operator_code()},
                       chosen.setup.database);
  use_second_screen(application, window);
  stop_in_order(application, window);
  window.ask(chosen);
  const auto summary = window.run();
  if (!summary)
    throw std::runtime_error("the program was closed before a session began; nothing was recorded");
  return *summary;
}

void run_station(const session::StationRequest& request) {
  const Application application;
  OperatorController operating(request, check_protocol, OperatorController::Checks::when_allowed);
  StationWindow window(place_on(application, request.fullscreen),
                       {&operating, view::operator_code(), request.locked}, request.database);
  QObject::connect(&window.window(), &QQuickWindow::frameSwapped, &operating,
                   &OperatorController::allow_checks,
                   static_cast<Qt::ConnectionType>(Qt::QueuedConnection | Qt::SingleShotConnection));
  use_second_screen(application, window);
  stop_in_order(application, window);
  try {
    window.run();
  } catch (const store::StoreError& error) {
    // The program has been asked to quit: the screen is gone before anybody could have read it.
    std::cerr << "turnpoint: " << error.what() << "\n";
  } catch (const std::exception&) {
    // The screen has already shown why the session failed, so do not report the failure again.
  }
}

void show_preview(const view::PreviewRequest& request) {
  const Application application;
  PreviewController controller(request);
  show_until_closed(application, "PreviewWindow.qml", QVariant::fromValue(&controller));
}

void show_design(const cli::DesignRequest& request) {
  const std::filesystem::path file = request.file;
  const bool exists = !request.file.empty() && std::filesystem::exists(file);
  if (exists)
    core::read_text_file(request.file);  // throws, before a window opens, if it is not a readable text file
  const Application application;
  DesignController controller({file.parent_path().string(), request.rig, session::shipped("protocols")});
  if (exists) {
    if (!controller.open(QString::fromStdString(request.file)))
      throw std::runtime_error(core::say(controller.trouble_phrase(), "en"));
  } else {
    controller.startNew();
    controller.suggest(QString::fromStdString(file.stem().string()));
  }
  show_until_closed(application, "DesignWindow.qml", QVariant::fromValue(&controller));
}

std::optional<rig::PanelLatency> measure_latency(const maintenance::LatencyRequest& request) {
  const Application application;
  LatencyController controller(request.reference);
  controller.open(rig::load(request.rig));
  show_until_closed(application, "LatencyWindow.qml", QVariant::fromValue(&controller));
  return controller.kept();
}

}  // namespace turnpoint::ui
