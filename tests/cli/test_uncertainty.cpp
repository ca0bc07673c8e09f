// Tests that the commands `map`, `plan` and `check` say how uncertain a boundary is.
#include <fstream>
#include <nlohmann/json.hpp>

#include "station/core/read_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

const std::string source = TURNPOINT_SOURCE_DIR, rig = source + "/tests/support/thin_plate.toml",
                  demo = source + "/protocols/demo.toml";

std::string output_of(std::vector<std::string> arguments, int status = 0) {
  arguments.insert(arguments.begin(), TURNPOINT);
  Child child(arguments);
  REQUIRE(child.ends_within(60'000));
  INFO(child.said());
  CHECK(child.outcome() == status);
  return child.said();
}

bool contains(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("map says what moves a boundary, and what to measure", "[cli]") {
  const TemporaryFolder folder;
  const auto plot = folder / "budget.svg";
  const auto said =
      output_of({"map", "--rig", rig, "--boundary", "150", "--edge", "p50", "--budget", "--plot", plot});
  CHECK(contains(said, "clamp line           0.2 mm           6.67"));
  CHECK(contains(said, "Of these, measuring the clamp line would help most"));
  CHECK(contains(turnpoint::core::read_file(plot), "clamp line"));
  const auto json = nlohmann::json::parse(
      output_of({"map", "--rig", rig, "--boundary", "150", "--edge", "p50", "--budget", "--json"}));
  CHECK(json[0]["budget"]["total_mm"] == json[0]["uncertainty_mm"]);
  CHECK(json[0]["budget"]["contributions"].size() == 7);
  CHECK(json[0]["budget"]["contributions"][0]["unit"] == "mm");
  CHECK(json[0]["error_bound_mm"].get<double>() > 0);
  CHECK(contains(said, "A moving finger displaces this edge by "));
  CHECK(json[0]["finger"]["shift_mm"].get<double>() > 1);
  CHECK(json[0]["finger"]["range_mm"][0] < json[0]["finger"]["shift_mm"]);
  CHECK(contains(output_of({"map", "--rig", rig, "--boundary", "150", "--plot", plot}, 2),
                 "--plot needs --budget"));
}

TEST_CASE("plan and check say how uncertain boundaries are", "[cli]") {
  CHECK(contains(output_of({"plan", demo, "--scene", "edge", "--rig", rig}), "uncertain by 7."));
  CHECK(contains(output_of({"check", demo, "--rig", rig, "--sessions", "0"}), "uncertain by "));
}

TEST_CASE("map and plan use the boundaries that were measured on a rig", "[cli]") {
  const TemporaryFolder folder;
  const auto copy = folder / "plate.toml", boundaries = folder / "boundaries.csv";
  std::ofstream(copy) << turnpoint::core::read_file(rig);
  // the boundaries of a plate whose clamp line is 0.25 mm further back, which moves them outward by 8.3 mm
  std::ofstream(boundaries)
      << "frequency_Hz,boundary_mm,sd_mm\n22400,110.8,0.5\n30000,160.3,0.5\n43000,212.1,0.5\n";
  const std::vector<std::string> map{"map", "--rig", copy, "--frequency", "30000", "--edge", "p50", "--json"};
  const auto said = output_of({"calibrate", "--rig", copy, "--boundaries", boundaries});
  CHECK(contains(said, "clamp line: changed by"));
  CHECK_FALSE(contains(said, "OUTLIER"));
  const auto text = output_of(map);
  CHECK(contains(text, "calibration "));  // a message on stderr names the calibration that is used
  const auto json = nlohmann::json::parse(text.substr(text.find('[')));
  CHECK(json[0]["boundary_mm"].get<double>() == Approx(160.3).margin(0.5));
  CHECK(json[0]["uncertainty_mm"].get<double>() < 0.5);
  CHECK(contains(output_of({"plan", demo, "--scene", "edge", "--rig", copy}), "uncertain by 0."));
  CHECK(contains(output_of({"check", demo, "--sessions", "0", "--rig", copy}), "uncertain by 0."));
  const auto field = output_of({"field", "--tone", "30000", "--points", "2", "--rig", copy});
  CHECK(contains(field, "calibration "));
  CHECK_FALSE(contains(field, "turning point 147.4 mm"));  // the value without the calibration
  CHECK(contains(output_of({"power", demo, "--observers", "1", "--intervals", "0", "--rig", copy}),
                 "calibration "));
}
