// Tests that the operator's view of a session shows the finger, although the protocol asks for no movement.
#include <QCoreApplication>
#include <chrono>

#include "station/ui/participant/session_runner.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;

TEST_CASE("the operator's view has gauges of the finger, and the participant's page has no bars",
          "[ui][gauges]") {
  const EventLoop<> loop;
  const TemporaryFolder folder;
  auto request = simulated_run(measured::shipped("demo"), folder / "a.sqlite", 7);
  request.rig = measured::with_capture(folder, measured::kCells);
  ui::SessionRunner runner;
  const auto& live = runner.live();
  int pressed = 0, guided = 0;
  QString figure;
  QObject::connect(&live, &ui::LiveModel::gaugesMoved, &live, [&] {
    if (!live.gauged() || live.force_gauge()[0] < 0.05) return;
    ++pressed;
    figure = live.gauge_figures()[0];
  });
  QObject::connect(&runner.bridge(), &ui::SessionBridge::shown, &live,
                   [&] { guided += runner.bridge().page()->is_guided() ? 1 : 0; });
  CHECK_FALSE(live.gauged());
  runner.begin(session::prepare(request));
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(100);
  while (pressed < 20 && std::chrono::steady_clock::now() < until)
    QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
  CHECK(pressed >= 20);
  CHECK(figure.endsWith(" N"));
  CHECK(live.position_gauge().size() == 3);
  CHECK(guided == 0);
  runner.bridge().stop();
}
