#include <string>

#include "station/core/toml.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::core;

namespace {

bool accepted(const std::string& source) {
  try {
    parse_toml(source, "t.toml");
    return true;
  } catch (const BadInput& bad) {
    CHECK(bad.problems().front().place.line > 0);
    return false;
  }
}

}  // namespace

TEST_CASE("the reader accepts what TOML 1.0 allows", "[text]") {
  for (const std::string source : {"[fruit]\napple.color=1\n[fruit.apple.texture]\nsmooth=true\n",
                                   "[[a.b]]\nx=1\n[[a.b]]\n[a.b.c]\ny=1\n",
                                   "[a.b]\n[a]\nx=1\n",
                                   "[a]\nb.c=1\nb.d=2\n[e]\n",
                                   "a={b.c=1,b.d=2}",
                                   "a=[1,2,]",
                                   "a=0xDEAD_BEEF",
                                   "a=-0",
                                   "a=+0",
                                   "a=-0.0",
                                   "a=1e+5",
                                   "a=1E5",
                                   "a=+inf",
                                   "a=-nan",
                                   "a=9223372036854775807",
                                   "a=-9223372036854775808",
                                   "a=1979-05-27",
                                   "a=1979-05-27T07:32:00Z",
                                   "a=1979-05-27 07:32:00",
                                   "a=07:32:00.5",
                                   "a=1980-02-29",
                                   "a=1979-05-27T07:32:00-07:00",
                                   "a=1979-05-27 \nb=1",
                                   "a=1979-05-27 07:32:00 # c",
                                   "a=\"\\u00e9\\U0001F600\"",
                                   "a=\"\"\"\nx\\\n   y\"\"\"",
                                   "a=\"\"\"x\"\"\"\"\"",
                                   "a='''x'''''",
                                   "a=''''''",
                                   "\"a b\"=1\n'c'=2\n\"\"=3",
                                   "[ a . b ]\n",
                                   "a. b =1",
                                   "a=1\r\nb=2\r\n",
                                   "a='\t'",
                                   "a=\"\t\"",
                                   "\357\273\277a=1",
                                   "a=[1,'x',{b=1}]",
                                   "a.b.c=1\n[a.d]\n",
                                   "[[a.b]]\n[a]\nc=1\n",
                                   "[[a]]\nb.c=1\n[[a]]\nb.c=2\n",
                                   "[[a]]\n[a.b]\n[[a]]\n[a.b]\n",
                                   "[[a]]\n[[a.b]]\n[[a.b]]\n[[a]]\n[[a.b]]\n[a.b.x]",
                                   "a=1_000.5_5e1_0",
                                   "a=0o17",
                                   "a=0b1",
                                   "a=5e-324",
                                   "a=1e-400",
                                   "a=0.5",
                                   "a=0e0",
                                   "a=-1",
                                   "a=+1",
                                   "a=\"\"\"\\   \n\n\n  x\"\"\"",
                                   "a=\"\"\"\\\\\"\"\"",
                                   "a = [ # c\n1 # d\n, # e\n2 ]",
                                   "a={b=[\n1,\n2\n]}",
                                   "a={ }",
                                   "a={b={c={}}}",
                                   "A-b_1=1",
                                   "3.14=1",
                                   "a.\"b.c\".d=1\n",
                                   "[a.\"b.c\"]\n[a.'x y'.z]",
                                   " [a]\n  b=1",
                                   "a=1 #c\n#d",
                                   "\n",
                                   "\r\n",
                                   "#",
                                   "a='\303\251' #\303\251",
                                   "b=\"\"\"\303\251\\\n \303\251\"\"\"",
                                   "a=1979-05-27t07:32:00z",
                                   "a=1979-05-27 07:32:00Z\n",
                                   "a=0000-01-01",
                                   "a=07:32:00.123456789123",
                                   "a=\"\"\"\r\nx\r\ny\"\"\"",
                                   "a='''\r\nx'''",
                                   "a=[[[]]]",
                                   "a=[[1,2],[3]]"}) {
    INFO(source);
    CHECK(accepted(source));
  }
}

