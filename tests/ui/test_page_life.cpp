// Tests how the screen affects a session. The amplifier's guard expects regular reports from the
// participant's page, and a touch panel can be unplugged.
#include <QCoreApplication>
#include <chrono>
#include <memory>
#include <thread>

#include "station/ui/participant/session_runner.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fake_evdev.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;

namespace {

/// A pilot session on simulated GPIO lines, with stimuli of half a minute.
struct PilotSession {
  EventLoop<> loop;
  TemporaryFolder folder;
  ui::SessionRunner runner;

  /// Starts the session on a rig with this touch panel.
  explicit PilotSession(const std::string& touch_uri = "sim:") {
    auto setup = live_room::live_setup(folder / "a.sqlite", "touch");
    auto text = live_room::protocol_text("touch");
    text.replace(text.find("explore_s = 2.0"), 15, "explore_s = 20.0");
    text.replace(text.find("deadline_s = 3.0"), 16, "deadline_s = 25.0");
    setup.protocol = protocol::parse(text, "pilot.toml");
    setup.run_mode = core::RunMode::pilot;
    setup.rig.touch_uri = touch_uri;
    runner.begin(std::move(setup));
  }

  const session::Page& page() { return runner.bridge().page()->page(); }

  /// Runs the event loop until this kind of page is shown, for at most half a minute. The limit only ends a
  /// test that hangs.
  bool shows(session::PageKind kind) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (page().kind != kind) {
      if (std::chrono::steady_clock::now() > until) return false;
      if (page().kind == session::PageKind::instructions) runner.bridge().next();
      QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
    }
    return true;
  }
};

}  // namespace

TEST_CASE("if the pages' thread hangs, the amplifier is switched off, and the next page says so", "[page]") {
  PilotSession session;
  REQUIRE(session.shows(session::PageKind::stimulus));
  // Negative control: while the event loop runs normally for the same time, nothing must happen.
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(2600);
  while (std::chrono::steady_clock::now() < until) {
    QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
    REQUIRE(session.page().kind == session::PageKind::stimulus);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(2600));  // now the pages' thread hangs
  REQUIRE(session.shows(session::PageKind::fault));
  CHECK(session.page().fault.kind == core::FaultKind::page_silent);
  CHECK(session.page().amplifier == "faulted");
  session.runner.ask_to_stop();
  const auto summary = session.runner.finish();
  REQUIRE(summary);
  CHECK(summary->voided == 1);
}

TEST_CASE("an unplugged touch panel makes the trial void and causes a fault page, and the trial is repeated",
          "[page]") {
  const TemporaryFolder devices;
  const auto path = devices / "event-panel";
  auto panel = std::make_unique<FakeEvdev>(2, path);
  PilotSession session("evdev:" + path);
  REQUIRE(session.shows(session::PageKind::stimulus));
  panel->unplug();
  REQUIRE(session.shows(session::PageKind::fault));
  CHECK(session.page().fault.kind == core::FaultKind::touch_gone);
  CHECK(session.page().fault.detail == "the touch panel was disconnected");
  panel.reset();
  panel = std::make_unique<FakeEvdev>(2, path);
  session.runner.bridge().arm();
  session.runner.bridge().next();
  REQUIRE(session.shows(session::PageKind::stimulus));
  session.runner.ask_to_stop();
  const auto summary = session.runner.finish();
  REQUIRE(summary);
  CHECK(summary->voided >= 1);
}
