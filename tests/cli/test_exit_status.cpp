#include <sstream>
#include <system_error>

#include "station/cli/command.hpp"
#include "station/core/problem.hpp"
#include "station/scene/planner.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"

using namespace turnpoint;

namespace {

const std::string kRig = std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml";

struct End {
  int status = 0;
  std::string said;
};

template <class Error>
End ending_with(const Error& error) {
  std::ostringstream err;
  const int status = cli::exit_status(err, [&]() -> int { throw error; });
  return {status, err.str()};
}

int status_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), TURNPOINT);
  Child child(arguments);
  REQUIRE(child.ends_within(20000));
  CAPTURE(child.said());
  CHECK(child.said().find("please report") == std::string::npos);
  return child.outcome();
}

}  // namespace

TEST_CASE("the exit status says whose mistake it was", "[cli]") {
  CHECK(ending_with(core::BadInput({{{"a.toml", 3, 1}, core::plain("what"), core::plain("allowed")}}))
            .status == 2);
  CHECK(ending_with(core::UsageError("--x 3: 1 and 2 are allowed")).status == 2);
  CHECK(ending_with(scene::Unreachable(core::plain("no frequency reaches 900 mm"))).status == 2);
  CHECK(ending_with(std::system_error(EIO, std::generic_category(), "a.sqlite")).status == 1);
  for (const auto& end :
       {ending_with(std::logic_error("started twice")), ending_with(std::invalid_argument("n is 0")),
        ending_with(std::out_of_range("map::at"))}) {
    CHECK(end.status == 70);
    CHECK(end.said.find("Please report it") != std::string::npos);
  }
}

TEST_CASE("no message repeats a password", "[cli]") {
  const auto said = [](const std::string& what) { return ending_with(std::runtime_error(what)).said; };
  for (const auto* address : {"postgresql://lab:geheim@host/x", "postgres://lab:geheim@host", "host=lab password=geheim",
                              "service=lab password = 'geheim \\' geheim' user=x"})
    CHECK(said(std::string("there is no file ") + address).find("geheim") == std::string::npos);
  CHECK(said("there is no file a:b@c.sqlite") == "turnpoint: there is no file a:b@c.sqlite\n");
  CHECK(said("postgresql://lab:geheim@host/x: gone") == "turnpoint: postgresql://lab:...@host/x: gone\n");
}

TEST_CASE("numbers that the physics library refuses count as the user's mistake", "[cli]") {
  CHECK(status_of({"map", "--rig", kRig, "--frequency", "30000", "--edge", "nowhere"}) == 2);
  CHECK(status_of({"map", "--rig", kRig, "--frequency", "30000", "--model", "fem"}) == 2);
  for (const char* frequency_Hz : {"1e300", "1e9", "1e-300"}) {
    CHECK(status_of({"map", "--rig", kRig, "--frequency", frequency_Hz}) == 2);
    CHECK(status_of({"field", "--rig", kRig, "--tone", frequency_Hz, "--points", "11"}) == 2);
  }
  CHECK(status_of({"field", "--rig", kRig, "--tone", "30000", "--points", "1"}) == 2);
  CHECK(status_of({"field", "--rig", kRig, "--tone", "-5", "--points", "10"}) == 2);
  CHECK(status_of({"field", "--rig", kRig, "--tone", "30000", "--at", "100", "--model", "edge"}) == 2);
  CHECK(status_of({"run", "nowhere.toml", "--rig", kRig, "--observer", "sim:threshold=many"}) != 70);
}
