// Tests which blocks a session has, and in which order, with groups of participants, planned sessions, and
// Latin squares over both.
#include <map>
#include <set>
#include <string>
#include <vector>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/interludes.hpp"
#include "station/protocol/visits.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using protocol::Visit;

namespace {

std::string shipped(const std::string& name) {
  return core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
}

void put(std::string& text, const std::string& before, const std::string& what) {
  const auto at = text.find(before);
  REQUIRE(at != std::string::npos);
  text.insert(at, what);
}

std::vector<std::string> names(const protocol::Protocol& protocol, const Visit& visit) {
  std::vector<std::string> all;
  for (const auto& block : block_order(protocol, visit)) all.push_back(block.name);
  return all;
}

/// The demo protocol with a sequence over this number of levels (a, b, c, ...), sessions and groups.
protocol::Protocol square(int levels, int sessions, const std::string& each_session, int groups = 1) {
  auto text = shipped("demo");
  std::string list, group_list;
  for (int i = 0; i < levels; ++i)
    list += std::string(i ? ", " : "") + "\"" + static_cast<char>('a' + i) + "\"";
  for (int i = 0; i < groups; ++i) group_list += (i ? ", \"g" : "\"g") + std::to_string(i) + "\"";
  text.erase(text.find("[[block]]"));
  put(text, "[task]", "[[factor]]\nname = \"surface\"\nlevels = [" + list + "]\n");
  if (groups > 1)
    put(text, "[task]",
        "[[factor]]\nname = \"team\"\nlevels = [" + group_list + "]\ndraw = \"per-participant\"\n");
  if (sessions > 1) text += "[sessions]\ncount = " + std::to_string(sessions) + "\n";
  text +=
      "[[sequence]]\nname = \"surfaces\"\ndesign = \"latin-square\"\nover = \"surface\"\neach_session = \"" +
      each_session + "\"\nblock = { procedures = [\"levels\"] }\n";
  return protocol::parse(text, "p.toml");
}

std::string order(const protocol::Protocol& protocol, const Visit& visit) {
  std::string letters;
  for (const auto& block : block_order(protocol, visit))
    letters += std::get<std::string>(block.fixed.at("surface"));
  return letters;
}

/// Counts how often each letter follows each other letter.
void count_pairs(const std::string& letters, std::map<std::string, int>& pairs) {
  for (std::size_t i = 1; i < letters.size(); ++i) ++pairs[letters.substr(i - 1, 2)];
}

}  // namespace

TEST_CASE("each session and group of a plan has its own blocks", "[protocol]") {
  const auto protocol = protocol::parse(shipped("friction-training"), "p.toml");
  using Names = std::vector<std::string>;
  CHECK(names(protocol, {0, 1}) == Names{"practice", "before", "training-with-feedback"});
  CHECK(names(protocol, {0, 2}) == Names{"training-with-feedback"});
  CHECK(names(protocol, {0, 3}) == Names{"training-with-feedback", "after"});
  CHECK(names(protocol, {1, 1}) == Names{"practice", "before", "training-without-feedback"});
  CHECK(names(protocol, {1, 3}) == Names{"training-without-feedback", "after"});
  CHECK(names(protocol, {6, 2}) == names(protocol, {0, 2}));
  CHECK(names(protocol, {7, 2}) == names(protocol, {1, 2}));
  CHECK(protocol::group_names(protocol) == Names{"feedback", "none"});
  CHECK(protocol::in_words(protocol, {5, 2}) == "session 2, group none");
  CHECK_THROWS_AS(block_order(protocol, {0, 0}), std::invalid_argument);
  for (const auto& visit : protocol::different_visits(protocol))
    for (const auto& block : block_order(protocol, visit))
      CHECK(std::get<std::string>(block.fixed.at("training")) ==
            (visit.place % 2 == 0 ? "feedback" : "none"));
}

