#include <cmath>

#include "station/view/trial_timeline.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using Kind = view::TrialPart::Kind;

namespace {

void check(const std::string& file, const std::vector<view::TrialPart>& wanted) {
  INFO(file);
  const auto parts =
      view::trial_timeline(protocol::load(TURNPOINT_SOURCE_DIR "/protocols/" + file + ".toml"));
  REQUIRE(parts.size() == wanted.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    INFO(i);
    CHECK(parts[i].kind == wanted[i].kind);
    CHECK(std::abs(parts[i].from_s - wanted[i].from_s) < 1e-9);
    CHECK(std::abs(parts[i].to_s - wanted[i].to_s) < 1e-9);
  }
}

}  // namespace

// The expected numbers are added up by hand from the times in the protocol files.
TEST_CASE("a trial's timeline has its pause, its intervals with gaps, and the time for an answer", "[desk]") {
  check("friction-2ifc", {{Kind::pause, 0, 1},
                          {Kind::interval, 1, 2.5},
                          {Kind::gap, 2.5, 3.5},
                          {Kind::interval, 3.5, 5},
                          {Kind::answer, 5, 8}});
  check("demo", {{Kind::pause, 0, 0.8}, {Kind::interval, 0.8, 4.8}, {Kind::answer, 0.8, 6.8}});
  // Each instruction has its own deadline, so there is no single time for an answer.
  check("speed-accuracy", {{Kind::pause, 0, 1.1}, {Kind::interval, 1.1, 6.1}});
}
