#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <utility>

#include "station/core/problem.hpp"
#include "station/io/watched_lines.hpp"
#include "station/session/prepare.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

// These tests run live sessions in real time, with a participant who presses buttons, an operator, and the
// guard on simulated lines. The sound output is alsa-lib's null device, which is allowed as a plug-in, or no
// device at all. The tests check the amplifier by the log of its enable line.

using namespace turnpoint;
using namespace turnpoint::live_room;

TEST_CASE("a live session runs from the operator's arming to answers by buttons, and ends disarmed",
          "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  room.reacts = [&room](const auto& page) { room.cooperate(page); };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(room.pages.front().kind == PageKind::fault);  // the first page asks the operator to arm
  CHECK(room.pages.front().amplifier == "disarmed");
  CHECK(room.heartbeats() > 20);
  const auto trials = trials_of(setup.database, summary);
  REQUIRE(trials.size() == 2);
  for (const auto& trial : trials) {
    CHECK(trial.given.response == "left");
    CHECK(trial.outcome == core::Outcome::answered);
    CHECK(trial.timing.clock_slope_ns_per_frame.has_value());
  }
  // The amplifier must be enabled once for each trial, in silence before its stimulus, and be switched off
  // afterwards.
  const auto enables = room.enables();
  REQUIRE(enables.size() == 4);
  const auto stimuli = events_of(setup.database, summary, "stimulus");
  REQUIRE(stimuli.size() == 2);
  const auto presented = events_of(setup.database, summary, "presented");
  REQUIRE(presented.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const auto on_ns = stimuli[k].time_ns,
               off_ns =
                   on_ns + static_cast<std::int64_t>(1e9 * std::strtod(stimuli[k].value.c_str(), nullptr));
    CHECK(enables[2 * k].level == 1);
    // The event `presented` must be stored durably before the amplifier is enabled, however slow the disk is.
    CHECK(enables[2 * k].time_ns > presented[k].time_ns);
    CHECK(enables[2 * k].time_ns < on_ns - 20'000'000);
    CHECK(enables[2 * k + 1].level == 0);
    CHECK(enables[2 * k + 1].time_ns > off_ns);
  }
  CHECK_FALSE(room.lines->level(SharedLines::enable));
  CHECK(events_of(setup.database, summary, "button").size() == 2);
  CHECK(events_of(setup.database, summary, "arm").front().value == "armed");
}

TEST_CASE("the amplifier is never enabled before the operator arms it", "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  room.reacts = [&room](const auto& page) {
    if (page.kind != PageKind::fault) return;
    room.push(input::Next{});  // an impatient participant taps "Next"
    room.press(0);
    room.push(input::Stop{});
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.trials == 0);
  CHECK(room.stimuli == 0);
  CHECK(room.enables().empty());
  const auto& end = room.pages.back();
  CHECK(end.kind == PageKind::end);
  CHECK(end.trials_done == 0);
  CHECK(end.trials_total == 2);  // the number of planned trials, not of completed ones
}

TEST_CASE(
    "a stop during a stimulus switches the amplifier off and makes the trial void, and the trial is repeated",
    "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  std::int64_t pressed_ns = 0;
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus && room.stimuli == 1) {
      pressed_ns = system::monotonic_ns();
      return room.lines->set(SharedLines::stop, true, pressed_ns);
    }
    if (page.kind == PageKind::fault && page.fault.kind == session::FaultKind::stop_pressed &&
        room.lines->level(SharedLines::stop)) {
      // First try to arm while the stop is still pressed: this must be refused.
      if (page.fault.detail.find("refused") == std::string::npos) return room.push(input::Arm{});
      room.lines->set(SharedLines::stop, false, system::monotonic_ns());
    }
    room.cooperate(page);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  const auto trials = trials_of(setup.database, summary);
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(trials[1].level == trials[0].level);
  CHECK(trials[1].trial_in_block == trials[0].trial_in_block);
  CHECK(trials[1].outcome == core::Outcome::answered);
  const auto enables = room.enables();
  REQUIRE(enables.size() == 6);
  CHECK(enables[1].level == 0);
  CHECK(enables[1].time_ns >= pressed_ns);
  const auto arms = events_of(setup.database, summary, "arm");
  REQUIRE(arms.size() >= 3);
  CHECK(arms[1].value.find("refused") == 0);  // refused, because the stop was still pressed
  CHECK(arms.back().value == "armed");
  CHECK(enables[2].time_ns > arms.back().time_ns);
}

