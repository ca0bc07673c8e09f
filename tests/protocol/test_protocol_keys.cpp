// The schema for editors and the page's reference are made from the declarations of the keys. To write both
// anew: test_protocol "[.write]"
#include "station/protocol/protocol_keys.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/generated.hpp"

using namespace turnpoint;

namespace {
std::string schema() {
  return core::json_schema(protocol::protocol_keys(), "Turnpoint protocol file (friction-protocol/1)");
}
}  // namespace

TEST_CASE("the protocol schema for editors follows from the declared keys", "[protocol]") {
  CHECK(tests::in_source("protocols/protocol.schema.json") == schema());
}

TEST_CASE("the reference of protocol keys on the page follows from the declared keys", "[protocol]") {
  CHECK(tests::generated_part("protocols/README.md") == core::reference(protocol::protocol_keys()));
}

TEST_CASE("writes the schema and the reference of protocols", "[.write]") {
  tests::write_source("protocols/protocol.schema.json", schema());
  tests::write_generated_part("protocols/README.md", core::reference(protocol::protocol_keys()));
}
