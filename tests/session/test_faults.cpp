// For each fault that can switch the amplifier off, a test causes it at its source and checks the page that
// explains it. The trial must be void, the enable line must be low before the page is shown, and the trial
// must be repeated after the operator has cleared the fault. tests/ui/tst_faults.qml tests faults of the
// touch panel and the disk.
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <functional>
#include <memory>
#include <thread>
#include <utility>

#include "tests/session/faulty_stream.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using namespace turnpoint::live_room;
using core::FaultKind;

namespace {

/// Lines whose enable output stops working when the test says so.
struct BrokenLines : SharedLines {
  BrokenLines(const std::shared_ptr<io::SimulatedLines>& shared, std::atomic<bool>& broken_)
      : SharedLines(shared), broken(broken_) {}
  std::optional<bool> read_back(int index) override {
    return broken ? std::optional(false) : SharedLines::read_back(index);
  }
  std::atomic<bool>& broken;
};

/// Runs a session in which one fault happens during the first stimulus.
struct Mishap {
  TemporaryFolder folder;
  session::Setup setup = live_setup(folder / "a.sqlite");
  Room room;
  Misfortunes misfortunes;
  std::atomic<std::int64_t> slept_ns{0};
  std::atomic<bool> enable_broken{false};
  std::atomic<bool> audio_lives{true};
  bool chip_gone = false;  ///< true if the fault removes the GPIO chip, so that its levels cannot be read
  std::function<void()> strikes, operator_repairs = [] {};
  std::vector<session::Page> faults;
  std::unique_ptr<std::jthread> audio;
  int low_when_shown = 0;

  session::Devices devices() {
    auto devices = room.devices();
    devices.amplifier = io::guard_amplifier(
        [this] {
          static_cast<void>(room.lines->level(0));
          return std::make_unique<BrokenLines>(room.lines, enable_broken);
        },
        {SharedLines::enable, SharedLines::heartbeat, SharedLines::fault, SharedLines::stop});
    devices.open_stream = [this](audio::StreamConfig config) {
      return std::make_unique<FaultyStream>(audio::open_realtime(config), misfortunes);
    };
    devices.clocks = [this] {
      auto clocks = system::read_clocks();
      clocks.boottime_ns += slept_ns;
      clocks.realtime_ns += slept_ns;
      return clocks;
    };
    return devices;
  }

  void react(const session::Page& page) {
    // stop reporting, because the amplifier ends with the session
    if (page.kind == PageKind::end) audio.reset();
    if (page.kind == PageKind::stimulus && room.stimuli == 1) return strikes();
    if (page.kind == PageKind::fault && room.stimuli == 1) {
      faults.push_back(page);
      low_when_shown += chip_gone || !room.lines->level(SharedLines::enable) ? 1 : 0;
      operator_repairs();
    }
    room.cooperate(page);
  }

  /// Checks the faults after the one that the test caused, and returns how many pages showed them. Only a
  /// machine that is too busy may have caused them.
  std::ptrdiff_t later_faults() const {
    int stimuli = 0;
    return std::ranges::count_if(room.pages, [&](const session::Page& page) {
      if (page.kind == PageKind::stimulus) ++stimuli;
      if (page.kind != PageKind::fault || stimuli < 2) return false;
      INFO(core::name(page.fault.kind) << ": " << page.fault.detail);
      CHECK(machine_was_busy(page.fault.kind));
      return true;
    });
  }

