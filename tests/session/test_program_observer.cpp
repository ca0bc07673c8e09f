#include <string>
#include <tuple>
#include <vector>

#include "station/core/read_file.hpp"
#include "station/core/usage_error.hpp"
#include "station/session/conversation.hpp"
#include "station/session/programs.hpp"
#include "tests/session/program_session.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using Catch::Matchers::ContainsSubstring;

namespace {

/// An observer that always gives answer 0 after 0.7 s. `before` is run before each message.
std::string shell_observer(const std::string& before = "") {
  return R"(#!/bin/sh
n=0
while read -r line; do
  n=$((n + 1))
  id=${line#*\"id\":} id=${id%%[,\}]*}
  reply="{\"id\":$id,\"type\":\"reply\",\"choice\":0,\"response_time_s\":0.7}"
  )" + before +
         R"(
  case "$line" in
  *'"type":"hello"'*) echo '{"type":"hello","format":"turnpoint-program/1","program":"zero","version":"3"}' ;;
  *) echo "$reply" ;;
  esac
done
)";
}

simulation::Question question() {
  simulation::Question question;
  question.level = -12;
  question.correct = 1;
  question.key = {7, core::Stream::observer, 2, 1, 33};
  return question;
}

}  // namespace

TEST_CASE("the argument of --observer names a program, its limit and its settings", "[programs]") {
  const auto choice =
      session::parse_program("--observer", "program:a/b.py,limit_s=0.5,threshold=-20,mode=fast");
  CHECK(choice.path == "a/b.py");
  CHECK(choice.limit_s == 0.5);
  CHECK(choice.settings == session::Json{{"threshold", -20.0}, {"mode", "fast"}});
  CHECK(session::parse_program("--observer", "program:b").settings.empty());
  for (const auto* wrong : {"sim", "program:", "program:,a=1", "program:b,a", "program:b,=1",
                            "program:b,limit_s=0", "program:b,limit_s=61", "program:b,limit_s=x"})
    CHECK_THROWS_AS(session::parse_program("--observer", wrong), core::UsageError);
  const TemporaryFolder folder;
  CHECK(session::located("sim:slope=2") == "sim:slope=2");
  CHECK_THROWS_WITH(session::located("program:" + (folder / "absent")),
                    ContainsSubstring("there is no such file"));
  std::ofstream(folder / "plain") << "";
  CHECK_THROWS_WITH(session::located("program:" + (folder / "plain")), ContainsSubstring("not executable"));
  const auto here = std::filesystem::current_path();
  written_program(folder / "observer", shell_observer());
  std::filesystem::current_path(folder.path);
  const auto located = session::located("program:observer,a=1");
  CHECK(located == "program:" + (std::filesystem::current_path() / "observer").string() + ",a=1");
  std::filesystem::current_path(here);
}

TEST_CASE("a program gets everything in the question on which an answer may depend", "[programs]") {
  const TemporaryFolder folder;
  session::Programs programs("");
  const auto path = written_program(
      folder / "o", shell_observer("case \"$line\" in *question*) echo \"$line\" > asked ;; esac"));
  const auto observer = programs.respondent("program:" + path);
  auto asked = question();
  asked.deadline_s = 1.5, asked.confidence = 0;
  const auto reply = observer.answer(asked);
  CHECK(reply.choice == 0);
  CHECK(reply.response_time_s == 0.7);
  CHECK_FALSE(reply.value);
  const auto message = session::Json::parse(core::read_file(folder / "asked"));
  CHECK(message["level"] == -12);
  CHECK(message["correct"] == 1);
  CHECK(message["answers"] == 2);
  CHECK(message["deadline_s"] == 1.5);
  CHECK(message["signal_s"].is_null());
  CHECK(message["decides"] == "right-answer");
  CHECK(message["seed"] == 7);
  CHECK(message["block"] == 2);
  CHECK(message["attempt"] == 1);
  CHECK(message["trial"] == 33);
  const auto started = programs.take_started();
  REQUIRE(started.size() == 1);
  CHECK(started[0].role == "observer");
  CHECK(started[0].version == "3");
}

