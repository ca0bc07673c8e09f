#include "station/core/canonical.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::core;

TEST_CASE("files with the same content have the same canonical form", "[text][canonical]") {
  const auto a = canonical(parse_toml("# a comment\nb = 1.50\na = [1, \"x\"]\n[t]\nk = true\n", "a"));
  const auto b = canonical(parse_toml("a = [ 1,\"x\" ]\nb = 15e-1\nt = { k = true }\n", "b"));
  CHECK(a == b);
  CHECK(a == R"({"a":[1,"x"],"b":1.5,"t":{"k":true}})");
}

TEST_CASE("another value gives another canonical form", "[text][canonical]") {
  const auto form = [](const char* source) { return canonical(parse_toml(source, "a")); };
  CHECK(form("a = 1") != form("a = 2"));
  CHECK(form("a = [1, 2]") != form("a = [2, 1]"));
  CHECK(form("a = \"\\\"q\\\"\"") == "{\"a\":\"\\\"q\\\"\"}");
  CHECK(form("a = inf") == "{\"a\":\"inf\"}");
}
