// The schema for editors and the page's reference are made from the declarations of the keys. To write both
// anew: test_rig "[.write]"
#include "station/rig/rig.hpp"
#include "station/rig/rig_keys.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/generated.hpp"

using namespace turnpoint;

namespace {
std::string schema() { return core::json_schema(rig::rig_keys(), "Turnpoint rig file (friction-rig/1)"); }
}  // namespace

TEST_CASE("the rig schema for editors follows from the declared keys", "[rig]") {
  CHECK(tests::in_source("deploy/rigs/rig.schema.json") == schema());
}

TEST_CASE("the reference of rig keys on the page follows from the declared keys", "[rig]") {
  CHECK(tests::generated_part("deploy/rigs/README.md") == core::reference(rig::rig_keys()));
}

TEST_CASE("writes the schema and the reference of rigs", "[.write]") {
  tests::write_source("deploy/rigs/rig.schema.json", schema());
  tests::write_generated_part("deploy/rigs/README.md", core::reference(rig::rig_keys()));
}
