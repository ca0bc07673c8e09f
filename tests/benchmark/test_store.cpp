#include "tests/benchmark/durable_trial.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint::benchmark;

TEST_CASE("the benchmark writes the stated number of trials with each method, and leaves no files behind",
          "[benchmark]") {
  TemporaryFolder folder;
  const auto table = time_durable_trials(folder.path, 5);
  REQUIRE(table.size() == 3);
  CHECK(table[0].ratio == 1.0);
  for (const auto& row : table) {
    CHECK(row.trials == 5);
    CHECK(row.median_ms > 0);
    CHECK(row.p99_ms >= row.median_ms);
  }
  CHECK(std::filesystem::is_empty(folder.path));
  CHECK_THROWS_AS(time_durable_trials(folder.path, 0), std::invalid_argument);
}