TEST_CASE(
    "lost GPIO lines switch the amplifier off; arming is refused until they return, and then the session "
    "continues",
    "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  int refused = 0;
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus && room.stimuli == 1) return room.lines->remove();
    if (page.kind == PageKind::fault && page.fault.kind == session::FaultKind::lines_gone &&
        page.fault.detail.find("refused: GPIO lines disconnected") == 0 && ++refused == 2)
      room.lines->put_back();
    room.cooperate(page);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(refused >= 2);
  const auto trials = trials_of(setup.database, summary);
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(trials[1].level == trials[0].level);
  CHECK(events_of(setup.database, summary, "arm").back().value == "armed");
  CHECK_FALSE(room.lines->level(SharedLines::enable));
}

TEST_CASE("faults that occur while a fault page is shown are cleared together with the first one",
          "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  bool pressed = false;
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus && room.stimuli == 1) return room.push(session::Fault{});
    if (page.kind == PageKind::fault && room.stimuli == 1 && !std::exchange(pressed, true)) {
      // this fault does not disarm the amplifier, so the page offers only Continue
      CHECK(page.amplifier.empty());
      return room.lines->set(SharedLines::stop, true, system::monotonic_ns());
    }
    if (page.kind == PageKind::fault && pressed && room.lines->level(SharedLines::stop)) {
      room.lines->set(SharedLines::stop, false, system::monotonic_ns());
      room.push(session::Fault{});  // a third fault before anybody has armed
    }
    room.cooperate(page);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  const auto is = [](PageKind kind) { return [kind](const auto& page) { return page.kind == kind; }; };
  const auto paused = std::find_if(room.pages.begin(), room.pages.end(), is(PageKind::paused));
  REQUIRE(paused != room.pages.end());
  CHECK(std::none_of(paused, room.pages.end(), is(PageKind::fault)));
}

TEST_CASE("continuing before the lost buttons are back shows the fault page again", "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  const auto buttons = std::make_shared<io::SimulatedLines>(2);
  int told = 0;
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus && room.stimuli == 1) return buttons->remove();
    if (page.kind == PageKind::fault && page.fault.kind == session::FaultKind::lines_gone && ++told == 3) {
      CHECK(page.amplifier.empty());  // the amplifier's lines are on another chip, so it stays armed
      buttons->put_back();
    }
    if (page.kind == PageKind::stimulus) {
      buttons->pulse(1, system::monotonic_ns(), 3000);  // interference on the other button
      return buttons->set(0, true, system::monotonic_ns());
    }
    if (page.kind == PageKind::interval || page.kind == PageKind::feedback)
      buttons->set(0, false, system::monotonic_ns());
    room.cooperate(page);
  };
  auto devices = room.devices();
  io::WatchedLines plan;
  plan.lines = 2;
  plan.button_rules.refractory_ns = 0;
  plan.names = {"left", "right"};
  devices.buttons = io::watch_lines(opener(buttons), plan, session::handlers_for(room.inputs));
  const auto summary = session::run(setup, &room, room.inputs, std::move(devices));
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(told >= 3);
  const auto trials = trials_of(setup.database, summary);
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(trials[1].outcome == core::Outcome::answered);
  CHECK(trials[1].given.response == trials[2].given.response);
  CHECK(events_of(setup.database, summary, "notice").back().value ==
        "panel: the lost device is connected again");
  const auto glitches = events_of(setup.database, summary, "glitch");
  REQUIRE_FALSE(glitches.empty());
  CHECK(glitches[0].value == "right: 2 edges within 0.003 ms");
}

TEST_CASE("disarming by the operator makes the trial void, and arming again continues the session",
          "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus && room.stimuli == 1) return room.push(input::Disarm{});
    room.cooperate(page);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(summary.voided == 1);
  CHECK(summary.answered == 2);
}

TEST_CASE("if the program throws an exception during a session, the amplifier's line goes low",
          "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus) throw std::runtime_error("a bug");
    room.cooperate(page);
  };
  CHECK_THROWS_WITH(session::run(setup, &room, room.inputs, room.devices()), "a bug");
  const auto enables = room.enables();
  REQUIRE(enables.size() == 2);
  CHECK(enables.back().level == 0);
}

