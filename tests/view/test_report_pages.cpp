// Tests the report of a session on the screen: its tables, its figures, and their language.
#include <algorithm>
#include <cctype>

#include "station/report/svg.hpp"
#include "station/view/live_facts.hpp"
#include "station/view/report_data.hpp"
#include "station/view/report_pages.hpp"
#include "station/view/scene_figures.hpp"
#include "tests/report/simulated_report.hpp"
#include "tests/support/catch.hpp"
#include "tests/view/demo.hpp"

using namespace turnpoint;

namespace {

const report::Figure* figure_in(const view::ReportPages& pages, const std::string& name) {
  for (const auto& figure : pages.figures)
    if (figure.name == name) return &figure.figure;
  return nullptr;
}

std::string value_in(const view::ReportPages& pages, const std::string& label, const char* language = "en") {
  for (const auto& section : pages.sections)
    for (const auto& [name, value] : section.facts)
      if (core::say(name, language) == label) return core::say(value, language);
  return "";
}

}  // namespace

TEST_CASE("the report on the screen has the numbers and figures of the speed-accuracy trade-off",
          "[operator]") {
  const TemporaryFolder folder;
  session::Inputs inputs;
  const auto summary = session::run(session::prepare(demo_in(folder)), nullptr, inputs);
  const auto pages = view::report_pages(summary.database, summary.session_id);
  CHECK(value_in(pages, "Presented") == "10");
  CHECK_FALSE(value_in(pages, "Proportion correct (0 to 1)").empty());
  CHECK(figure_in(pages, "levels") != nullptr);
  CHECK(core::say(pages.sections.back().heading, "en") == "The station");
}

TEST_CASE("each number of the report on the screen stands on its page as well", "[operator]") {
  const TemporaryFolder folder;
  session::Inputs inputs;
  const auto stored = session::run(session::prepare(demo_in(folder)), nullptr, inputs);
  const auto summary = report::summarise(view::report_data(stored.database, stored.session_id).front());
  const auto page = report::to_html(summary);
  int intervals = 0;
  for (const auto& section : view::report_pages(summary).sections) {
    CHECK(page.find(">" + report::escaped(core::say(section.heading, "en")) + "</h2>") != std::string::npos);
    for (const auto& [name, value] : section.facts) {
      const auto text = core::say(value, "en");
      const auto at = text.find(" [");
      INFO(core::say(name, "en") << ": " << text);
      if (at == std::string::npos) continue;
      ++intervals;
      const auto end = text.find(']', at) + 1;
      CHECK(page.find(text.substr(0, at) + " <span class=\"soft\">" + text.substr(at + 1, end - at - 1) +
                      "</span>" + text.substr(end)) != std::string::npos);
    }
  }
  CHECK(intervals > 2);
}

TEST_CASE("tables and figures of the report on the screen are in the language of the operator",
          "[operator]") {
  const TemporaryFolder folder;
  session::Inputs inputs;
  const auto summary = session::run(session::prepare(demo_in(folder)), nullptr, inputs);
  const auto svg_of = [](const view::ReportPages& pages, const char* name) {
    REQUIRE(figure_in(pages, name) != nullptr);
    auto figure = *figure_in(pages, name);
    figure.caption.clear();  // captions of figures are in English only
    report::Svg svg;
    view::drawing_of(figure)(svg, 900, 600);
    return svg.finish();
  };
  const auto german = view::report_pages(summary.database, summary.session_id, "de");
  CHECK(value_in(german, "Dargeboten", "de") == "10");
  CHECK_FALSE(value_in(german, "Anteil richtig (0 bis 1)", "de").empty());
  CHECK(svg_of(german, "levels").find("Durchgang (Nummer in der Sitzung)") != std::string::npos);
  CHECK(svg_of(german, "levels").find("Trial") == std::string::npos);
  CHECK(svg_of(german, "response-times").find("Reaktionszeit (s)") != std::string::npos);
  const auto english = view::report_pages(summary.database, summary.session_id);
  CHECK(svg_of(english, "levels").find("Trial (number in the session)") != std::string::npos);
}

TEST_CASE("remarks and facts about the station in a report are said in the language of the screen",
          "[operator]") {
  const TemporaryFolder folder;
  session::Inputs inputs;
  const auto summary = session::run(session::prepare(demo_in(folder)), nullptr, inputs);
  const auto pages = view::report_pages(summary.database, summary.session_id, "de");
  bool remarked = false;
  for (const auto& section : pages.sections)
    for (const auto& statement : section.statements) {
      INFO(core::say(statement, "en"));
      CHECK(core::say(statement, "de") != core::say(statement, "en"));
      remarked = true;
    }
  CHECK(remarked);
  const auto& station = pages.sections.back();
  CHECK(core::say(station.heading, "de") == "Station");
  CHECK(station.facts.size() > 15);
  for (const auto& [name, text] : station.facts) CHECK(core::say(name, "de") != core::say(name, "en"));
}

