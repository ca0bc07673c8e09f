#include "station/system/progress.hpp"
#include "tests/support/catch.hpp"

using turnpoint::system::progress_in_words;

TEST_CASE("progress shows the fraction that is done and the time left", "[progress]") {
  CHECK(progress_in_words("simulated sessions", 137, 1000, 240) ==
        "simulated sessions: 137 of 1000 (13 %), 4 min left");
  CHECK(progress_in_words("cues compared", 1, 8, 12.2) == "cues compared: 1 of 8 (12 %), 13 s left");
  CHECK(progress_in_words("tables", 1, 2, 3 * 3600) == "tables: 1 of 2 (50 %), 3.0 h left");
}

TEST_CASE("progress states no remaining time before it is known, and none at the end", "[progress]") {
  CHECK(progress_in_words("tables", 0, 7, -1) == "tables: 0 of 7 (0 %)");
  CHECK(progress_in_words("tables", 7, 7, 0) == "tables: 7 of 7 (100 %)");
}