TEST_CASE("contacts of a finger are logged with their place", "[session][live]") {
  const TemporaryFolder folder;
  const auto setup = live_setup(folder / "a.sqlite");
  Room room;
  auto devices = room.devices();
  auto* panel = devices.buttons.get();
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus) panel->simulate(io::Contact{system::monotonic_ns(), true, 0.25});
    room.cooperate(page);
  };
  const auto summary = session::run(setup, &room, room.inputs, std::move(devices));
  const auto contacts = events_of(setup.database, summary, "contact");
  REQUIRE(contacts.size() == 2);
  CHECK(contacts.front().value == "1 0.25");
}

TEST_CASE("the interval between trials is lengthened to keep the limit of duty, and the log says by how much",
          "[session][live]") {
  const TemporaryFolder folder;
  auto setup = live_setup(folder / "a.sqlite");
  setup.rig.limits.duty = 0.04;  // 2.4 s per minute, enough for one stimulus of 2 s only
  Room room;
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus) return;  // explore until the stimulus ends, and answer afterwards
    if (page.kind == PageKind::response) return room.press(1);
    if (page.kind == PageKind::interval && room.stimuli == 1) return room.push(input::Stop{});
    room.cooperate(page);
  };
  const auto first = session::run(setup, &room, room.inputs, room.devices());
  CHECK(first.trials == 1);
  // The same participant starts a new session at once. The exposure of the first session must count, because
  // it is in the database.
  Room again;
  // This is declared after the room, so that its thread ends before the room is destroyed.
  std::jthread stops;
  again.reacts = [&](const auto& page) {
    if (page.kind == PageKind::instructions) {
      again.push(input::Next{});
      stops = std::jthread([&again] {
        system::sleep_until_ns(system::monotonic_ns() + 300'000'000);
        again.push(input::Stop{});
      });
      return;
    }
    again.cooperate(page);
  };
  const auto second = session::run(setup, &again, again.inputs, again.devices());
  CHECK(second.trials == 0);
  CHECK(second.stretched_s > 40);
  CHECK(second.stretched_s < 60);
  CHECK(again.enables().empty());
  const auto stretched = events_of(setup.database, second, "interval_stretched");
  REQUIRE(stretched.size() == 1);
}

TEST_CASE("a session that has used up its time stops and gives the reason", "[session][live]") {
  const TemporaryFolder folder;
  auto setup = live_setup(folder / "a.sqlite");
  setup.rig.limits.session_minutes = 2.5 / 60;
  Room room;
  room.reacts = [&](const auto& page) { room.cooperate(page); };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::interrupted);
  CHECK(summary.reason.find("session's time") != std::string::npos);
}

TEST_CASE("a live session refuses a low tone without a measured sound level before playing it",
          "[session][live]") {
  const TemporaryFolder folder;
  auto setup = live_setup(folder / "a.sqlite");
  auto text = protocol_text("buttons");
  text.replace(text.find("160 + offset_mm"), 15, "100 + offset_mm");
  text.replace(text.find("values = [-20.0, 20.0]"), 22, "values = [-8.0, -4.0]");
  setup.protocol = protocol::parse(text, "live.toml");
  Room room;
  room.reacts = [&](const auto& page) { room.cooperate(page); };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CHECK(summary.status == core::SessionStatus::interrupted);
  CHECK(summary.reason.find("without a measured sound level") != std::string::npos);
  CHECK(room.stimuli == 0);
  CHECK(room.enables().empty());
}

TEST_CASE(
    "a session plays through alsa-lib's null device if the rig allows its plug-ins, but not through a "
    "resampler",
    "[session][live][alsa]") {
  ::setenv("ALSA_CONFIG_PATH", TURNPOINT_SOURCE_DIR "/tests/audio/asound.conf", 1);
  const TemporaryFolder folder;
  session::RunRequest request;
  request.participant = "P01";
  request.database = folder / "a.sqlite";
  auto setup = live_setup(folder / "a.sqlite");
  setup.rig.output.uri = "alsa:to_file";
  setup.rig.output.allow_plugin = {"null", "file"};
  setup.run_mode = core::RunMode::simulated;
  setup.observer = "sim";
  session::Inputs inputs;
  const auto summary = session::run(setup, nullptr, inputs);
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(summary.answered == 2);
  setup.rig.output.uri = "alsa:rated";  // negative control: a resampler is still refused
  CHECK_THROWS(session::run(setup, nullptr, inputs));
}
