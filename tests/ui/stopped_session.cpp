// stopped_session PROTOCOL RIG DATABASE: a session on the screen, by the program's own way there, whose
// process is told to stop (SIGTERM) in the middle of its second trial's stimulus. It answers the second
// choice before.
#include <signal.h>

#include <QGuiApplication>
#include <QQmlExtensionPlugin>
#include <QQuickWindow>
#include <QTimer>
#include <cstdio>
#include <exception>

#include "station/store/records.hpp"
#include "station/ui/screens.hpp"
#include "station/ui/session_bridge.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

using namespace turnpoint;

namespace {

void take_part(ui::SessionBridge& bridge) {
  using Kind = ui::PageModel::Kind;
  const auto* page = bridge.page();
  if (page->kind() == Kind::Instructions) return bridge.next();
  if (page->kind() != Kind::Stimulus || !page->answers_open()) return;
  if (page->trials_done() == 1) return void(::raise(SIGTERM));
  // Long enough after the page for it to have been read.
  bridge.answer(1, bridge.now_ns() + 300'000'000);
}

/// Once the program's window is there: somebody before it.
void sit_down() {
  for (auto* window : QGuiApplication::topLevelWindows()) {
    auto* bridge = window->property("bridge").value<ui::SessionBridge*>();
    if (bridge == nullptr) continue;
    QObject::connect(bridge, &ui::SessionBridge::shown, bridge, [bridge] { take_part(*bridge); });
    return take_part(*bridge);
  }
  QTimer::singleShot(1, [] { sit_down(); });
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) return 2;
  app::RunRequest request;
  request.protocol = argv[1];
  request.rig = argv[2];
  request.participant = "T1";
  request.language = "en";
  request.database = argv[3];
  qAddPreRoutine([] { QTimer::singleShot(0, [] { sit_down(); }); });
  const auto summary = ui::run_on_screen(request, std::nullopt);
  std::printf("%s, %d trials: %s\n", store::name(summary.status), summary.trials, summary.reason.c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "stopped_session: %s\n", error.what());
  return 1;
}