TEST_CASE("a reply that no participant could give is refused, and the next question starts the program again",
          "[programs]") {
  struct Case {
    const char *reply, *says;
  };
  const auto [reply, says] =
      GENERATE(Case{"\\\"choice\\\":2,\\\"response_time_s\\\":1", "\"choice\" is 2; allowed are 0 to 1"},
               Case{"\\\"choice\\\":0.5,\\\"response_time_s\\\":1", "\"choice\" must be a whole number"},
               Case{"\\\"choice\\\":1", "\"response_time_s\" must be a finite number"},
               Case{"\\\"choice\\\":1,\\\"response_time_s\\\":3601", "\"response_time_s\" is 3601"},
               Case{"\\\"choice\\\":1,\\\"response_time_s\\\":1,\\\"type\\\":\\\"level\\\"",
                    "replied \"level\" to \"question\""});
  INFO(reply);
  const TemporaryFolder folder;
  session::Programs programs("");
  const auto path = written_program(
      folder / "o",
      shell_observer(
          "[ -e bad ] && [ $n = 2 ] && { rm bad; reply=\"{\\\"id\\\":$id,\\\"type\\\":\\\"reply\\\"," +
          std::string(reply) + "}\"; }"));
  std::ofstream(folder / "bad") << "";
  const auto observer = programs.respondent("program:" + path);
  CHECK_THROWS_WITH(observer.answer(question()), ContainsSubstring(says));
  CHECK(observer.answer(question()).choice == 0);
}

TEST_CASE("a program that gives no answer lets the trial time out", "[programs]") {
  const TemporaryFolder folder;
  session::Programs programs("");
  const auto path = written_program(
      folder / "o",
      shell_observer("reply=\"{\\\"id\\\":$id,\\\"type\\\":\\\"reply\\\",\\\"choice\\\":null}\""));
  CHECK_FALSE(programs.respondent("program:" + path).answer(question()).choice);
}

TEST_CASE("numbers, confidence and settings of a slider come from a program too", "[programs]") {
  const TemporaryFolder folder;
  session::Programs programs("");
  const auto path = written_program(folder / "o", shell_observer(R"(
  case "$line" in
  *'"type":"adjustment"'*) reply="{\"id\":$id,\"type\":\"setting\",\"moves\":[{\"time_s\":0.5,\"value\":2},{\"time_s\":1,\"value\":3}],\"done_s\":2}" ;;
  *) reply="{\"id\":$id,\"type\":\"reply\",\"value\":12.5,\"response_time_s\":1,\"confidence\":3,\"confidence_time_s\":0.5}" ;;
  esac)"));
  const auto observer = programs.respondent("program:" + path);
  auto number = question();
  number.value = simulation::ValueQuestion{true, 0, 100, 1, 10};
  number.confidence = 4;
  const auto reply = observer.answer(number);
  CHECK(reply.choice == 0);
  CHECK(reply.value == 12.5);
  CHECK(reply.confidence == 3);
  CHECK(reply.confidence_time_s == 0.5);
  number.value->high = 12;
  CHECK_THROWS_WITH(observer.answer(number), ContainsSubstring("\"value\" is 12.5; allowed are 0 to 12"));
  const auto setting = observer.adjust({1, 0, 5, 2, 0, 0, {}});
  REQUIRE(setting.moves.size() == 2);
  CHECK(setting.moves[1].value == 3);
  CHECK(setting.done_s == 2);
  CHECK_THROWS_WITH(observer.adjust({1, 0, 2.5, 2, 0, 0, {}}),
                    ContainsSubstring("\"value\" is 3; allowed are 0 to 2.5"));
}

TEST_CASE("a program answers a whole session; if it dies, the session is interrupted and continues later",
          "[programs][session]") {
  ProgramSession unbroken;
  written_program(unbroken.folder / "o", shell_observer());
  unbroken.setup.observer = "program:" + (unbroken.folder / "o");
  const auto done = unbroken.run();
  CHECK(done.status == core::SessionStatus::completed);
  CHECK(done.answered == ProgramSession::trials);
  const auto whole = unbroken.rows(done.session_id);
  // The second message asks about the first trial.
  for (int at = 3; at <= 1 + ProgramSession::trials; ++at) {
    INFO(at);
    ProgramSession session;
    written_program(session.folder / "o", shell_observer("[ -e flag ] && [ $n = " + std::to_string(at) +
                                                         " ] && { rm flag; exit 2; }"));
    std::ofstream(session.folder / "flag") << "";
    session.setup.observer = "program:" + (session.folder / "o");
    const auto broken = session.run();
    CHECK(broken.status == core::SessionStatus::interrupted);
    CHECK_THAT(broken.reason, ContainsSubstring("ended with status 2"));
    CHECK(session.rows(broken.session_id).size() == static_cast<std::size_t>(at - 2));
    CHECK(session.resume(broken.session_id).status == core::SessionStatus::completed);
    CHECK(session.rows(broken.session_id) == whole);
  }
}
