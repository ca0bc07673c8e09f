// Tests answers that are numbers, and ratings of confidence: a person gives them on the screen, and the
// trial's row stores them.
#include "station/io/watched_lines.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using namespace turnpoint::live_room;

namespace {

session::Setup setup_with(const std::string& answers, const TemporaryFolder& folder,
                          const std::string& device = "touch") {
  auto setup = live_setup(folder / "a.sqlite", device);
  auto text = protocol_text(device);
  const auto from = text.find("choices"), to = text.find("[timing]");
  text.replace(from, to - from, answers);
  setup.protocol = protocol::parse(text, "live.toml");
  return setup;
}

const char* const kChoices =
    "choices = [{ id = \"left\", label = { en = \"Left\" } }, { id = \"right\", label = { en = \"Right\" } "
    "}]\n";

}  // namespace

TEST_CASE("a typed number is stored as the answer, and one outside of the range is not an answer",
          "[session]") {
  const TemporaryFolder folder;
  const auto setup = setup_with("[task.number]\nlow = 0.5\nhigh = 99\ndecimals = 1\n", folder);
  Room room;
  const auto type = [&](double number) { room.push(input::Value{number}); };
  room.reacts = [&](const session::Page& page) {
    if (page.kind != PageKind::number) return room.cooperate(page);
    CHECK(page.value.decimals == 1);
    if (room.stimuli++ > 0) return type(7.5);
    for (const double wrong : {100.0, 0.25, 3.14, -1.0, std::nan("")}) type(wrong);
    room.push(input::Answer{0});
    type(12.3);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  const auto trials = trials_of(setup.database, summary);
  REQUIRE(trials.size() == 2);
  CHECK(trials[0].given.response == "12.3");
  CHECK(trials[0].given.extra_touches == 6);
  CHECK(trials[0].timing.response_time_s);
  CHECK_FALSE(trials[0].given.correct);
  CHECK(trials[1].given.response == "7.5");
  CHECK(events_of(setup.database, summary, "value").size() == 7);
}

TEST_CASE("confidence is stored with its answer; a stop before it leaves no trial", "[session]") {
  const TemporaryFolder folder;
  const auto setup = setup_with(std::string(kChoices) +
                                    "[task.confidence]\nquestion = { en = \"Sure?\" }\n"
                                    "labels = [{ en = \"no\" }, { en = \"perhaps\" }, { en = \"yes\" }]\n",
                                folder, "either");
  Room room;
  int asked = 0;
  room.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::stimulus) return room.push(input::Answer{0});
    if (page.kind != PageKind::confidence) return room.cooperate(page);
    CHECK(page.answers.size() == 3);
    CHECK(page.text == "Sure?");
    room.press(0);  // a press of a response button is not accepted as a confidence
    room.push(asked++ == 0 ? input::Any(input::Answer{2}) : input::Stop{}, core::kConfidenceGuard_ns);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  const auto trials = trials_of(setup.database, summary);
  REQUIRE(trials.size() == 2);
  CHECK(trials[0].given.response == "left");
  CHECK(trials[0].given.confidence == 3);
  CHECK(trials[0].given.confidence_time_s.value_or(-1) >= 0);
  CHECK(trials[1].outcome == core::Outcome::aborted);
  CHECK_FALSE(trials[1].given.confidence);
}

TEST_CASE("a second press within the guard time is never stored as the confidence, by finger or by button",
          "[session]") {
  const TemporaryFolder folder;
  const auto setup = setup_with(std::string(kChoices) +
                                    "[task.confidence]\nquestion = { en = \"Sure?\" }\n"
                                    "labels = [{ en = \"no\" }, { en = \"perhaps\" }, { en = \"yes\" }]\n",
                                folder, "either");
  Room room;
  // The buttons are real but for their lines: a person presses the left one twice within 150 ms.
  const auto lines = std::make_shared<io::SimulatedLines>(2);
  auto handlers = session::handlers_for(room.inputs);
  std::vector<std::int64_t> presses;  // of the thread of the buttons
  const auto touch = [&](std::int64_t time_ns, int degree) {
    room.inputs.push({time_ns, input::Answer{degree}});
  };
  handlers.press = [&, pass = handlers.press](const io::Press& press) {
    pass(press);
    presses.push_back(press.time_ns);
    if (presses.size() % 2 == 1) return;
    const auto answered_ns = presses[presses.size() - 2];
    CHECK(press.time_ns - answered_ns == 150'000'000);
    touch(answered_ns + core::kConfidenceGuard_ns - 1, 1);
    touch(answered_ns + core::kConfidenceGuard_ns, 2);
  };
  auto devices = room.devices();
  devices.buttons = io::open_buttons(io::ButtonsConfig{"gpio:left=A,right=B"}, std::nullopt, handlers,
                                     [&](const auto&) { return std::make_unique<SharedLines>(lines); });
  int asked = 0;
  room.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::confidence) ++asked;
    if (page.kind == PageKind::confidence) return;
    if (page.kind != PageKind::stimulus) return room.cooperate(page);
    const auto now = system::monotonic_ns();
    for (const std::int64_t press_ns : {now, now + 150'000'000}) {
      lines->set(0, true, press_ns);
      lines->set(0, false, press_ns + 60'000'000);
    }
  };
  const auto summary = session::run(setup, &room, room.inputs, std::move(devices));
  CHECK(summary.status == core::SessionStatus::completed);
  // a page takes one answer each time it is shown, so it is shown again after each press that was none
  CHECK(asked >= 2 * 2);
  const auto trials = trials_of(setup.database, summary);
  REQUIRE(trials.size() == 2);
  for (const auto& trial : trials) {
    CHECK(trial.given.response == "left");
    CHECK(trial.given.confidence == 3);
    CHECK(trial.given.confidence_time_s.value_or(-1) == Approx(core::kConfidenceGuard_s).epsilon(1e-9));
    CHECK(trial.given.extra_touches == 2);
  }
}
