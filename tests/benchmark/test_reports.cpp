#include <cmath>

#include "tests/benchmark/physics.hpp"
#include "tests/benchmark/report.hpp"
#include "tests/benchmark/scripts.hpp"
#include "tests/benchmark/solvers.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::benchmark;

namespace {

const std::vector<PhysicsRow>& rows() {
  static const auto measured = measure_physics(0.01);
  return measured;
}

double error_of(Task task, const std::string& scene, const std::string& solver,
                const std::string& setting = "") {
  for (const auto& row : rows())
    if (row.task == task && row.scene == scene && row.solver == solver && row.setting == setting)
      return row.error;
  return -1;
}

}  // namespace

TEST_CASE("a better model or a finer resolution has a smaller error against the field", "[benchmark]") {
  const std::string scene = "seed brass 19.6 kHz, Q = 60";
  CHECK(error_of(Task::field, scene, "mode") > error_of(Task::field, scene, "modes", "default"));
  CHECK(error_of(Task::field, scene, "modes", "degree 4, 1 spare") >
        error_of(Task::field, scene, "modes", "default"));
  CHECK(error_of(Task::field, scene, "modes", "default") < 5e-4);
  for (const auto& row : rows()) CHECK(row.seconds > 0);
}

TEST_CASE("a better plate theory puts the boundary closer to that of three-dimensional finite elements",
          "[benchmark]") {
  for (const char* scene : {"3 mm plate, 22.4 kHz", "3 mm plate, 30 kHz", "3 mm plate, 45 kHz"}) {
    CAPTURE(scene);
    const double elastic = error_of(Task::theory, scene, "elastic, mode");
    CHECK(elastic > 0);
    CHECK(elastic < 0.1e-3);
    CHECK(error_of(Task::theory, scene, "mindlin, mode") > elastic);
    CHECK(error_of(Task::theory, scene, "kirchhoff, mode") > 0.015);
  }
}

TEST_CASE("the model mode agrees with an unrelated method in extended precision", "[benchmark]") {
  for (const char* scene :
       {"seed brass 19.6 kHz, lossless", "seed brass 45 kHz, Q = 60", "exponential taper 30 kHz, Q = 60"}) {
    const double error = error_of(Task::equation, scene, "mode");
    CAPTURE(scene, error);
    if (error >= 0) CHECK(error < 1e-12);
  }
}

TEST_CASE("a general solver's error falls with its tolerance", "[benchmark]") {
  const std::string scene = "seed brass 45 kHz, Q = 60";
  CHECK(error_of(Task::equation, scene, "Numerov", "1000 steps") >
        50 * error_of(Task::equation, scene, "Numerov", "4000 steps"));
  CHECK(error_of(Task::equation, scene, "Numerov", "4000 steps") > 0);
}

TEST_CASE("a table is aligned for people and quoted for programs", "[benchmark]") {
  const Table table{{"what", "time_us"}, {{std::string("a, \"b\""), 1.5}, {std::string("c"), Cell()}}};
  CHECK(to_csv(table) == "what,time_us\n\"a, \"\"b\"\"\",1.5\nc,\n");
  CHECK(to_text(table) == "what    time_us\na, \"b\"      1.5\nc             -\n");
}

TEST_CASE("a program that is not installed prints no lines", "[benchmark]") {
  CHECK(run_peer("no_such_script.py", {}).empty());
  CHECK(run_peer("questplus_trial.py", {"not", "a", "grid"}).empty());
}

TEST_CASE("the figures have a panel for each scene", "[benchmark]") {
  const auto pictures = physics_pictures(rows());
  REQUIRE(pictures.size() >= 2);
  CHECK(pictures[0].figure.charts.size() == 6);
  CHECK(pictures[1].figure.charts.size() == 3);  // plate theories at three frequencies
  CHECK(!turnpoint::report::render(pictures[0].figure).empty());
}