TEST_CASE("two factors of groups make groups of all combinations, equally often", "[protocol]") {
  auto text = shipped("friction-training");
  put(text, "[scene.reference]",
      "[[factor]]\nname = \"hand_mm\"\nlevels = [1, 2, 3]\ndraw = \"per-participant\"\n");
  const auto protocol = protocol::parse(text, "p.toml");
  CHECK(protocol::group_count(protocol) == 6);
  CHECK(protocol::group_names(protocol).at(1) == "none, hand 1 mm");
  CHECK(protocol::group_names(protocol).at(2) == "feedback, hand 2 mm");
  std::map<protocol::Factors, int> groups;
  for (int place = 0; place < 12; ++place) ++groups[protocol::group_of(protocol, place)];
  CHECK(groups.size() == 6);
  for (const auto& [group, count] : groups) CHECK(count == 2);
}

TEST_CASE("with each session the participant goes to the next row of the square", "[protocol]") {
  const auto protocol = square(4, 4, "all");
  CHECK(order(protocol, {0, 1}) == "abdc");
  std::map<std::string, int> over_sessions, over_participants;
  std::set<std::string> rows;
  for (int session = 1; session <= 4; ++session) {
    CHECK(order(protocol, {2, session}).size() == 4);
    rows.insert(order(protocol, {2, session}));
    count_pairs(order(protocol, {2, session}), over_sessions);
  }
  CHECK(rows.size() == 4);  // one participant gets all rows of the balanced Latin square
  for (int place = 0; place < 4; ++place) count_pairs(order(protocol, {place, 3}), over_participants);
  for (const auto& pairs : {over_sessions, over_participants}) {
    CHECK(pairs.size() == 12);
    for (const auto& [pair, count] : pairs) CHECK(count == 1);
  }
}

TEST_CASE("with one level in each session, the square orders the sessions, in each group", "[protocol]") {
  for (const int levels : {2, 3, 4, 5})
    for (const int groups : {1, 2}) {
      const auto protocol = square(levels, levels, "one", groups);
      const int rows = levels % 2 == 0 ? levels : 2 * levels;
      for (int group = 0; group < groups; ++group) {
        INFO(levels << " levels, group " << group << " of " << groups);
        std::map<std::string, int> pairs;
        std::vector<std::map<std::string, int>> in_session(static_cast<std::size_t>(levels));
        for (int row = 0; row < rows; ++row) {
          std::string letters;
          for (int session = 1; session <= levels; ++session) {
            const auto letter = order(protocol, {row * groups + group, session});
            REQUIRE(letter.size() == 1);
            ++in_session[static_cast<std::size_t>(session - 1)][letter];
            letters += letter;
          }
          CHECK(std::set(letters.begin(), letters.end()).size() == letters.size());
          count_pairs(letters, pairs);
        }
        CHECK(pairs.size() == static_cast<std::size_t>(levels * (levels - 1)));
        for (const auto& [pair, count] : pairs) CHECK(count == rows / levels);
        for (const auto& counts : in_session)
          for (const auto& [letter, count] : counts) CHECK(count == rows / levels);
      }
    }
}

TEST_CASE("a sequence that is absent from some sessions counts only its own", "[protocol]") {
  auto text = shipped("demo");
  put(text, "[task]", "[[factor]]\nname = \"surface\"\nlevels = [\"a\", \"b\"]\n");
  text +=
      "[sessions]\ncount = 4\n[[sequence]]\nname = \"surfaces\"\ndesign = \"latin-square\"\nover = "
      "\"surface\"\nsessions = [2, 4]\neach_session = \"one\"\nblock = { procedures = [\"levels\"] }\n";
  const auto protocol = protocol::parse(text, "p.toml");
  const auto last = [&](const Visit& visit) {
    const auto blocks = block_order(protocol, visit);
    const auto found = blocks.back().fixed.find("surface");
    return found == blocks.back().fixed.end() ? "" : std::get<std::string>(found->second);
  };
  CHECK(last({0, 1}).empty());
  CHECK(last({0, 2}) == "a");
  CHECK(last({0, 3}).empty());
  CHECK(last({0, 4}) == "b");
  CHECK(last({1, 2}) == "b");
  CHECK(last({1, 4}) == "a");
}

