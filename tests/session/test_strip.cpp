#include <cmath>

#include "station/analysis/quantile.hpp"
#include "station/report/figures.hpp"
#include "station/view/live_view.hpp"
#include "station/view/report_data.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

// Tests the curve of friction along the strip beside the planned boundary, in the report and on the
// operator's page.

using namespace turnpoint;
using namespace measured;

namespace {

std::string demo_with(const TemporaryFolder& folder, const std::string& sensing) {
  std::ostringstream text;
  text << std::ifstream(shipped("demo")).rdbuf();
  auto protocol = text.str();
  const std::pair<std::string, std::string> changes[] = {{"edge = \"p50\"", "edge = { friction = 0.55 }"},
                                                         {"displacement_um = 1.0", "displacement_um = 3.0"},
                                                         {"explore_s = 4.0", "explore_s = 12.0"},
                                                         {"deadline_s = 6.0", "deadline_s = 15.0"},
                                                         {"repeats = 2\n", "repeats = 1\n"},
                                                         {"[timing]", sensing + "[timing]"}};
  for (const auto& [from, to] : changes) {
    const auto at = protocol.find(from);
    REQUIRE(at != std::string::npos);
    protocol.replace(at, from.size(), to);
  }
  const auto path = folder / "demo.toml";
  std::ofstream(path) << protocol;
  return path;
}

/// Keeps the row of the newest trial, and what the operator's page shows about it.
struct Sensors : session::Monitor {
  std::optional<protocol::Sensing> asked;
  std::map<std::string, std::string> facts;
  void trial_ended(const trial::TrialSpec&, const core::TrialRow& row) override {
    facts.clear();
    for (const auto& [label, value] : view::sensors_of(row, asked)) facts[label] = value;
  }
};

report::SessionData data_of(const std::string& sensing, Sensors& sensors) {
  TemporaryFolder folder;
  const auto request = request_in(folder, demo_with(folder, sensing), kCells, "sim:residual=10");
  const auto setup = session::prepare(request);
  sensors.asked = setup.protocol.sensing;
  session::Inputs inputs;
  const auto summary =
      session::run(setup, nullptr, inputs, std::make_unique<session::SimulatedRoom>(setup.rig), &sensors);
  return view::report_data(request.database, summary.session_id).front();
}

double mean_between(const analysis::FrictionCurve& curve, double from_mm, double to_mm) {
  std::vector<double> values;
  for (std::size_t i = 0; i < curve.friction.size(); ++i)
    if (curve.from_boundary_mm[i] > from_mm && curve.from_boundary_mm[i] < to_mm)
      values.push_back(curve.friction[i]);
  REQUIRE(values.size() >= 5);
  return analysis::mean(values);
}

}  // namespace

TEST_CASE("the report has friction along the strip, which rises at the planned boundary",
          "[session][strip]") {
  Sensors sensors;
  const auto data = data_of("", sensors);
  REQUIRE(data.strip.size() == 2);
  for (const auto& curve : data.strip) {
    INFO(curve.direction);
    // The finger's friction at rest is 0.8; the boundary is where it has fallen to 0.55 of this.
    CHECK(mean_between(curve, -30, -6) < 0.4);
    CHECK(mean_between(curve, 15, 35) == Approx(0.8).epsilon(0.08));
    CHECK(mean_between(curve, -5, 5.1) == Approx(0.55 * 0.8).margin(0.12));
    for (const double se : curve.se) CHECK((se > 0 && se < 0.2));
  }
  const auto chart = report::strip_chart(data.strip);
  REQUIRE(chart);
  CHECK(chart->layers.size() == 3);
  CHECK(std::get<report::Rule>(chart->layers.front()).at == 0);
  CHECK(data.repeats.empty());
  SECTION("the operator sees what the sensors measured") {
    CHECK(sensors.facts.at("The finger") == "ok");
    CHECK(sensors.facts.at("Normal force").find("N, SD") != std::string::npos);
    CHECK(sensors.facts.count("Pick-up, level") == 1);
    CHECK(sensors.facts.count("Zero of the cells") == 1);
  }
  SECTION("without curves there is no chart") { CHECK_FALSE(report::strip_chart({})); }
}

TEST_CASE("the report counts the trials that were presented again, by level", "[session][strip]") {
  Sensors sensors;
  const auto data = data_of(
      "[sensing]\nspeed_mm_s = [200, 300]\nstrokes = 1\noutside = \"repeat\"\nrepeats = 1\n", sensors);
  REQUIRE(data.repeats.size() == 5);
  for (const auto& at : data.repeats) {
    // the movement was wrong twice, so the trial was presented twice; the second time it counts and is marked
    CHECK(at.presented == 2);
    CHECK(at.repeated == 1);
  }
  CHECK(sensors.facts.at("The finger") == "slow");
  CHECK(sensors.facts.at("Speed").find("asked for 200 to 300 mm/s") != std::string::npos);
}
