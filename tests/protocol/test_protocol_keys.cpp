// The schema for editors and the page of keys are made from the declarations of the keys. To write both
// anew: test_protocol "[.write]"
#include "station/protocol/protocol_keys.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/generated.hpp"

using namespace turnpoint;

namespace {
std::string schema() {
  return core::json_schema(protocol::protocol_keys(), "Turnpoint protocol file (friction-protocol/1)");
}

std::string page() {
  return "# Keys of a protocol file\n\n"
         "Every key, what it may be, and what holds without it. [The guide](README.md) explains how they "
         "work\n"
         "together. This page and `protocol.schema.json`, which editors read, are made from "
         "the\n"
         "declarations in `station/protocol/protocol_keys.cpp` and in the files of `station/procedure`\n"
         "(`test_protocol \"[.write]\"` writes both).\n\n"
         "\"Number or expression\" is a number, or arithmetic on factors in quotes, such as `\"150 + "
         "offset_mm\"`.\n"
         "\"Text in each language\" is `{ en = \"...\", de = \"...\" }`. A list has its values in "
         "brackets.\n" +
         core::reference(protocol::protocol_keys());
}
}  // namespace

TEST_CASE("the protocol schema for editors follows from the declared keys", "[protocol]") {
  CHECK(tests::in_source("protocols/protocol.schema.json") == schema());
}

TEST_CASE("the page of protocol keys follows from the declared keys", "[protocol]") {
  CHECK(tests::in_source("protocols/keys.md") == page());
}

TEST_CASE("writes the schema and the page of protocol keys", "[.write]") {
  tests::write_source("protocols/protocol.schema.json", schema());
  tests::write_source("protocols/keys.md", page());
}
