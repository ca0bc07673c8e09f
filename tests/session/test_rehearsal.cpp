#include <string>

#include "station/rehearsal/rehearsal.hpp"
#include "station/session/session.hpp"
#include "station/simulation/observer.hpp"
#include "station/store/read.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

TEST_CASE("a rehearsed session has the same trials, answers and times as a session that runs",
          "[session][rehearsal]") {
  const auto* protocol =
      GENERATE("demo", "boundary-adjustment", "smoothness-points", "smoothness-line", "magnitude-standard",
               "friction-confidence", "friction-detection", "friction-identification", "friction-3ifc",
               "friction-4ifc", "friction-time-limit", "friction-abx", "limits-boundary", "response-signal",
               "response-signal-buzz", "friction-rating", "bisection", "matching", "magnitude-production",
               "friction-pairs", "friction-triads");
  const TemporaryFolder folder;
  session::Setup setup;
  setup.rig = rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
  setup.protocol = protocol::load(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + protocol + ".toml");
  setup.participant = "P01";
  setup.database = folder / "a.sqlite";
  setup.run_mode = core::RunMode::simulated;
  setup.language = setup.protocol.languages.front();
  setup.observer = "sim";
  setup.seed = 7;
  session::Inputs inputs;
  const auto summary = session::run(setup, nullptr, inputs);
  const auto stored = store::read_session(setup.database, summary.session_id);
  const auto rehearsed =
      rehearsal::rehearse(setup.protocol, 0, 7, rehearsal::rehearser(simulation::Observer({})));
  REQUIRE(rehearsed.blocks.size() == stored.blocks.size());
  REQUIRE(rehearsed.trials == summary.trials);
  for (std::size_t b = 0; b < stored.blocks.size(); ++b) {
    REQUIRE(rehearsed.blocks[b].trials.size() == stored.blocks[b].trials.size());
    for (std::size_t t = 0; t < stored.blocks[b].trials.size(); ++t) {
      const auto& one = rehearsed.blocks[b].trials[t];
      const auto& other = stored.blocks[b].trials[t];
      CHECK((one.level == other.level && one.given.response == other.given.response &&
             one.given.correct == other.given.correct));
      CHECK(one.outcome == other.outcome);
      CHECK(one.given.confidence == other.given.confidence);
      REQUIRE(one.timing.response_time_s.has_value() == other.timing.response_time_s.has_value());
      if (one.timing.response_time_s)
        CHECK(*one.timing.response_time_s == Approx(*other.timing.response_time_s).margin(1e-8));
    }
  }
}
