// stopped_session PROTOCOL RIG DATABASE: runs a session on the screen in the same way as the program. The
// simulated participant gives the second answer in the first trial. In the middle of the second trial's
// stimulus, the process sends itself SIGTERM. With a fourth argument, it first writes this file until the
// disk is full, or only makes this file if the variable HANGS_WHEN names it.
#include <signal.h>

#include <QGuiApplication>
#include <QQmlExtensionPlugin>
#include <QQuickWindow>
#include <QTimer>
#include <cstdio>
#include <exception>
#include <fstream>
#include <utility>

#include "station/core/records.hpp"
#include "station/ui/participant/session_bridge.hpp"
#include "station/ui/platform/screens.hpp"
#include "tests/support/small_disk.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

using namespace turnpoint;

namespace {

std::string filling;

void take_part(ui::SessionBridge& bridge) {
  using Kind = ui::PageModel::Kind;
  const auto* page = bridge.page();
  if (page->kind() == Kind::Instructions || page->kind() == Kind::Paused || page->kind() == Kind::Rest)
    return bridge.next();
  // on a machine that stood still the amplifier was switched off; the operator switches it on again
  if (page->kind() == Kind::Fault) {
    bridge.arm();
    return bridge.next();
  }
  if (page->kind() != Kind::Stimulus || !page->answers_open()) return;
  if (page->trials_done() >= 1) {
    static bool stopped = false;  // a second signal would end the process
    if (std::exchange(stopped, true)) return;
    if (qEnvironmentVariable("HANGS_WHEN").toStdString() == filling)
      std::ofstream(filling) << "hangs";
    else if (!filling.empty())
      SmallDisk::fill(filling);
    return void(::raise(SIGTERM));
  }
  // answers count only after a page has been shown for a while
  bridge.answer(1, {bridge.now_ns() + 300'000'000});
}

/// Simulates a participant. The program calls it once its window exists. What came too early for a page,
/// because the machine stood still, is done again half a second later.
void sit_down() {
  for (auto* window : QGuiApplication::topLevelWindows()) {
    auto* bridge = window->property("bridge").value<ui::SessionBridge*>();
    if (bridge == nullptr) continue;
    QObject::connect(bridge, &ui::SessionBridge::shown, bridge, [bridge] { take_part(*bridge); });
    auto* again = new QTimer(bridge);
    QObject::connect(again, &QTimer::timeout, bridge, [bridge] { take_part(*bridge); });
    again->start(500);
    return take_part(*bridge);
  }
  QTimer::singleShot(1, [] { sit_down(); });
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) return 2;
  if (argc > 4) filling = argv[4];
  session::RunRequest request;
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
