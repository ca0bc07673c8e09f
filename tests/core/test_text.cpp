#include <limits>

#include "station/core/number.hpp"
#include "station/core/problem.hpp"
#include "station/core/reader.hpp"
#include "station/core/sha256.hpp"
#include "station/core/toml.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::core;

TEST_CASE("SHA-256 gives the published digests at every padding length", "[text]") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(std::string(1000000, 'a')) ==
        "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("SHA-256 does not depend on how the data are divided into pieces", "[text]") {
  std::string bytes;
  for (int i = 0; i < 200; ++i) bytes += static_cast<char>(i * 37);
  for (std::size_t first = 0; first <= bytes.size(); first += 9)
    for (std::size_t second = first; second <= bytes.size(); second += 13) {
      Sha256 hash;
      for (const auto& piece :
           {bytes.substr(0, first), bytes.substr(first, second - first), bytes.substr(second)})
        hash.add(piece);
      REQUIRE(hash.hex() == sha256(bytes));
    }
}

TEST_CASE("a number for people has no insignificant digits", "[text]") {
  CHECK(number(0.1 + 0.2) == "0.3");
  CHECK(number(198.65394, 6) == "198.654");
  CHECK(number(22400) == "22400");
  CHECK(number(-0.0) == "0");
  CHECK(number(std::numeric_limits<double>::infinity()) == "none");
}

TEST_CASE("a number written for a file reads back as the same double", "[text]") {
  for (const double value : {0.1, 1.0 / 3.0, 6621.3, 1e-300}) CHECK(std::stod(exact(value)) == value);
  CHECK(exact(std::numeric_limits<double>::quiet_NaN()) == "n/a");
}

TEST_CASE("a problem names file, line, column, what is wrong and what is allowed", "[text]") {
  using turnpoint::core::plain;
  CHECK(format({{"a.toml", 3, 7}, plain("unknown key \"x\""), plain("nearest: \"y\"")}) ==
        "a.toml:3:7: unknown key \"x\"; nearest: \"y\"");
  CHECK(format({{"a.toml", 0, 0}, plain("no such file"), {}}) == "a.toml: no such file");
}

TEST_CASE("the nearest word is suggested only if the word may be a typing error", "[text]") {
  CHECK(nearest("boundry_mm", {"boundary_mm", "edge"}) == "boundary_mm");
  CHECK(nearest("zzz", {"boundary_mm", "edge"}).empty());
}

TEST_CASE("letters beyond ASCII are allowed only in strings and comments", "[text]") {
  const auto document = parse_toml(
      "\xEF\xBB\xBF"
      R"TOML(# é ひ
a = "é" # ひ
b = 'ひ"'
c = """x\
  ひé\\
é"""
d = '''é''''
)TOML",
      "f");
  REQUIRE(document.find("a")->value.string == "é");
  REQUIRE(document.find("b")->value.string == "ひ\"");
  REQUIRE(document.find("c")->value.string == "xひé\\\né");
  REQUIRE(document.find("d")->value.string == "é'");
  for (const std::string source :
       {"größe = 2", "a = 1 é", "a = [1, ひ]", R"(a = ""é)", R"(a = """""" é)", R"(a = "\é")"}) {
    INFO(source);
    try {
      parse_toml("b = 1\n" + source, "f.toml");
      FAIL("accepted");
    } catch (const BadInput& error) {
      REQUIRE(error.problems().at(0).place.line == 2);
      REQUIRE_FALSE(error.problems().at(0).allowed.empty());
    }
  }
}

TEST_CASE("an estimate is printed to the digits that its uncertainty justifies", "[text]") {
  CHECK(estimated(3e-16, 0.9) == "0.00");
  CHECK(estimated(-1.63e-15, 0.05) == "0.000");
  CHECK(estimated(-19.64712, 6.3) == "-19.6");
  CHECK(estimated(0.10283, 0.029) == "0.103");
  CHECK(estimated(1234.5, 700) == "1234");
  CHECK(estimated(2.5, 0) == "2.5");
  CHECK(uncertainty(2, 1, 45) == 0.5);
  CHECK(uncertainty(0, 0, 0.06) == 0.015);
  CHECK(estimated(std::numeric_limits<double>::quiet_NaN(), 1) == "none");
}

TEST_CASE("keys with too many parts and lists with too many items are refused at their place", "[text]") {
  std::string deep = "x = 1\n", list = "y = [";
  for (int i = 0; i < 50'000; ++i) deep += "a.", list += "1,";
  const auto refused = [](const std::string& source) -> std::string {
    try {
      parse_toml(source, "t.toml");
    } catch (const BadInput& bad) {
      return format(bad.problems().front());
    }
    return "";
  };
  CHECK(refused(deep + "b = 1\n").find("t.toml:2:") == 0);
  CHECK(refused("z = { " + deep.substr(6) + "b = 1 }\n").find("parts") != std::string::npos);
  CHECK(refused(list + "1]\n").find("at most 10000") != std::string::npos);
  CHECK(refused("a.b.c.d = [1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, 8.5, 9.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5, "
                "8.5]") == "");
}

TEST_CASE("a key is declared once: what is not declared cannot be read, and what is not read is not accepted",
          "[text]") {
  const Keys keys{
      key::word("kind", {"pulse", "tone"}, "what it is").by_default("\"pulse\""),
      key::number("length_ms", {0, 10, Range::Ends::open_low, "ms"}, "its length").by_default("2"),
      key::number("frequency_Hz", {20, 2000}, "its frequency").required().only_with("kind", {"tone"})};
  const auto said = [&](const std::string& source) {
    const auto table = parse_toml(source, "a.toml");
    Findings findings;
    TableReader reader(table, "marker", findings, keys);
    const auto kind = reader.word("kind");
    reader.number("length_ms");
    if (kind == "tone") reader.number("frequency_Hz");
    reader.finish();
    std::string all;
    for (const auto& problem : findings.problems) all += format(problem) + "\n";
    return all;
  };
  CHECK(said("").empty());
  CHECK(said("kind = \"tone\"\nfrequency_Hz = 250").empty());
  CHECK(said("kind = \"tone\"").find("needs the key \"frequency_Hz\"; a number from 20 to 2000") !=
        std::string::npos);
  CHECK(said("frequency_Hz = 250")
            .find("\"frequency_Hz\" has no effect in [marker]; only with kind = \"tone\"") !=
        std::string::npos);
  CHECK(said("length_ms = 11").find("allowed: above 0 and at most 10 ms") != std::string::npos);
  CHECK(said("lenght_ms = 1").find("did you mean \"length_ms\"?") != std::string::npos);
  const auto table = parse_toml("length_ms = 1", "a.toml");
  Findings findings;
  TableReader reader(table, "marker", findings, keys);
  CHECK_THROWS_AS(reader.number("lenght_ms"), std::logic_error);
  CHECK_THROWS_AS(reader.boolean("kind"), std::logic_error);
  CHECK_THROWS_AS(reader.finish(), std::logic_error);  // length_ms was not read
}
