#include <algorithm>

#include "station/view/live_view.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

// Tests that the operator sees the finger whenever the rig has force cells, although the protocol asks for no
// movement and the participant sees no bars.

using namespace turnpoint;
using namespace measured;

namespace {

struct Watched {
  std::vector<view::FingerGauges> gauges;
  int pages_with_bars = 0;
};

struct Participant : session::Display {
  int pages_with_bars = 0;
  void show(const session::Page& page) override { pages_with_bars += page.guidance ? 1 : 0; }
  void guide(const session::Guidance&) override { ++pages_with_bars; }
};

Watched watch_demo(const std::string& capture) {
  const TemporaryFolder folder;
  const auto request = request_in(folder, shipped("demo"), capture);
  const auto setup = session::prepare(request);
  Watched watched;
  Participant participant;
  session::Inputs inputs;
  {
    view::LiveView view(
        setup.protocol, setup.rig, [](const view::LiveState&) {}, "en",
        [&](view::FingerGauges gauges) { watched.gauges.push_back(std::move(gauges)); });
    session::run(setup, &participant, inputs, std::make_unique<session::SimulatedRoom>(setup.rig), &view);
  }
  watched.pages_with_bars = participant.pages_with_bars;
  return watched;
}

}  // namespace

TEST_CASE("the operator sees force, speed and place of the finger although the protocol guides nobody",
          "[session][gauges]") {
  const auto watched = watch_demo(kCells);
  CHECK(watched.pages_with_bars == 0);
  CHECK(watched.gauges.size() > 100);
  std::size_t pressed = 0;
  double least = 1, most = 0;
  for (const auto& gauges : watched.gauges) {
    if (!gauges.force.value || *gauges.force.value < 0.05) continue;
    ++pressed;
    if (!gauges.position.value) continue;
    least = std::min(least, *gauges.position.value), most = std::max(most, *gauges.position.value);
  }
  CHECK(pressed > 100);
  // The simulated finger strokes the surface between a quarter and three quarters of its length.
  CHECK(least < 0.35);
  CHECK(most > 0.65);
}

TEST_CASE("without force cells there are no gauges", "[session][gauges]") {
  CHECK(watch_demo(kPickUps).gauges.empty());
}