TEST_CASE("a questionnaire of the last session is asked only there", "[protocol]") {
  auto text = shipped("boundary-visit");
  put(text, "[protocol]", "[sessions]\ncount = 2\n");
  text.replace(text.find("[[consent]]"), 11, "[[consent]]\nsessions = [1]");
  const auto protocol = protocol::parse(text, "p.toml");
  const auto asked = [&](int session) {
    std::set<std::string> all;
    const auto blocks = block_order(protocol, {0, session});
    for (std::size_t next = 0; next <= blocks.size(); ++next)
      for (const auto* interlude : interludes_before(protocol, blocks, next, {0, session}))
        all.insert(interlude->name);
    return all;
  };
  auto second = asked(2);
  CHECK(second.size() + 1 == asked(1).size());
  second.insert(protocol.interludes.front().name);
  CHECK(second == asked(1));
}

TEST_CASE("places that differ by the number of different places have the same blocks", "[protocol]") {
  const auto plan = [](const protocol::Protocol& protocol, int place) {
    std::string words;
    for (int session = 1; session <= protocol::session_count(protocol); ++session)
      for (const auto& block : block_order(protocol, {place, session})) {
        words += block.name;
        for (const auto& [factor, level] : block.fixed) words += " " + std::get<std::string>(level);
        words += ";";
      }
    return words;
  };
  const auto period = [&](const protocol::Protocol& protocol) {
    std::vector<std::string> plans;
    for (int place = 0; place < 120; ++place) plans.push_back(plan(protocol, place));
    for (std::size_t length = 1; length < 60; ++length)
      if (std::equal(plans.begin() + static_cast<std::ptrdiff_t>(length), plans.end(), plans.begin()))
        return static_cast<int>(length);
    return 0;
  };
  for (const int levels : {2, 3, 4, 5, 6})
    for (const int groups : {1, 2, 3}) {
      INFO(levels << " levels, " << groups << " groups");
      const auto one = square(levels, 1, "all", groups);
      CHECK(protocol::place_count(one) == period(one));
      const auto several = square(levels, levels, "one", groups);
      CHECK(protocol::place_count(several) == period(several));
    }
  // two squares together repeat only when both do
  auto text = shipped("demo");
  text.erase(text.find("[[block]]"));
  put(text, "[task]",
      "[[factor]]\nname = \"surface\"\nlevels = [\"a\", \"b\", \"c\", \"d\"]\n[[factor]]\nname = "
      "\"hand\"\nlevels = [\"x\", \"y\", \"z\"]\n");
  for (const auto* factor : {"surface", "hand"})
    text += std::string("[[sequence]]\nname = \"over-") + factor +
            "\"\ndesign = \"latin-square\"\nover = \"" + factor +
            "\"\nblock = { procedures = [\"levels\"] }\n";
  const auto protocol = protocol::parse(text, "p.toml");
  CHECK(protocol::place_count(protocol) == 12);
  CHECK(period(protocol) == 12);
}

TEST_CASE("[assignment] says when a participant is replaced, and without it nobody is", "[protocol]") {
  auto text = shipped("friction-training");
  CHECK_FALSE(protocol::assignment(protocol::parse(text, "p.toml")));
  text += "\n[assignment]\ndropout_after_h = 336\n";
  const auto assignment = protocol::assignment(protocol::parse(text, "p.toml"));
  REQUIRE(assignment);
  CHECK(assignment->dropout_after_h == 336);
  CHECK(assignment->rows == 2);
  CHECK(assignment->sessions == 3);
  CHECK_FALSE(assignment->incomplete_count);
  text.replace(text.find("\"repeat\""), 8, "\"count\"");
  CHECK(protocol::assignment(protocol::parse(text, "p.toml"))->incomplete_count);
}
