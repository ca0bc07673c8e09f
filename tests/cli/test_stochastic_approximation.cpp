#include "tests/support/stochastic_approximation.hpp"

#include <fstream>
#include <iterator>

#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

std::string said_by(const std::vector<std::string>& command, int outcome = 0) {
  Child child(command);
  REQUIRE(child.ends_within(60'000));
  INFO(child.said());
  CHECK(child.outcome() == outcome);
  return child.said();
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("an accelerated stochastic approximation is checked, run and reported", "[cli]") {
  const TemporaryFolder folder;
  const auto protocol = folder / "asa.toml", db = folder / "lab.sqlite";
  std::ofstream(protocol) << stochastic_approximation();
  const auto rig = std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml";
  CHECK(contains(said_by({TURNPOINT, "check", protocol, "--rig", rig}), "is good on"));
  const auto summary = said_by({TURNPOINT, "run", protocol, "--rig", rig, "--participant", "P01", "--db", db,
                                "--observer", "sim:threshold=-16", "--seed", "7", "--headless"});
  CHECK(contains(summary, "a: threshold "));
  CHECK(contains(summary, "(the level after 20 answers with "));
  said_by({TURNPOINT, "report", "--db", db, "--out", folder / "P01.html"});
  std::ifstream file(folder / "P01.html");
  const std::string html{std::istreambuf_iterator<char>(file), {}};
  CHECK(contains(html, "the level after 20 answers with "));
  CHECK_FALSE(contains(html, "nan"));
}

TEST_CASE("bad keys of an accelerated stochastic approximation are refused with their lines", "[cli]") {
  const TemporaryFolder folder;
  const auto protocol = folder / "asa.toml";
  auto source = stochastic_approximation();
  source.replace(source.find("target = 0.794"), 14, "target = 79.4");
  source.replace(source.find("step = 8.0"), 10, "step = -8.0");
  std::ofstream(protocol) << source;
  const auto said = said_by({TURNPOINT, "check", protocol}, 2);
  CHECK(contains(said, protocol + ":51:10: \"target\" is 79.4"));
  CHECK(contains(said, protocol + ":60:8: \"step\" is -8"));
}
