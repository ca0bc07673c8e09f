#include "station/store/bench.hpp"

#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

TEST_CASE("the benchmark writes the trials it says by each way, and leaves nothing behind", "[store]") {
  TemporaryFolder folder;
  const auto table = bench(folder.path, 5);
  REQUIRE(table.size() == 3);
  CHECK(table[0].ratio == 1.0);
  for (const auto& row : table) {
    CHECK(row.trials == 5);
    CHECK(row.median_ms > 0);
    CHECK(row.p99_ms >= row.median_ms);
  }
  CHECK(std::filesystem::is_empty(folder.path));
  CHECK_THROWS_AS(bench(folder.path, 0), std::invalid_argument);
}
