#include <algorithm>
#include <functional>
#include <thread>
#include <utility>

#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

// Tests that after somebody has asked for a pause, no stimulus is presented until somebody has pressed
// Continue, whatever the session was doing at that moment.

using namespace turnpoint;
using namespace turnpoint::live_room;

namespace {

/// A room in which `asks` may ask for one pause. Everything else in it happens as usual.
struct PausingRoom : Room {
  const TemporaryFolder folder;
  session::Setup setup = live_setup(folder / "a.sqlite");
  bool asked = false;
  std::size_t asked_at = 0;  ///< number of pages shown when the pause was asked for
  /// Ends a session that waits for a page that never comes.
  std::jthread patience{[this](const std::stop_token& stop) {
    for (int i = 0; i < 200 && !stop.stop_requested(); ++i)
      system::sleep_until_ns(system::monotonic_ns() + 50'000'000);
    push(input::Stop{});
  }};

  void ask() {
    asked = true;
    asked_at = pages.size();
    push(input::Pause{});
  }

  session::Summary run(const std::function<bool(const session::Page&)>& asks) {
    reacts = [this, asks](const auto& page) {
      if (!asked && asks(page)) return ask();
      cooperate(page);
      if (page.kind == PageKind::rest && page.remaining_s <= 0) push(input::Next{});
    };
    return session::run(setup, this, inputs, devices());
  }

  /// The kind of page that the session showed in response to the request.
  PageKind answered_by() const { return asked_at < pages.size() ? pages[asked_at].kind : PageKind::end; }
  int count(PageKind kind) const {
    return static_cast<int>(
        std::count_if(pages.begin(), pages.end(), [kind](const auto& page) { return page.kind == kind; }));
  }
};

void add_breaks(session::Setup& setup, const std::string& min_s) {
  setup.protocol = protocol::parse(
      protocol_text("buttons") + "break_after = { trials = 1, min_s = " + min_s + " }\n", "live.toml");
}

}  // namespace

TEST_CASE("a pause on the page of instructions is shown at once, and the instructions follow again",
          "[session][pause]") {
  PausingRoom room;
  const auto summary = room.run([](const auto& page) { return page.kind == PageKind::instructions; });
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(summary.answered == 2);
  CHECK(room.answered_by() == PageKind::paused);
  CHECK(room.pages[room.asked_at + 1].kind == PageKind::instructions);
  CHECK(room.count(PageKind::paused) == 1);
}

TEST_CASE("a pause in a break is shown at once, and the time of the break continues to run",
          "[session][pause]") {
  const double remaining_s = GENERATE(1.0, 0.0);
  PausingRoom room;
  add_breaks(room.setup, "0.6");
  const auto summary = room.run([remaining_s](const auto& page) {
    return page.kind == PageKind::rest && (page.remaining_s > 0) == (remaining_s > 0);
  });
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(room.answered_by() == PageKind::paused);
  const auto& after = room.pages[room.asked_at + 1];
  CHECK(after.kind == PageKind::rest);
  CHECK(after.remaining_s < 0.6);
}

TEST_CASE("a pause while the row of a trial is being stored comes before the next stimulus",
          "[session][pause]") {
  struct Storing : session::Monitor {
    PausingRoom& room;
    explicit Storing(PausingRoom& in) : room(in) {}
    void trial_ended(const trial::TrialSpec&, const core::TrialRow& row) override {
      // A machine that stalls makes a trial void; then a fault page comes first.
      if (!room.asked && row.outcome == core::Outcome::answered) room.ask();
    }
  };
  PausingRoom room;
  Storing storing(room);
  room.reacts = [&room](const auto& page) { room.cooperate(page); };
  const auto summary = session::run(room.setup, &room, room.inputs, room.devices(), &storing);
  CHECK(summary.answered == 2);
  CHECK(room.answered_by() == PageKind::paused);
  CHECK(room.count(PageKind::paused) == 1);
}

TEST_CASE("a pause is shown at once while the limit of duty lengthens the interval between trials",
          "[session][pause]") {
  PausingRoom room;
  room.setup.rig.limits.duty = 0.04;  // 2.4 s per minute, enough for one stimulus of 2 s only
  room.reacts = [&](const auto& page) {
    if (page.kind == PageKind::stimulus) return;  // feel until the stimulus ends
    if (page.kind == PageKind::response) return room.press(0);
    // The first page is that of the interval itself; the second is shown while the interval is lengthened.
    if (page.kind == PageKind::interval && room.count(PageKind::interval) == 2) return room.ask();
    if (page.kind == PageKind::interval && room.asked) return room.push(input::Stop{});
    room.cooperate(page);
  };
  const auto summary = session::run(room.setup, &room, room.inputs, room.devices());
  CHECK(summary.answered == 1);
  CHECK(room.count(PageKind::paused) == 1);
  CHECK(room.answered_by() == PageKind::paused);
  REQUIRE(room.asked_at + 1 < room.pages.size());
  CHECK(room.pages[room.asked_at + 1].kind == PageKind::interval);
}

TEST_CASE("a pause that comes together with a fault is not forgotten when the fault is repaired",
          "[session][pause]") {
  PausingRoom room;
  const auto summary = room.run([&room](const auto& page) {
    if (page.kind != PageKind::stimulus) return false;
    room.push(session::Fault{});
    return true;
  });
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(room.answered_by() == PageKind::fault);
  CHECK(room.pages[room.asked_at + 1].kind == PageKind::paused);
}

TEST_CASE("a press of Continue that was meant for the previous page does not leave the next one",
          "[session][pause]") {
  PausingRoom room;
  std::jthread stops;
  room.reacts = [&](const auto& page) {
    if (page.kind != PageKind::instructions) return room.cooperate(page);
    room.push(input::Next{}, -300'000'000);
    stops = std::jthread([&room] {
      system::sleep_until_ns(system::monotonic_ns() + 300'000'000);
      room.push(input::Stop{});
    });
  };
  const auto summary = session::run(room.setup, &room, room.inputs, room.devices());
  CHECK(summary.trials == 0);
  CHECK(room.count(PageKind::cue) == 0);
}