namespace {

/// Calls `with` for each text and each name of which a phrase consists.
template <class With>
void parts_of(const core::Phrase& phrase, const With& with) {
  with(phrase);
  for (const auto& value : phrase.values) parts_of(value, with);
}

/// The names that a protocol gives, and units. Other words on the screen must be texts of the catalogues.
bool in_protocol(const std::string& words, const std::string& protocol) {
  std::string word;
  for (const char c : words + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      continue;
    }
    if (word.size() > 3 && protocol.find(word) == std::string::npos) return false;
    word.clear();
  }
  return true;
}

}  // namespace

TEST_CASE(
    "headings, labels and remarks of each design's report are texts in six languages, and end in a word",
    "[operator]") {
  const auto name = GENERATE("speed-accuracy", "boundary-adjustment", "friction-rating", "magnitude-free",
                             "friction-identification", "friction-zest", "friction-boundary-2d",
                             "response-signal", "friction-confidence", "reward-rate", "friction-unforced",
                             "friction-pairs", "friction-triads");
  CAPTURE(name);
  auto protocol = shipped(name);
  const auto pages = view::report_pages(report::summarise(data_of(protocol)));
  for (auto& c : protocol) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto check = [&](const core::Phrase& said) {
    const auto english = core::say(said, "en");
    CAPTURE(english);
    CHECK_FALSE(english.empty());
    for (const char* end : {", ", ": ", " ", ","}) CHECK_FALSE(english.ends_with(end));
    CHECK_FALSE(english.starts_with(","));
    CHECK(english.find(", ,") == std::string::npos);
    parts_of(said, [&](const core::Phrase& part) {
      CAPTURE(part.key, part.words);
      CHECK(in_protocol(part.words, protocol));
      if (!part.key.empty())
        for (const auto& language : core::languages()) CHECK(core::catalogue(language).contains(part.key));
    });
  };
  REQUIRE_FALSE(pages.sections.empty());
  std::size_t facts = 0;
  for (const auto& section : pages.sections) {
    check(section.heading);
    for (const auto& [label, value] : section.facts) check(label), check(value), ++facts;
    for (const auto& statement : section.statements) check(statement);
  }
  CHECK(facts > 3);
}

TEST_CASE("a section of the report on the screen that has only a remark keeps its heading", "[operator]") {
  report::Summary summary;
  summary.data.design = report::Design::adjustment;
  const auto pages = view::report_pages(summary);
  const auto found = std::find_if(pages.sections.begin(), pages.sections.end(),
                                  [](const auto& one) { return core::say(one.heading, "en") == "Settings"; });
  REQUIRE(found != pages.sections.end());
  CHECK(found->facts.empty());
  REQUIRE(found->statements.size() == 1);
  CHECK(core::say(found->statements[0], "de") == "In dieser Sitzung gibt es keine Einstellungen.");
}

TEST_CASE("the report on the screen has the finger's forces and friction, if force cells recorded",
          "[operator]") {
  report::Summary summary;
  summary.data.design = report::Design::ratings;
  CHECK(value_in(view::report_pages(summary), "speed: Speed (mm/s)").empty());
  CHECK(figure_in(view::report_pages(summary), "finger") == nullptr);
  std::vector<analysis::FingerTrial> trials;
  for (int i = 0; i < 4; ++i) {
    analysis::FingerTrial trial{i, "speed", true, 0.5, 80.0 + i, 0.3, 0.8, 150.0, 150.5 + 0.1 * i, 0.2};
    trials.push_back(trial);
  }
  summary.finger = analysis::finger(trials, {});
  const auto pages = view::report_pages(summary);
  CHECK(value_in(pages, "speed: Speed (mm/s)").find("81.5 [") == 0);
  CHECK(value_in(pages, "speed: Felt minus planned boundary (mm)").find(" [") != std::string::npos);
  CHECK(figure_in(pages, "finger") != nullptr);
  CHECK(figure_in(pages, "friction") != nullptr);
}

TEST_CASE("the view of a running session is in the language of the operator", "[operator]") {
  view::LiveTrial trial;
  trial.procedure = "levels", trial.level = 2, trial.given.correct = true, trial.timing.response_time_s = 1.5;
  const auto facts = view::course_of({trial}, "de");
  CHECK(value_of(facts, "Richtig") == "1 von 1 (100 %)");
  CHECK(value_of(facts, "Reaktionszeit") == "Median 1.5 s, letzte 1.5 s");
  CHECK(value_of(view::limits_used({trial}, std::nullopt, rig::Rig(), "de"), "Die Sitzung").find(" min") !=
        std::string::npos);
  const auto levels = view::live_trace({trial}, "offset_mm", "de"), times = view::live_times({trial}, "de");
  REQUIRE((levels && times));
  CHECK(levels->charts.front().title == "Stufen (offene Zeichen: nicht richtig)");
  CHECK(levels->charts.front().x.label == "Durchgang");
  CHECK(times->charts.front().y.label == "Reaktionszeit (s)");
}
