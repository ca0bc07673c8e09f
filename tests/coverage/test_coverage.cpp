#include <filesystem>
#include <fstream>

#include "station/app/parallel.hpp"
#include "tests/coverage/table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace coverage;

namespace {

std::vector<Session> sessions_of(const std::string& procedure, const Source& source, int count, int trials,
                                 int references) {
  const Design design(procedure);
  std::vector<Session> sessions(static_cast<std::size_t>(count));
  turnpoint::app::in_parallel(count, 2, {}, [&](int i) {
    sessions[static_cast<std::size_t>(i)] =
        design.run(source, static_cast<std::uint64_t>(i + 1), i < references, {trials});
  });
  return sessions;
}

}  // namespace

TEST_CASE("Printed 95 % intervals after 96 trials of QUEST+ hold true values drawn from the prior",
          "[coverage]") {
  // One cell of the table of build/release/bin/coverage: three standard errors of 2000 sessions are 1.5 %.
  const auto sessions = sessions_of("quest-plus", sources()[0], 2000, 96, 40);
  for (const auto quantity : {threshold, slope, level_75}) {
    const auto found = tally(sessions, 1, quantity);
    CAPTURE(kQuantities[quantity], found.coverage(), found.abstained());
    CHECK(found.coverage() >= 0.935);
    CHECK(found.coverage() <= 0.965);
    REQUIRE(found.width_ratio);
    CHECK(*found.width_ratio < 1.3);
    CHECK(*found.width_ratio > 0.8);
    // Intervals a fifth narrower, or twice as wide, would be seen.
    CHECK(tally(sessions, 1, quantity, 0.8).coverage() < 0.935);
    CHECK(broken_promise(tally(sessions, 1, quantity, 2), sources()[0], quantity, 96) != "");
  }
  CHECK(tally(sessions, 1, threshold).abstained() <= 0.05);
}

TEST_CASE("A session of the coverage table is its seed's, alone or among others", "[coverage]") {
  const Design design("staircase");
  const auto one = design.run(sources()[1], 7, false), again = design.run(sources()[1], 7, false),
             other = design.run(sources()[1], 8, false);
  for (std::size_t i = 0; i < kTrials.size(); ++i) {
    CHECK(one.after[i].interval == again.after[i].interval);
    CHECK(one.after[i].interval != other.after[i].interval);
  }
}

TEST_CASE("A run of the coverage table that was cut off goes on where it stopped", "[coverage]") {
  const TemporaryFolder folder;
  const auto path = folder / "cell.csv";
  const auto sessions = sessions_of("psi", sources()[0], 3, 48, 1);
  append(path, sessions);
  std::ofstream(path, std::ios::app) << "4,-12.5,1";  // cut off while it was written
  const auto found = read(path);
  REQUIRE(found.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(found[i].seed == sessions[i].seed);
    CHECK(found[i].truth.slope == sessions[i].truth.slope);
    CHECK(found[i].after[0].interval == sessions[i].after[0].interval);
    CHECK(found[i].after[0].reference == sessions[i].after[0].reference);
  }
  append(path, sessions_of("psi", sources()[0], 1, 48, 0));
  CHECK(read(path).size() == 4);
}
