// Tests what the operator's pages of studies and sessions show.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "station/core/read_file.hpp"
#include "station/rehearsal/check.hpp"
#include "station/session/prepare.hpp"
#include "station/store/session_log.hpp"
#include "station/view/choices.hpp"
#include "station/view/session_list.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

const std::string kHere = TURNPOINT_SOURCE_DIR;

/// Runs a session of this participant with a simulated observer, and returns its id.
std::string run_session(const std::string& database, const std::string& participant) {
  auto request = simulated_run(kHere + "/protocols/demo.toml", database, 1);
  request.participant = participant;
  session::Inputs inputs;
  return session::run(session::prepare(request), nullptr, inputs).session_id;
}

std::vector<std::string> found(const std::vector<view::SessionLine>& lines, const std::string& search) {
  std::vector<std::string> people;
  for (const auto& line : lines)
    if (view::matches(line, search)) people.push_back(line.person);
  return people;
}

}  // namespace

TEST_CASE("sessions are listed newest first, and each word of a search must occur", "[sessions]") {
  const TemporaryFolder scratch;
  const auto database = scratch / "lab.sqlite";
  CHECK(view::session_lines(database).empty());
  const auto first = run_session(database, "P01");
  run_session(database, "P02");
  store::annotate(database, first, "Fire alarm in block 2");
  const auto lines = view::session_lines(database);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].person == "P02");
  CHECK(lines[1].session_id == first);
  CHECK(lines[1].trials == 10);
  CHECK(lines[1].status == "completed");
  CHECK_FALSE(lines[1].resumable);
  using List = std::vector<std::string>;
  CHECK(found(lines, "") == List{"P02", "P01"});
  CHECK(found(lines, "p01") == List{"P01"});
  CHECK(found(lines, "DEMO simulated") == List{"P02", "P01"});
  CHECK(found(lines, "fire demo") == List{"P01"});
  CHECK(found(lines, "fire P02").empty());
}

TEST_CASE("why a session ended is said in each language, in English as it is stored", "[sessions]") {
  std::vector<std::string> stored{core::kLostReason, core::kAbandonedReason, core::kStoppedReason,
                                  core::kVoidsReason};
  for (const auto kind : core::fault_kinds) {
    stored.push_back(core::describe({kind, ""}));
    stored.push_back(core::describe({kind, "No such device"}));
    stored.push_back(core::kVoidsReason + ("; the last: " + core::describe({kind, "No such device"})));
  }
  for (const auto& reason : stored) {
    INFO(reason);
    CHECK(core::say(view::reason_of_end(reason), "en") == reason);
    for (const auto& language : core::languages())
      if (language != "en")
        CHECK(core::say(view::reason_of_end(reason), language).find(reason) == std::string::npos);
  }
  CHECK(core::say(view::reason_of_end("three trials in a row were void; the last: emergency stop pressed"),
                  "de") == "drei Durchg\u00e4nge hintereinander waren ung\u00fcltig; der letzte: " +
                               core::say(core::phrase_of({core::FaultKind::stop_pressed, ""}), "de"));
  CHECK(core::say(view::reason_of_end("fire alarm"), "de") == "fire alarm");
  CHECK(view::reason_of_end("").empty());
}

TEST_CASE("a check's remarks have file, line and hint, problems first", "[studies]") {
  rehearsal::Check check;
  check.warnings = {{{"/a/study.toml", 9, 1}, core::plain("no practice"), {}}};
  check.notes = {{{"/a/study.toml", 4, 1}, core::plain("listed twice"), {}}};
  check.problems = {{{"/a/study.toml", 12, 3},
                     core::plain("unknown key \"boundry_mm\""),
                     core::plain("did you mean boundary_mm?")}};
  const auto words = view::words_of(check);
  using Kind = view::CheckWords::Remark::Kind;
  REQUIRE(words.remarks.size() == 3);
  CHECK(words.remarks[0].kind == Kind::problem);
  CHECK(words.remarks[0].file == "study.toml");
  CHECK(words.remarks[0].line == 12);
  CHECK(core::say(words.remarks[0].what, "en") == "unknown key \"boundry_mm\"");
  CHECK(core::say(words.remarks[0].hint, "en") == "did you mean boundary_mm?");
  CHECK(words.remarks[1].kind == Kind::warning);
  CHECK(words.remarks[2].kind == Kind::note);
}

TEST_CASE("what is wrong in a study is said with its hint, in English on every page", "[studies]") {
  const TemporaryFolder folder;
  auto source = core::read_file(kHere + "/protocols/demo.toml");
  const auto replace = [&source](const std::string& from, const std::string& to) {
    REQUIRE(source.find(from) != std::string::npos);
    source.replace(source.find(from), from.size(), to);
  };
  replace("title = ", "titel = \"x\"\ntitle = ");
  replace("deadline_s = ", "deadline_s = -");
  replace("level = \"offset_mm\"", "level = \"ofset_mm\"");
  const std::string path = folder / "demo.toml";
  std::ofstream(path) << source;
  const auto check = rehearsal::check(path, kHere + "/tests/support/thin_plate.toml", {5});
  const auto words = view::words_of(check);
  const auto says = [&words](const std::string& what, const std::string& hint) {
    return std::any_of(words.remarks.begin(), words.remarks.end(), [&](const auto& remark) {
      return core::say(remark.what, "en") == what &&
             core::say(remark.hint, "en").find(hint) != std::string::npos;
    });
  };
  CHECK(says("unknown key \"titel\" in [protocol]", "did you mean \"title\"? known: "));
  CHECK(says("unknown factor \"ofset_mm\"", "did you mean \"offset_mm\"?"));
}

TEST_CASE("there is advice for every cue that a check reports, and only a cue that helps gets it",
          "[studies]") {
  const auto words = view::words_of(rehearsal::check(kHere + "/protocols/friction-2ifc.toml",
                                                     kHere + "/tests/support/thin_plate.toml", {5}));
  REQUIRE(words.cues.size() == 8);
  int leaks = 0;
  for (const auto& cue : words.cues) {
    INFO(cue.name.key);
    CHECK_FALSE(core::say(cue.name, "de") == core::say(cue.name, "en"));
    CHECK(cue.advice.key == (cue.leaks ? cue.name.key + "_advice" : ""));
    leaks += cue.leaks;
  }
  CHECK(leaks > 0);
  CHECK_THROWS_AS(view::cue_advice("colour"), std::logic_error);
}
