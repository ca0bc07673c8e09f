// The designer's preview shows the pages that a session shows. The reference is a session: every page that a
// simulated session of the same study puts on its display.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "station/session/prepare.hpp"
#include "station/session/session.hpp"
#include "station/view/sample_pages.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using session::PageKind;

namespace {

struct Collected : session::Display {
  std::vector<session::Page> pages;
  void show(const session::Page& page) override { pages.push_back(page); }
};

std::vector<std::string> names_of(const std::vector<view::SamplePage>& pages) {
  std::vector<std::string> names;
  for (const auto& page : pages) names.push_back(page.name.substr(page.name.rfind('.') + 1));
  return names;
}

std::vector<view::SamplePage> samples_of(const std::string& protocol, const std::string& language) {
  const std::string root = TURNPOINT_SOURCE_DIR;
  return view::sample_pages(protocol::load(root + "/protocols/" + protocol + ".toml"),
                            rig::load(root + "/tests/support/thin_plate.toml"), language);
}

/// What a participant reads on a page: everything but the levels and the counted trials.
std::string read(const session::Page& page) {
  auto text = std::to_string(static_cast<int>(page.kind)) + page.title + "|" + page.text + "|" +
              (page.kind == PageKind::rest ? "" : page.instruction) + "|" + std::to_string(page.interval.of) +
              "." + std::to_string(page.interval.number);
  for (const auto& answer : page.answers) text += "|" + answer.label + "/" + answer.caption;
  return text;
}

}  // namespace

TEST_CASE("the pages of a two-interval study come in the order of a trial", "[desk]") {
  const std::vector<std::string> wanted{"instructions", "cue",    "interval", "gap",
                                        "interval",     "answer", "feedback", "feedback"};
  const auto names = names_of(samples_of("friction-2ifc", "en"));
  std::vector<std::string> without_late;
  std::copy_if(names.begin(), names.end(), std::back_inserter(without_late),
               [](const auto& name) { return name != "late"; });
  REQUIRE(without_late.size() > wanted.size());
  CHECK(std::vector<std::string>(without_late.begin(), without_late.begin() + 8) == wanted);
  CHECK(names.back() == "end");
}

TEST_CASE("a block of several tasks has the pages of each of them", "[desk]") {
  const auto pages = samples_of("gallery/task-switching", "en");
  for (const auto& [cue, question, answer] :
       {std::tuple{"How smooth?", "Rougher or smoother than usual?", "rougher"},
        std::tuple{"Where does it end?", "Left or right of the middle?", "left"}}) {
    INFO(cue);
    const auto has = [&, cue = cue, question = question, answer = answer](const auto& sample) {
      const auto& page = sample.page;
      return page.cue == cue || (page.cue.empty() && page.text == question && !page.answers.empty() &&
                                 page.answers.front().id == answer);
    };
    std::set<session::PageKind> kinds;
    for (const auto& sample : pages)
      if (has(sample)) kinds.insert(sample.page.kind);
    CHECK(kinds.count(session::PageKind::cue) == 1);
    CHECK(kinds.count(session::PageKind::stimulus) == 1);
  }
}

TEST_CASE("every shipped study has pages in each of its languages", "[desk]") {
  int studies = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(TURNPOINT_SOURCE_DIR) + "/protocols")) {
    if (entry.path().extension() != ".toml") continue;
    ++studies;
    const auto name = entry.path().stem().string();
    std::set<std::string> questions;
    const auto protocol = protocol::load(entry.path().string());
    for (const auto& language : protocol.languages) {
      INFO(name << " " << language);
      const auto pages = samples_of(name, language);
      CHECK(pages.size() >= 4);
      for (const auto& page : pages) CHECK(page.page.language == language);
      for (const auto& page : pages)
        if (page.name == "design.page.instructions") questions.insert(page.page.text);
    }
    CHECK(questions.size() >= protocol.languages.size());
  }
  CHECK(studies > 10);
}

TEST_CASE("what a simulated session shows is among the pages of the preview", "[desk]") {
  const TemporaryFolder folder;
  for (const std::string study : {"friction-2ifc", "boundary-constant", "speed-accuracy"}) {
    INFO(study);
    auto request =
        simulated_run(TURNPOINT_SOURCE_DIR "/protocols/" + study + ".toml", folder / (study + ".sqlite"), 1);
    request.participant = "P1";
    const auto prepared = session::prepare(request);
    Collected shown;
    session::Inputs inputs;
    session::run(prepared, &shown, inputs);
    std::set<std::string> sampled;
    for (const auto& page : view::sample_pages(prepared.protocol, prepared.rig, prepared.language))
      sampled.insert(read(page.page));
    const auto compared = {PageKind::instructions, PageKind::cue,      PageKind::stimulus, PageKind::pause,
                           PageKind::response,     PageKind::feedback, PageKind::rest};
    std::set<PageKind> seen;
    for (const auto& page : shown.pages) {
      if (std::find(compared.begin(), compared.end(), page.kind) == compared.end()) continue;
      if (page.answer_now || page.title == "Let us practise once more") continue;
      seen.insert(page.kind);
      INFO(read(page));
      CHECK(sampled.count(read(page)) == 1);
    }
    CHECK(seen.size() >= 3);
  }
}
