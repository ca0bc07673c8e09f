// The schema for editors and the page of keys are made from the declarations of the keys. To write both
// anew: test_rig "[.write]"
#include "station/rig/rig.hpp"
#include "station/rig/rig_keys.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/generated.hpp"

using namespace turnpoint;

namespace {
std::string schema() { return core::json_schema(rig::rig_keys(), "Turnpoint rig file (friction-rig/1)"); }

std::string page() {
  return "# Keys of a rig file\n\n"
         "Every key, what it may be, and what holds without it. [The page on rigs](README.md) explains how "
         "they work\n"
         "together. This page and `rig.schema.json`, which editors read, are made from the declarations in\n"
         "`station/rig/rig_keys.cpp` (`test_rig \"[.write]\"` writes both).\n" +
         core::reference(rig::rig_keys());
}
}  // namespace

TEST_CASE("the rig schema for editors follows from the declared keys", "[rig]") {
  CHECK(tests::in_source("deploy/rigs/rig.schema.json") == schema());
}

TEST_CASE("the page of rig keys follows from the declared keys", "[rig]") {
  CHECK(tests::in_source("deploy/rigs/keys.md") == page());
}

TEST_CASE("writes the schema and the page of rig keys", "[.write]") {
  tests::write_source("deploy/rigs/rig.schema.json", schema());
  tests::write_source("deploy/rigs/keys.md", page());
}
