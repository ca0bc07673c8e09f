#include <QCoreApplication>
#include <filesystem>
#include <memory>
#include <string>

#include "station/rig/apply.hpp"
#include "station/system/clocks.hpp"
#include "station/ui/operator/calibration_guide.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;
using ui::CalibrationGuide;

namespace {

/// A rig whose touch panel is measured in the guided calibration. Its button lines and its panel are the
/// test.
struct Measurement {
  EventLoop<> loop;
  const TemporaryFolder folder;
  const std::string rig = folder / "rig.toml";
  std::unique_ptr<CalibrationGuide> guide;

  Measurement() {
    std::filesystem::copy_file(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml", rig);
    guide = std::make_unique<CalibrationGuide>(rig);
    guide->open_panel_with([](ui::LatencyController&, const rig::Rig&) {});
  }

  /// Taps ten times, each tap 30 ms after an edge of the line.
  void taps() const {
    auto& latency = *guide->latency();
    for (int k = 1; k <= 10; ++k) {
      latency.edge(system::monotonic_ns() - 30'000'000);
      latency.tap(0.5, 0.5);
      until([&] { return latency.taps() == k && latency.edges() == k; });
      const auto next_ns =
          system::monotonic_ns() + 410'000'000;  // an edge this old is not matched with a tap
      until([&] { return system::monotonic_ns() > next_ns; });
    }
  }
  template <typename Condition>
  static void until(Condition condition) {
    const auto end_ns = system::monotonic_ns() + 20'000'000'000;
    while (!condition() && system::monotonic_ns() < end_ns)
      QCoreApplication::processEvents(QEventLoop::AllEvents, 10);
  }
  bool measured(const QString& name) const {
    for (const auto& one : guide->series())
      if (one.toMap()["name"] == name) return one.toMap()["measured"].toBool();
    FAIL("there is no measurement called " << name.toStdString());
    return false;
  }
};

}  // namespace

TEST_CASE(
    "the guided calibration measures the latency of the touch panel, and keeps what was measured before",
    "[calibration]") {
  Measurement room;
  auto& guide = *room.guide;
  CHECK_FALSE(room.measured("panel_button"));
  guide.begin("panel_button");
  REQUIRE(guide.latency() != nullptr);
  CHECK(guide.latency()->by_button());
  guide.latency()->keep();
  CHECK(guide.file().isEmpty());  // there are not enough taps yet
  room.taps();
  int finished = 0;
  QObject::connect(&guide, &CalibrationGuide::finished, [&finished] { ++finished; });
  guide.latency()->keep();
  CHECK(finished == 1);
  CHECK(guide.latency() == nullptr);
  CHECK(guide.problem() == QVariant(QString()));
  CHECK(room.measured("panel_button"));
  CHECK_FALSE(room.measured("panel_photodiode"));
  const auto made = rig::load_calibration(guide.file().toStdString());
  REQUIRE((made.panel && made.panel->touch));
  CHECK(made.panel->touch->median_s > 0.029);
  CHECK(made.panel->touch->median_s < 0.2);

  guide.begin("panel_photodiode");
  REQUIRE(guide.latency() != nullptr);
  CHECK_FALSE(guide.latency()->by_button());
  guide.leave();
  CHECK(guide.latency() == nullptr);
  CHECK(room.measured("panel_button"));
}

TEST_CASE("without real button lines the guided calibration says why the panel cannot be measured",
          "[calibration]") {
  const Measurement room;
  CalibrationGuide guide(room.rig);
  guide.begin("panel_button");
  CHECK(guide.latency() == nullptr);
  CHECK(guide.problem().toMap()["key"] == "refusal.no_button_lines");
}