  /// Runs a session and returns the page that explained the fault.
  session::Page runs(session::Devices with) {
    room.reacts = [this](const auto& page) { react(page); };
    const auto summary = session::run(setup, &room, room.inputs, std::move(with));
    CHECK(summary.status == core::SessionStatus::completed);
    const auto trials = trials_of(setup.database, summary);
    const auto voided = std::ranges::count(trials, core::Outcome::fault, &core::TrialRow::outcome);
    REQUIRE(static_cast<std::ptrdiff_t>(trials.size()) == 2 + voided);
    const auto later = later_faults();
    CHECK(voided >= 1);
    CHECK(voided <= 1 + later);
    CHECK(trials[0].outcome == core::Outcome::fault);
    CHECK(trials[1].level == trials[0].level);
    REQUIRE_FALSE(faults.empty());
    CHECK(low_when_shown == static_cast<int>(faults.size()));
    const auto logged = events_of(setup.database, summary, "fault");
    REQUIRE_FALSE(logged.empty());
    CHECK(logged.front().value.find(core::name(faults.front().fault.kind)) == 0);
    return faults.front();
  }
  session::Page runs() { return runs(devices()); }
};

/// Waits up to ten seconds until the guard has switched the amplifier off. The limit only ends a test that
/// hangs.
void until_low(const Room& room) {
  const auto end_ns = system::monotonic_ns() + 10'000'000'000;
  while (room.lines->level(SharedLines::enable) && system::monotonic_ns() < end_ns) std::this_thread::yield();
}

}  // namespace

TEST_CASE("the amplifier's own fault causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.room.lines->set(SharedLines::fault, true, system::monotonic_ns()); };
  mishap.operator_repairs = [&] {
    mishap.room.lines->set(SharedLines::fault, false, system::monotonic_ns());
  };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::amplifier);
  CHECK(page.fault.detail.find("the amplifier was switched off after") == 0);
}

TEST_CASE("a pressed stop causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.room.lines->set(SharedLines::stop, true, system::monotonic_ns()); };
  mishap.operator_repairs = [&] { mishap.room.lines->set(SharedLines::stop, false, system::monotonic_ns()); };
  CHECK(mishap.runs().fault.kind == FaultKind::stop_pressed);
}

TEST_CASE("an enable line that does not follow causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.enable_broken = true; };
  mishap.operator_repairs = [&] { mishap.enable_broken = false; };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::enable_line);
  CHECK(page.fault.detail == "the line was set high but reads low");
}

TEST_CASE("lost GPIO lines cause a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] {
    mishap.chip_gone = true;
    mishap.room.lines->remove();
  };
  mishap.operator_repairs = [&] { mishap.room.lines->put_back(); };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::lines_gone);
  CHECK(page.fault.detail == "simulated gpio chip: No such device");
}

TEST_CASE("a silent audio thread causes a fault page", "[session][live][fault][threads]") {
  Mishap mishap;
  auto devices = mishap.devices();
  devices.open_stream = [](audio::StreamConfig config) {
    config.amplifier = nullptr;  // instead of the stream, the test reports that the audio thread is alive
    return audio::open_realtime(config);
  };
  mishap.audio = std::make_unique<std::jthread>(
      [&amplifier = *devices.amplifier, &lives = mishap.audio_lives](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          if (lives) amplifier.audio_alive();
          system::sleep_until_ns(system::monotonic_ns() + 2'000'000);
        }
      });
  mishap.strikes = [&] { mishap.audio_lives = false; };
  mishap.operator_repairs = [&] { mishap.audio_lives = true; };
  CHECK(mishap.runs(std::move(devices)).fault.kind == FaultKind::audio_silent);
}

TEST_CASE("a session that hangs causes a fault page", "[session][live][fault][threads]") {
  Mishap mishap;
  mishap.strikes = [&] { until_low(mishap.room); };  // blocks the session's own thread
  CHECK(mishap.runs().fault.kind == FaultKind::session_silent);
}

