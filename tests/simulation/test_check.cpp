#include "station/simulation/check.hpp"

#include <string>

#include "station/simulation/rehearsal.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

TEST_CASE("the duration estimated by check is that of a rehearsed session plus the time that people need",
          "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const auto path = root + "/protocols/friction-2ifc.toml";
  const auto check = simulation::check(path, root + "/deploy/rigs/simulated.toml", {1});
  const auto protocol = protocol::load(path);
  const auto rehearsal =
      simulation::rehearse(protocol, 0, 0, simulation::rehearser(observer::Observer(observer::Parameters{})));
  REQUIRE(check.simulated_sessions == 1);
  CHECK(check.trials.median == rehearsal.trials);
  // In a task with two intervals nobody explores the surface. So the estimate adds only instructions and
  // breaks to the time of the trials.
  const auto order = protocol::block_order(protocol, 0);
  double beside_s = 0;
  for (const auto& [start, trials] : rehearsal.blocks) {
    beside_s += 12;
    if (const auto& rest = order[static_cast<std::size_t>(start.block_index)].break_after)
      beside_s +=
          rest->min_s * static_cast<double>((trials.size() - 1) / static_cast<std::size_t>(rest->trials));
  }
  CHECK(check.duration_s.median == Approx(rehearsal.duration_s + beside_s));
}

TEST_CASE("the duration estimated by check includes time to set a slider", "[check]") {
  const std::string root = TURNPOINT_SOURCE_DIR;
  const auto path = root + "/protocols/boundary-adjustment.toml";
  const auto check = simulation::check(path, root + "/deploy/rigs/simulated.toml", {1});
  const auto protocol = protocol::load(path);
  const double longest_s = protocol.timing.explore_s.value();
  const double setting_s = longest_s < 15 ? longest_s : 15;
  CHECK(check.duration_s.median > check.trials.median * setting_s);
  CHECK(check.duration_s.median < check.trials.median * (setting_s + 5) + 60);
}
