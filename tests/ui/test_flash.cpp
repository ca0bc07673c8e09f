// A flash as response signal: when its frame was handed to the screen, and what the session stores about it.
#include <QGuiApplication>
#include <QQuickWindow>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "station/store/read.hpp"
#include "station/system/clocks.hpp"
#include "station/ui/participant/session_runner.hpp"
#include "station/view/report_data.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;

namespace {

/// Runs the event loop until `done`, for at most half a minute, which only ends a test that hangs.
bool wait_until(const std::function<bool()>& done) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!done()) {
    if (std::chrono::steady_clock::now() > until) return false;
    QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
  }
  return true;
}

/// A window without a screen.
struct Window {
  Window() {
    qputenv("QT_QPA_PLATFORM", "offscreen");
    qputenv("QT_QUICK_BACKEND", "software");
    loop = std::make_unique<EventLoop<QGuiApplication>>();
    window = std::make_unique<QQuickWindow>();
    window->resize(200, 100);
    window->show();
  }
  std::unique_ptr<EventLoop<QGuiApplication>> loop;
  std::unique_ptr<QQuickWindow> window;
};

}  // namespace

TEST_CASE("the time of a flash is that of the first frame drawn after it was asked for", "[frames][flash]") {
  Window on;
  std::int64_t now = 1000;
  ui::FrameWatch watch([&now] { return now; });
  watch.follow(on.window.get(), 60);
  std::vector<std::int64_t> times;
  QObject::connect(&watch, &ui::FrameWatch::presented, [&](qint64 time_ns) { times.push_back(time_ns); });
  int frames = 0;
  QObject::connect(on.window.get(), &QQuickWindow::frameSwapped, [&frames] { ++frames; });
  watch.asked();
  REQUIRE(wait_until([&] { return frames > 0; }));
  CHECK(times.empty());  // an ordinary page has no time
  now = 2000;
  const int before = frames;
  watch.timed();
  REQUIRE(wait_until([&] { return frames > before; }));
  REQUIRE(times.size() == 1);
  CHECK(times.front() == 2000);
  on.window->update();
  REQUIRE(wait_until([&] { return frames > before + 1; }));
  CHECK(times.size() == 1);  // later frames are not the flash
  watch.end();
}

TEST_CASE("each flash of a session is stored with the time at which it was shown", "[flash]") {
  Window on;
  TemporaryFolder folder;
  ui::SessionRunner runner;
  runner.watch(on.window.get());
  auto setup = live_room::live_setup(folder / "a.sqlite", "touch");
  auto text = live_room::protocol_text("touch");
  const std::string deadline = "deadline_s = 3.0";
  text.replace(text.find(deadline), deadline.size(),
               "response_signal = { after_s = 0.5, window_s = 1.5, by = \"flash\" }");
  const std::string early = "anticipation_s = 0.0\n";
  text.erase(text.find(early), early.size());
  setup.protocol = protocol::parse(text, "flash.toml");
  setup.run_mode = core::RunMode::pilot;
  setup.rig.touch_uri = "sim:";
  setup.display_latency_s = 0.042;
  const auto database = setup.database;
  runner.begin(std::move(setup));
  auto& bridge = runner.bridge();
  const auto& page = bridge.page()->page();
  std::optional<std::int64_t> flash_ns;
  int flashes = 0;
  QObject::connect(&bridge, &ui::SessionBridge::shown, [&] {
    // the page of the second flash is held up, so that its frame is late
    if (page.flash_ns && flash_ns != page.flash_ns && ++flashes == 2)
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
    flash_ns = page.flash_ns;
  });
  const bool ended = wait_until([&] {
    if (page.kind == session::PageKind::instructions) bridge.next();
    if (flash_ns && system::monotonic_ns() > *flash_ns + 400'000'000)
      bridge.answer(0, {system::monotonic_ns()});
    return page.kind == session::PageKind::end;
  });
  CHECK(ended);
  const auto summary = runner.finish();
  REQUIRE(summary);
  int shown = 0, late = 0, latencies = 0;
  for (const auto& event : store::read_session(database, summary->session_id).events) {
    latencies += event.kind == "display_latency" && event.value == "0.042" ? 1 : 0;
    const bool is_late = event.kind == "signal_late";
    if (event.kind != "signal_shown" && !is_late) continue;
    ++shown, late += is_late ? 1 : 0;
    const double delay_s = std::stod(event.value);
    CHECK(delay_s > 0);
    CHECK((delay_s > 0.05) == is_late);
  }
  CHECK(latencies == 1);
  CHECK(shown == flashes);
  CHECK(flashes >= 2);
  CHECK(late >= 1);
  int rows = 0;
  const auto reports = view::report_data(database, summary->session_id);
  for (const auto& [name, said] : reports.front().health)
    if (name.key == "station.flashes") {
      ++rows;
      CHECK(core::say(said, "en").find(std::to_string(shown) + " shown; frame ready ") == 0);
      CHECK(core::say(said, "en").find("a touch shows on this screen after 42 ms") != std::string::npos);
    }
  CHECK(rows == 1);
}
