#include "station/store/read.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"

using namespace turnpoint;

namespace {

constexpr int kPatience_ms = 20000;

std::vector<std::string> withdraw(const std::string& database, const std::vector<std::string>& how = {}) {
  std::vector<std::string> command = {TURNPOINT, "withdraw", "--db", database, "--participant", "P01"};
  command.insert(command.end(), how.begin(), how.end());
  return command;
}

}  // namespace

TEST_CASE("withdraw lists what it would delete, and deletes it only after the code was typed", "[cli]") {
  const TemporaryFolder folder;
  const auto database = folder / "lab.sqlite";
  const auto id = sample::session(database, 3);
  sample::session(database, 2, sample::start("P02"));
  for (const auto* answer : {"", "yes", "P02"}) {
    Child child(withdraw(database));
    REQUIRE(child.says("to delete: ", kPatience_ms));
    CHECK(child.said().find("would be deleted: session " + id) != std::string::npos);
    child.type(answer);
    REQUIRE(child.ends_within(kPatience_ms));
    CHECK(child.outcome() == 1);
    CHECK(child.said().find("Nothing was deleted.") != std::string::npos);
    CHECK(store::list_sessions(database).size() == 2);
  }
  Child child(withdraw(database));
  REQUIRE(child.says("to delete: ", kPatience_ms));
  child.type("P01");
  REQUIRE(child.ends_within(kPatience_ms));
  CHECK(child.outcome() == 0);
  CHECK(store::list_sessions(database).size() == 1);
}

TEST_CASE("with --yes withdraw asks for nothing, and with --dry-run it deletes nothing", "[cli]") {
  const TemporaryFolder folder;
  const auto database = folder / "lab.sqlite";
  sample::session(database, 3);
  Child look(withdraw(database, {"--dry-run"}));
  REQUIRE(look.ends_within(kPatience_ms));
  CHECK(look.outcome() == 0);
  CHECK(store::list_sessions(database).size() == 1);
  Child child(withdraw(database, {"--yes"}));
  REQUIRE(child.ends_within(kPatience_ms));
  CHECK(child.outcome() == 0);
  CHECK(store::list_sessions(database).empty());
}
