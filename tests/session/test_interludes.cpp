// Tests of interludes: consent, questionnaires with branches and Back, explanations with examples to feel,
// screenings. Answers are stored at once, and a session whose process dies continues with the next question.
#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "station/core/read_file.hpp"
#include "station/session/prepare.hpp"
#include "station/session/resume.hpp"
#include "station/store/verify.hpp"
#include "tests/session/live_room.hpp"
#include "tests/session/screen.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using namespace turnpoint::live_room;

namespace {

const char* const kBefore = R"(
[[consent]]
name = "form"
text = { en = "Do you take part?" }
agree = { en = "Yes" }
refuse = { en = "No" }
farewell = { en = "Goodbye, and thanks." }

[[questionnaire]]
name = "you"

[[questionnaire.item]]
id = "hand"
question = { en = "Which hand?" }
choices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]

[[questionnaire.item]]
id = "years"
question = { en = "For how many years?" }
number = { low = 0, high = 99, decimals = 0 }
when = "hand == left"

[[questionnaire.item]]
id = "mood"
question = { en = "How do you feel?" }
rating = { points = 5, labels = [{ at = 1, text = { en = "bad" } }, { at = 5, text = { en = "well" } }] }

[[screening]]
name = "awake"
pass = "you.mood >= 2"
farewell = { en = "Come again when you feel better." }

[[explanation]]
name = "intro"

[[explanation.page]]
text = { en = "First." }

[[explanation.page]]
text = { en = "Second." }
examples = [{ label = { en = "Feel" }, scene = "edge", with = { offset_mm = 20.0 }, duration_s = 0.3 }]
)";

const char* const kAfter = R"(
[[questionnaire]]
name = "then"

[[questionnaire.item]]
id = "hard"
question = { en = "How hard was it?" }
rating = { line = [0, 10], decimals = 1, labels = [{ at = 0, text = { en = "easy" } }, { at = 10, text = { en = "hard" } }] }
)";

std::string around(std::string text) {
  text.insert(text.find("[[block]]"), kBefore);
  return text + kAfter;
}

/// Returns the valid answers, as "questionnaire.item@occasion=answer".
std::vector<std::string> answers_in(const std::string& database, const std::string& session) {
  std::vector<std::string> all;
  const auto stored = store::read_session(database, session);
  for (const auto* event : core::standing_answers(stored.events))
    for (const auto& answer : event->answers)
      all.push_back(answer.questionnaire + "." + answer.item + "@" + std::to_string(answer.occasion) + "=" +
                    answer.answer);
  return all;
}

/// A participant who answers the questions one after another with these numbers; a number below 0 means Back.
struct Person : Room {
  std::vector<double> replies;
  std::size_t next_reply = 0;
  Person(std::vector<double> list) : replies(std::move(list)) {
    reacts = [this](const session::Page& page) { react(page); };
  }
  void react(const session::Page& page) {
    if (page.kind == PageKind::explanation && !page.playing) return push(input::Next{});
    const bool typed = page.kind == PageKind::number || page.kind == PageKind::line;
    if (page.kind != PageKind::question && !typed) return cooperate(page);
    if (next_reply >= replies.size()) return push(input::Stop{});
    const double reply = replies[next_reply++];
    if (reply < 0) return push(input::Back{});
    if (!typed) return push(input::Answer{static_cast<int>(reply)});
    push(input::Value{reply});
  }
};

session::Setup visit(const TemporaryFolder& folder) {
  auto setup = live_setup(folder / "a.sqlite");
  setup.protocol = protocol::parse(around(protocol_text("buttons")), "live.toml");
  return setup;
}

}  // namespace

TEST_CASE("a questionnaire branches, Back withdraws an answer, and every answer is stored", "[session]") {
  const TemporaryFolder folder;
  const auto setup = visit(folder);
  // The answers: agree to the consent; left, 12 years, back, back, right (which skips the question about
  // years), mood 4; later 2.5.
  Person person({0, 0, 12, -1, -1, 1, 3, 2.5});
  const auto summary = session::run(setup, &person, person.inputs, person.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(answers_in(setup.database, summary.session_id) ==
        std::vector<std::string>{"form.consent@0=agree", "you.hand@0=right", "you.mood@0=4",
                                 "awake.screening@0=passed", "then.hard@1=2.5"});
  CHECK(events_of(setup.database, summary, core::kBackEvent).size() == 2);
  CHECK(events_of(setup.database, summary, core::kAnswerEvent).size() == 7);
  CHECK(store::verify(setup.database).good());
  CHECK(trials_of(setup.database, summary).size() == 2);
}

TEST_CASE("an answer that the item does not allow, and a response button, answer no question", "[session]") {
  const TemporaryFolder folder;
  const auto setup = visit(folder);
  Person person({0, 0, 7, 4, 5});
  const auto react = person.reacts;
  person.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::question) {
      person.press(0);
      person.push(input::Answer{7});
      if (!page.back) person.push(input::Back{});
    }
    if (page.kind == PageKind::question && page.back) return person.push(input::Stop{});
    react(page);
  };
  const auto summary = session::run(setup, &person, person.inputs, person.devices());
  CHECK(summary.status == core::SessionStatus::interrupted);
  const auto stands = answers_in(setup.database, summary.session_id);
  REQUIRE(stands.size() >= 2);
  CHECK(stands[0] == "form.consent@0=agree");
  CHECK(stands[1] == "you.hand@0=left");
}

