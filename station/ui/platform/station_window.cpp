#include "station/ui/platform/station_window.hpp"

#include <QGuiApplication>
#include <QScreen>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "station/protocol/glyphs.hpp"
#include "station/session/places.hpp"
#include "station/system/fonts.hpp"
#include "station/ui/platform/first_page.hpp"
#include "station/ui/platform/load_page.hpp"
#include "station/ui/platform/screen.hpp"
#include "station/ui/shared/operator_screen.hpp"

namespace turnpoint::ui {

namespace {

/// False also if the database cannot be read: that is said when the session begins, and to the operator.
bool is_known(const std::string& database, const QString& code) {
  try {
    const auto known = view::known_participants(database);
    return std::find(known.begin(), known.end(), code.toStdString()) != known.end();
  } catch (const std::exception&) {
    return false;
  }
}

/// Keeps the operator's choices of language, theme and text size in a file beside the database.
OperatorScreen* keep_screen_beside(QQmlEngine& engine, const std::string& database) {
  auto* screen = engine.singletonInstance<OperatorScreen*>(qmlTypeId("Turnpoint", 1, 0, "OperatorScreen"));
  if (screen == nullptr) throw std::logic_error("the module Turnpoint has no OperatorScreen");
  screen->keep_in(QString::fromStdString(std::filesystem::absolute(database).parent_path() / "screen.ini"));
  return screen;
}

}  // namespace

StationWindow::StationWindow(const Place& place, const Operator& allowed, const std::string& database)
    : operating_(allowed.page),
      start_([database](const QString& code) { return is_known(database, code); }),
      lock_(allowed.code) {
  lock_.store_in(allowed.code_file);
  connect(&start_, &StartController::ready, this, &StationWindow::begin);
  connect(&start_, &StartController::closed, this, &StationWindow::close);
  if (operating_ != nullptr) {
    const auto& request = operating_->request();
    studies_ = std::make_unique<StudiesController>(request);
    sessions_ = std::make_unique<SessionsController>(request, allowed.disks);
    rig_ = std::make_unique<RigController>(request);
    design_ = std::make_unique<DesignController>(
        DesignPlace{view::folder_for_studies(request.protocols, request.database), request.rig,
                    session::shipped("protocols")});
    connect(operating_, &OperatorController::chosen, this, &StationWindow::ask);
  }
  window_ = &load_page(engine_, "Main.qml",
                       {{"bridge", QVariant::fromValue(&runner_.bridge())},
                        {"start", QVariant::fromValue(&start_)},
                        {"live", QVariant::fromValue(&runner_.live())},
                        {"report", QVariant::fromValue(&runner_.report())},
                        {"operating", QVariant::fromValue(operating_)},
                        {"studies", QVariant::fromValue(studies_.get())},
                        {"sessions", QVariant::fromValue(sessions_.get())},
                        {"rig", QVariant::fromValue(rig_.get())},
                        {"design", QVariant::fromValue(design_.get())},
                        {"operatorLock", QVariant::fromValue(&lock_)},
                        {"locked", allowed.locked},
                        {"pixelsPerMm", place.pixels_per_mm},
                        {"turned", place.rotation_deg},
                        {"width", place.size.width()},
                        {"height", place.size.height()}});
  look_ = keep_screen_beside(engine_, database);
  tell_first_page(*window_);
  runner_.watch(window_);
  if (place.bare_panel) window_->showFullScreen();
}

void StationWindow::ask(const ChosenSession& chosen) {
  setup_ = chosen.setup;
  arm_ = chosen.arm;
  StartController::Questions questions;
  questions.run_mode = store::name(setup_.run_mode);
  if (!chosen.ask_language) questions.language = QString::fromStdString(setup_.language);
  if (chosen.ask_language)
    for (const auto& language : protocol::drawn_with(setup_.protocol, system::drawable).languages)
      questions.languages += QString::fromStdString(language);
  if (!chosen.ask_code) questions.participant = QString::fromStdString(setup_.participant);
  // The participant of a resumed session has already given consent.
  if (setup_.resume_session.empty())
    questions.consent_version = QString::fromStdString(setup_.consent_version);
  start_.ask(std::move(questions));
}

std::optional<session::Summary> StationWindow::run() {
  QGuiApplication::exec();
  return runner_.finish();
}

QQuickWindow& StationWindow::show_live_window(QScreen& screen) {
  auto& window = load_page(live_engine_, "LiveWindow.qml",
                           {{"live", QVariant::fromValue(&runner_.live())},
                            {"bridge", QVariant::fromValue(&runner_.bridge())},
                            {"pixelsPerMm", pixels_per_mm(screen)}});
  window.setScreen(&screen);
  window.showFullScreen();
  return window;
}

void StationWindow::begin() {
  setup_.participant = start_.participant().toStdString();
  if (!start_.language().isEmpty()) setup_.language = start_.language().toStdString();
  Q_EMIT beginning();
  runner_.begin(setup_, look_->language().toStdString());
  if (arm_) runner_.bridge().arm();
}

void StationWindow::close() {
  if (operating_ == nullptr) return void(window_->close());
  if (runner_.running()) return;
  start_.await_operator();
  operating_->refresh();
  const auto& page = runner_.bridge().page()->page();
  if (page.kind == session::PageKind::failed && !page.fault.detail.empty())
    operating_->tell_failure(core::plain(page.fault.detail));
}

}  // namespace turnpoint::ui

#include "moc_station_window.cpp"