TEST_CASE("a participant's page that hangs causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  auto& inputs = mishap.room.inputs;
  inputs.page_alive(system::monotonic_ns() + 3'600'000'000'000);
  mishap.strikes = [&] { inputs.page_alive(system::monotonic_ns() - 1'900'000'000); };
  mishap.operator_repairs = [&] { inputs.page_alive(system::monotonic_ns() + 3'600'000'000'000); };
  CHECK(mishap.runs().fault.kind == FaultKind::page_silent);
}

TEST_CASE("a suspended machine causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.slept_ns = 90'000'000'000; };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::suspended);
  CHECK(page.fault.detail == "the computer was suspended for 90.0 s");
}

TEST_CASE("the loss of the sound device causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.misfortunes.happen({audio::EventKind::device_lost, 0, 0, 0, -ENODEV}); };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::converter_gone);
  CHECK(page.fault.detail == "No such device");
}

TEST_CASE("a wrong rate causes a fault page, and arming is refused until the device was reopened",
          "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.misfortunes.happen({audio::EventKind::rate_wrong, 0, 0, 96'000'000, 0}); };
  mishap.operator_repairs = [&] {
    if (mishap.faults.size() == 3) mishap.misfortunes.happen({audio::EventKind::device_back, 0, 0, 0, 0});
  };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::converter_rate);
  CHECK(page.fault.detail.find("96000.0 Hz instead of ") == 0);
  REQUIRE(mishap.faults.size() >= 3);
  CHECK(mishap.faults[1].fault.detail.find("refused: sound device running at a wrong rate") == 0);
}

TEST_CASE("clipping causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.misfortunes.clipped = 384; };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::converter_saturated);
  CHECK(page.fault.detail == "384 samples clipped");
}

TEST_CASE("an amplifier that nobody has armed causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.room.push(input::Disarm{}); };
  mishap.room.reacts = [&](const auto& page) { mishap.react(page); };
  const auto summary = session::run(mishap.setup, &mishap.room, mishap.room.inputs, mishap.devices());
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(mishap.room.pages.front().fault.kind ==
        FaultKind::disarmed);  // the first page, before the first arming
  REQUIRE_FALSE(mishap.faults.empty());
  CHECK(mishap.faults.front().fault.kind == FaultKind::disarmed);
}

TEST_CASE("a stimulus that came too late causes a fault page", "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] { mishap.misfortunes.happen({audio::EventKind::burst_missed, 1, 0, 0, 0}); };
  mishap.room.reacts = [&](const auto& page) { mishap.react(page); };
  const auto summary = session::run(mishap.setup, &mishap.room, mishap.room.inputs, mishap.devices());
  CHECK(summary.voided == 1);
  REQUIRE_FALSE(mishap.faults.empty());
  CHECK(mishap.faults.front().fault.kind == FaultKind::stimulus_missed);
}

TEST_CASE("an answer to a stimulus that a stalled drive has not begun causes a fault page",
          "[session][live][fault]") {
  Mishap mishap;
  mishap.strikes = [&] {
    mishap.misfortunes.stalled = true;
    mishap.room.press(0);
  };
  mishap.operator_repairs = [&] { mishap.misfortunes.stalled = false; };
  const auto page = mishap.runs();
  CHECK(page.fault.kind == FaultKind::stimulus_missed);
  CHECK(page.fault.detail == "the trial was answered before the drive had begun the stimulus");
}

TEST_CASE("a limit of the rig is shown on a page; the session ends there, with the reason",
          "[session][live][fault]") {
  Mishap mishap;
  mishap.setup.rig.limits.session_minutes = 2.5 / 60;
  mishap.room.reacts = [&](const auto& page) { mishap.room.cooperate(page); };
  const auto summary = session::run(mishap.setup, &mishap.room, mishap.room.inputs, mishap.devices());
  CHECK(summary.status == core::SessionStatus::interrupted);
  const auto& pages = mishap.room.pages;
  const auto page = std::find_if(pages.begin(), pages.end(),
                                 [](const auto& shown) { return shown.fault.kind == FaultKind::limits; });
  REQUIRE(page != pages.end());
  CHECK(page->kind == PageKind::fault);
  CHECK(page->fault.detail == summary.reason);
  CHECK(events_of(mishap.setup.database, summary, "fault").size() == 1);
}