TEST_CASE("a refused consent and a screening that is not passed end the session politely", "[session]") {
  const TemporaryFolder folder;
  const auto setup = visit(folder);
  const bool refuses = GENERATE(true, false);
  Person person(refuses ? std::vector<double>{1} : std::vector<double>{0, 1, 0});
  const auto summary = session::run(setup, &person, person.inputs, person.devices());
  CHECK(summary.status == core::SessionStatus::stopped);
  CHECK(summary.reason.find(refuses ? "refused" : "not passed") != std::string::npos);
  CHECK(summary.trials == 0);
  const std::string farewell = refuses ? "Goodbye, and thanks." : "Come again when you feel better.";
  const auto reads = [&](const session::Page& page) { return page.text == farewell; };
  CHECK(std::any_of(person.pages.begin(), person.pages.end(), reads));
  CHECK(person.enables().empty());
}

TEST_CASE("an example is presented as often as the participant wishes", "[session]") {
  const TemporaryFolder folder;
  const auto setup = visit(folder);
  Person person({0, 1, 3, 5});
  const auto react = person.reacts;
  int wishes = 3, back = 1;
  person.reacts = [&](const session::Page& page) {
    const bool explained = page.kind == PageKind::explanation && !page.playing;
    if (explained && page.text == "Second." && back-- > 0) return person.push(input::Back{});
    if (explained && !page.answers.empty() && wishes-- > 0) return person.push(input::Answer{0});
    react(page);
  };
  const auto summary = session::run(setup, &person, person.inputs, person.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  const auto examples = events_of(setup.database, summary, "example");
  REQUIRE(examples.size() == 3);
  // Each example lasts 0.3 s and begins 0.8 s after its button was pressed.
  for (std::size_t i = 1; i < 3; ++i) CHECK(examples[i].time_ns - examples[i - 1].time_ns > 1'100'000'000);
  const auto first_trial = events_of(setup.database, summary, "presented").front().time_ns;
  const auto driven = person.enables();
  const auto high = [](const auto& change) { return change.level == 1; };
  const auto first = std::find_if(driven.begin(), driven.end(), high);
  REQUIRE(first != driven.end());
  CHECK(first->time_ns > examples[0].time_ns);
  CHECK(first->time_ns < first_trial);
  CHECK(driven.back().level == 0);
  CHECK(trials_of(setup.database, summary).size() == 2);
}

TEST_CASE("a session killed at any question goes on with the next one", "[session]") {
  const TemporaryFolder folder;
  const auto path = folder / "visit.toml";
  std::ofstream(path) << around(protocol_text("buttons"));
  // With this seed, the simulated participant gives a mood that passes the screening.
  auto request = simulated_run(path, folder / "whole.sqlite", 3);
  session::Inputs inputs;
  const auto whole = session::run(session::prepare(request), nullptr, inputs);
  REQUIRE(whole.status == core::SessionStatus::completed);
  const auto expected = answers_in(request.database, whole.session_id);
  REQUIRE(expected.size() >= 5);
  for (int page = 1; page <= 12; ++page) {
    INFO("killed at page " << page);
    request.database = folder / ("cut" + std::to_string(page) + ".sqlite");
    Screen cut(page);
    try {
      session::run(session::prepare(request), &cut, inputs);
    } catch (const std::runtime_error&) {
    }
    std::ostringstream messages;
    const auto again = session::prepare_resume({request.database, "", ""}, messages);
    if (!again) continue;  // the process was killed at the first page, so no question has been answered yet
    const auto resumed = session::run(*again, nullptr, inputs);
    CHECK(resumed.status == core::SessionStatus::completed);
    CHECK(answers_in(request.database, resumed.session_id) == expected);
    CHECK(events_of(request.database, resumed, core::kAnswerEvent).size() == expected.size());
    CHECK(store::verify(request.database).good());
  }
}