TEST_CASE("the reader refuses what TOML 1.0 forbids, at a place", "[text]") {
  for (const std::string source : {"[a.b.c]\nz=9\n[a]\nb.c.t=1\n",
                                   "[fruit]\napple.color=1\napple.taste.sweet=true\n[fruit.apple]\n",
                                   "a={b=1}\na.c=2\n",
                                   "a={b=1}\n[a.c]\n",
                                   "[[a]]\n[a]\n",
                                   "a=[]\n[[a]]\n",
                                   "[a]\n[[a]]\n",
                                   "[a]\n[a]\n",
                                   "x=1\n[x]\n",
                                   "a.b=1\na.c=2\na.b.d=3\n",
                                   "a={b=1,}",
                                   "a={\nb=1}",
                                   "a=[1,,2]",
                                   "a=[,1]",
                                   "a=+0x1",
                                   "a=0x_1",
                                   "a=1__0",
                                   "a=_1",
                                   "a=01",
                                   "a=1.",
                                   "a=.5",
                                   "a=1e",
                                   "a=1.e5",
                                   "a=1e400",
                                   "a=9223372036854775808",
                                   "a=1979-05-27T07:32",
                                   "a=07:32",
                                   "a=07:32:60",
                                   "a=1979-02-29",
                                   "a=1979-05-27T07:32:00+24:00",
                                   "a=1979-05-27T",
                                   "a=\"\\uD800\"",
                                   "a=\"\\x41\"",
                                   "a=\"\\e\"",
                                   "a=\"\"\"x\"\"\"\"\"\"",
                                   "a = 1 b = 2",
                                   "= 1",
                                   "a",
                                   "a =",
                                   "a = #",
                                   "[a",
                                   "[a]]",
                                   "[[a]",
                                   "[ [a] ]\n",
                                   "[]",
                                   "[a.]",
                                   "[.a]",
                                   "a..b=1",
                                   "a=1\rb=2",
                                   "# \001",
                                   "a=\"\177\"",
                                   "a=1\n\357\273\277b=1",
                                   "a=true1",
                                   "a=TRUE",
                                   "a=truE",
                                   "a=nan1",
                                   "a=[{b=1},{b=2}]\n[a.c]",
                                   "a=[{}]\n[[a]]",
                                   "[a]\nb={}\n[a.b.c]",
                                   "a.b.c=1\n[a]\n",
                                   "a.b.c=1\n[a.b]\n",
                                   "[x.y]\n[x]\ny.z=1\n",
                                   "[x]\ny.z=1\n[x.y.w]\nv=1\n[x]\n",
                                   "a = \"x\" \"y\"",
                                   "a=0b102",
                                   "a=0o8",
                                   "a=0x",
                                   "a=-0x1",
                                   "a=1e5.5",
                                   "a=00.5",
                                   "a=--1",
                                   "a=1-",
                                   "a=1:",
                                   "a=\"abc\n\"",
                                   "a=\"\\\n\"",
                                   "a=\"\"\"\\ x\"\"\"",
                                   "a=\"\"\"\\\"\"\"",
                                   "a = {b = 1 # c\n}",
                                   "1=1\n1.2=3\n",
                                   "a=2000-00-01",
                                   "a=2000-13-01",
                                   "a=24:00:00",
                                   "a=07:32:00.",
                                   "a=1979-5-27",
                                   "a=\"\"\"x\ry\"\"\"",
                                   "\"\"\"a\"\"\"=1",
                                   "a=[1 2]",
                                   "a=[1\n2]",
                                   "a=[\"x\"\"y\"]",
                                   "a={b=1 c=2}",
                                   "a={b=1,b=2}",
                                   "a={b=1,b.c=2}",
                                   "a={b.c=1,b=2}",
                                   "[a]\n\n\n[b]\na=1\na=2",
                                   "a = \"\377\"",
                                   "a = \"\"\"x\\\n \340\"\"\""}) {
    INFO(source);
    CHECK_FALSE(accepted(source));
  }
}

TEST_CASE("the reader gives each value, with its place", "[text]") {
  const auto read = parse_toml(
      "a = 0x1F\nb = -1_000.5e-1\n[c.d]\n\"e f\" = 'x'  # no value\n[[g]]\nh.i = [true, "
      "1979-05-27]\n[[g]]\n[c]\nz = {y = inf}\n",
      "t.toml");
  CHECK(read.find("a")->value.integer == 31);
  CHECK(read.find("b")->value.number == -100.05);
  const auto& c = read.find("c")->value;
  CHECK(c.find("d")->value.find("e f")->value.string == "x");
  CHECK(c.find("d")->value.find("e f")->value.place.line == 4);
  CHECK(c.find("d")->value.find("e f")->value.place.column == 9);
  CHECK(c.find("z")->value.find("y")->value.number > 1e308);
  const auto& g = read.find("g")->value;
  REQUIRE(g.items.size() == 2);
  const auto& list = g.items[0].find("h")->value.find("i")->value;
  CHECK(list.items[0].boolean);
  CHECK(list.items[1].kind == Value::Kind::date);
}

TEST_CASE("a table or a list is at most 10 000 long, and the longest is read at once", "[text]") {
  const auto keys = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "a" + std::to_string(i) + "=1\n";
    return text;
  };
  const auto tables = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += "[a" + std::to_string(i) + ".b]\n";
    return text;
  };
  const auto list = [](int count) {
    std::string text = "a=[0";
    for (int i = 1; i < count; ++i) text += ",0";
    return text + "]";
  };
  CHECK(accepted(keys(10'000)));
  CHECK_FALSE(accepted(keys(10'001)));
  CHECK(accepted(tables(10'000)));
  CHECK_FALSE(accepted(tables(10'001)));
  CHECK(accepted(list(10'000)));
  CHECK_FALSE(accepted(list(10'001)));
}
