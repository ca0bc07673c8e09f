#include <fstream>

#include "station/session/self_test_rig.hpp"
#include "tests/session/live_room.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::session;
using core::name;

namespace {

/// A rig on which everything is in order.
struct GoodRig : SelfTestRig {
  GateReading gate{{}, true, 0.11};
  PressReading stop{{}, "", true, true};
  std::vector<PressReading> buttons{{{}, "left", true, true}, {{}, "right", true, true}};
  std::vector<ToneReading> tones{{{}, "main", 30'000, -0.1, 0.02, core::Proof::ok, core::ProofCause::none}};
  std::vector<CellReading> cells{{{}, core::plain("a"), {}, 0.1, 0.3}};
  MixerReading levels{3, {}};
  std::optional<double> temperature_C = 50;
  ClockReading wall{{"tsc", true, true}, std::nullopt};
  system::Disk store{"/data", 5000, true, "", "ext4"};

  GateReading drop_heartbeat() override { return gate; }
  PressReading press_stop() override { return stop; }
  std::vector<PressReading> press_buttons() override { return buttons; }
  std::vector<ToneReading> play_tones() override { return tones; }
  std::vector<CellReading> read_cells() override { return cells; }
  MixerReading mixer() override { return levels; }
  std::optional<double> hottest_C() override { return temperature_C; }
  ClockReading clock() override { return wall; }
  system::Disk disk() override { return store; }
};

/// The names of the checks with this verdict, separated by commas.
std::string with(Verdict verdict, const std::vector<Check>& checks) {
  std::string names;
  for (const auto& check : checks)
    if (check.verdict == verdict) names += (names.empty() ? "" : ", ") + row_of(check).name;
  return names;
}

std::string failed(const std::vector<Check>& checks) { return with(Verdict::failed, checks); }

CheckRow find(const std::vector<CheckRow>& checks, const std::string& name) {
  for (const auto& check : checks)
    if (check.name == name) return check;
  throw std::logic_error("no check " + name);
}
CheckRow find(const std::vector<Check>& checks, const std::string& name) {
  std::vector<CheckRow> rows;
  for (const auto& check : checks) rows.push_back(row_of(check));
  return find(rows, name);
}

rig::Rig simulated(const TemporaryFolder& folder, const std::string& capture = measured::kCells) {
  return rig::load(measured::with_capture(folder, capture));
}

}  // namespace

TEST_CASE("a rig in order passes every check of the self-test", "[session][self-test]") {
  GoodRig rig;
  const auto checks = self_test(rig);
  CHECK(checks.size() == 12);
  CHECK(failed(checks).empty());
  CHECK(with(Verdict::not_possible, checks).empty());
  CHECK(passed(checks));
}

TEST_CASE("each fault fails its check of the self-test and no other", "[session][self-test]") {
  GoodRig rig;
  const auto expect = [&](const std::string& name) {
    const auto checks = self_test(rig);
    CHECK(failed(checks) == name);
    CHECK_FALSE(passed(checks));
  };
  SECTION("level of the mixer") { rig.levels.changes = {core::plain("changed")}, expect("mixer"); }
  SECTION("gate that never opens") { rig.gate = {{}, false, {}}, expect("gate"); }
  SECTION("gate that never shuts") { rig.gate = {{}, true, {}}, expect("gate"); }
  SECTION("gate that shuts late") { rig.gate = {{}, true, 0.3}, expect("gate"); }
  SECTION("stop without a wire") { rig.stop.pressed = false, expect("stop"); }
  SECTION("stop that is stuck") { rig.stop.released = false, expect("stop"); }
  SECTION("button without a wire") { rig.buttons[1].pressed = false, expect("button right"); }
  SECTION("pick-up without a signal") { rig.tones[0].proof = core::Proof::refused, expect("tone main"); }
  SECTION("tone that was not captured") { rig.tones[0].proof = core::Proof::lost, expect("tone main"); }
  SECTION("overdriven preamplifier") { rig.tones[0].nonlinearity_dB = 0.5, expect("linearity main"); }
  SECTION("load on a cell") { rig.cells[0].zero_N = -1.01, expect("zero of cell a"); }
  SECTION("loose wire of a cell") { rig.cells[0].noise_mN = 2.1, expect("noise of cell a"); }
  SECTION("cell that cannot be read") {
    rig.cells[0].fault = core::plain("a wire is off"), expect("zero of cell a");
  }
  SECTION("hot machine") { rig.temperature_C = 80, expect("temperature"); }
  SECTION("clock that was set") { rig.wall.jump_s = -3600, expect("clock"); }
  SECTION("date that cannot be") { rig.wall.clock.plausible = false, expect("clock"); }
  SECTION("disk nearly full") { rig.store.free_MiB = 199, expect("disk"); }
  SECTION("disk that is write-protected") { rig.store.writable = false, expect("disk"); }
}

TEST_CASE("a check of the self-test is said in the language of the screen, and stored in English",
          "[session][self-test]") {
  GoodRig rig;
  rig.gate = {{}, true, {}};
  rig.tones[0].cause = core::ProofCause::level;
  rig.wall = {{"tsc", false, false}, -3600};
  const auto checks = self_test(rig);
  const auto german = [&](std::size_t k) {
    return core::say(checks.at(k).name, "de") + ": " + core::say(checks.at(k).what, "de");
  };
  CHECK(find(checks, "tone main").what ==
        "a quiet tone of 30.0 kHz was measured at -0.10 dB relative to its calibration: the surface moves "
        "more or less than planned");
  CHECK(find(checks, "clock").what ==
        "source tsc, not synchronised, the date cannot be right, and the clock was set by -3600.000 s during "
        "the self-test");
  CHECK(german(0).starts_with("Gatter: das Gatter bleibt offen, obwohl"));
  CHECK(german(2) == "Taste left: der Tastendruck ist angekommen");
  CHECK(german(4) ==
        "Ton main: ein leiser Ton von 30.0 kHz hatte -0.10 dB gegenüber seiner Kalibrierung: die Oberfläche "
        "bewegt sich stärker oder schwächer als geplant");
  CHECK(german(5) == "Linearität main: die Antwort ist bei drei Pegeln auf 0.02 dB gleich");
  CHECK(german(6) == "Nullpunkt der Zelle a: die Zelle zeigt unbelastet +0.100 N");
}

TEST_CASE("a response that differs a little between levels is reported and passes", "[session][self-test]") {
  GoodRig rig;
  const auto linearity = [&](double off_dB) {
    rig.tones[0].nonlinearity_dB = off_dB;
    return find(self_test(rig), "linearity main");
  };
  CHECK(linearity(0.09).what == "the response is the same at three levels, to 0.09 dB");
  for (const double off_dB : {0.1, 0.49}) {
    CHECK(linearity(off_dB).verdict == Verdict::passed);
    CHECK(linearity(off_dB).what.find("is near its limit") != std::string::npos);
  }
  CHECK(linearity(0.5).verdict == Verdict::failed);
  CHECK(linearity(0.5).limit == 0.5);
}

TEST_CASE("a reading that rounds to zero has no minus sign", "[session][self-test]") {
  GoodRig rig;
  rig.tones.front().ratio_dB = -0.004;
  rig.cells.front().zero_N = -0.0004;
  std::string all;
  for (const auto& check : self_test(rig)) all += row_of(check).what + "\n";
  CHECK(all.find("at +0.00 dB") != std::string::npos);
  CHECK(all.find("reads +0.000 N") != std::string::npos);
}

TEST_CASE("what a rig does not have is not possible to check, and does not fail", "[session][self-test]") {
  GoodRig rig;
  rig.gate.missing = rig.stop.missing = rig.buttons[0].missing = rig.tones[0].missing = rig.cells[0].missing =
      core::plain("the rig has none");
  rig.tones[0].nonlinearity_dB.reset();
  rig.tones.push_back({{}, "second", 30'000, 0, {}, core::Proof::unproven, core::ProofCause::none});
  rig.temperature_C.reset();
  rig.levels.controls = 0;
  const auto checks = self_test(rig);
  CHECK(with(Verdict::not_possible, checks) ==
        "gate, stop, button left, tone main, tone second, cells, mixer, temperature");
  CHECK(passed(checks));
}

TEST_CASE("a part of the rig that throws has failed, and the other parts are still checked",
          "[session][self-test]") {
  struct Throws : GoodRig {
    std::vector<ToneReading> play_tones() override {
      throw std::runtime_error("the capture is disconnected");
    }
  } rig;
  const auto checks = self_test(rig);
  CHECK(failed(checks) == "tone");
  CHECK(find(checks, "tone").what == "the capture is disconnected");
  CHECK(find(checks, "disk").verdict == Verdict::passed);
}

TEST_CASE("the self-test measures the simulated rig and finds nothing wrong",
          "[session][self-test][threads]") {
  const TemporaryFolder folder;
  SimulatedFaults none;
  none.sensors = folder / "nothing";
  const auto checks = simulated_self_test(simulated(folder), folder.path, none);
  for (const auto& check : checks)
    UNSCOPED_INFO(row_of(check).name << ": " << name(check.verdict) << ", " << row_of(check).what);
  CHECK(failed(checks).empty());
  CHECK(with(Verdict::not_possible, checks) == "mixer, temperature");
  // The monostable of the simulated gate lasts 110 ms, and the heartbeat may have toggled 10 ms before.
  CHECK(find(checks, "gate").value.value() > 90);
  CHECK(find(checks, "linearity main").value.value() < 0.01);
  CHECK(find(checks, "tone main").what.find("the surface") == std::string::npos);  // names no deviation
  CHECK(find(checks, "zero of cell lateral").value.value() == Approx(0).margin(0.05));
  CHECK(find(checks, "noise of cell a").value.value() > 0.05);
}

TEST_CASE("the self-test finds each fault of the simulated rig", "[session][self-test][threads]") {
  const TemporaryFolder folder;
  SimulatedFaults faults;
  faults.sensors = folder / "nothing";
  std::string wrong;
  SECTION("the heartbeat does not reach the gate") {
    faults.lines = [](auto& lines) { lines.bridge_monostable(); };
    wrong = "gate";
  }
  SECTION("the gate never opens") {
    faults.lines = [](auto& lines) { lines.break_gate(); };
    wrong = "gate";
  }
  SECTION("the stop is not connected") {
    faults.stop_disconnected = true;
    faults.longest_press_s = 0.5;
    wrong = "stop";
  }
  SECTION("the surface does not move") {
    faults.room = [](auto& room) {
      room.plant().add({simulation::FaultKind::transducer_dead, 0, simulation::kNever});
    };
    wrong = "tone main";
  }
  SECTION("the preamplifier of the pick-ups is overdriven") {
    faults.laboratory = [](auto& room) {
      for (auto& pickup : room.pickups) pickup.cubic = -65;
    };
    wrong = "tone main, linearity main";
  }
  SECTION("a cell is bent") {
    faults.laboratory = [](auto& room) { room.cells.zero_N[1] = 1.5; };
    wrong = "zero of cell b";
  }
  SECTION("the bridge of a cell is dead") {
    faults.room = [](auto& room) {
      room.plant().add({simulation::FaultKind::dead_bridge, 0, simulation::kNever, {}, 1});
    };
    wrong = "zero of cell b";
  }
  SECTION("the cells are noisy") {
    faults.laboratory = [](auto& room) { room.wires.noise_V_per_rtHz = 60e-9; };
    wrong = "noise of cell a, noise of cell b, noise of cell lateral";
  }
  SECTION("somebody sets the clock") {
    faults.clocks = [calls = 0]() mutable {
      auto now = system::read_clocks();
      if (calls++ > 0) now.realtime_ns += 60'000'000'000;
      return now;
    };
    wrong = "clock";
  }
  CHECK(failed(simulated_self_test(simulated(folder), folder.path, faults)) == wrong);
}

TEST_CASE("the hottest sensor of the machine counts", "[system][self-test]") {
  const TemporaryFolder folder;
  CHECK_FALSE(system::hottest_C(folder.path));
  for (const auto& [chip, text] :
       {std::pair{"hwmon0", "48250"}, {"hwmon1", "61000"}, {"hwmon2", "-273000"}}) {
    std::filesystem::create_directory(folder / chip);
    std::ofstream(folder / chip + "/temp1_input") << text << "\n";
    std::ofstream(folder / chip + "/temp1_max") << "90000\n";
  }
  CHECK(system::hottest_C(folder.path).value() == Approx(61));
}

namespace {

/// Runs a simulated session with the self-test, in a room with this fault.
struct TestedSession {
  TemporaryFolder folder;
  Setup setup = live_room::live_setup(folder / "a.sqlite");
  Inputs inputs;

  TestedSession() {
    setup.rig = simulated(folder, measured::kPickUps);
    setup.run_mode = core::RunMode::simulated;
    setup.observer = "sim";
  }

  Summary run(const std::function<void(SimulatedRoom&)>& spoil = {}) {
    setup.self_test = true;
    auto room = std::make_unique<SimulatedRoom>(setup.rig);
    if (spoil) spoil(*room);
    return session::run(setup, nullptr, inputs, std::move(room));
  }
  core::EventRow tested(const Summary& summary) const {
    const auto stored = store::read_session(setup.database, summary.session_id);
    for (const auto& event : stored.events)
      if (event.kind == "self_test") return event;
    throw std::runtime_error("no self-test was stored");
  }
};

void kill_transducer(SimulatedRoom& room) {
  room.plant().add({simulation::FaultKind::transducer_dead, 0, 100'000});
}

}  // namespace

TEST_CASE("the self-test runs before the first block and is stored with the session",
          "[session][self-test]") {
  TestedSession session;
  const auto summary = session.run();
  CHECK(summary.status == core::SessionStatus::completed);
  const auto event = session.tested(summary);
  CHECK(event.value == "passed");
  CHECK(find(event.checks, "tone main").verdict == Verdict::passed);
  CHECK(find(event.checks, "gate").verdict == Verdict::not_possible);
  CHECK(find(event.checks, "disk").limit == kLeastDisk_MiB);
}

TEST_CASE("a failed check stops the session before anybody is stimulated", "[session][self-test]") {
  TestedSession session;
  const auto summary = session.run(kill_transducer);
  CHECK(summary.status == core::SessionStatus::interrupted);
  CHECK(summary.reason.find("the self-test failed: tone main: ") == 0);
  CHECK(summary.trials == 0);
  CHECK(session.tested(summary).value == "failed");
  CHECK(find(session.tested(summary).checks, "tone main").verdict == Verdict::failed);
}

TEST_CASE("a session continues in spite of a failed check if the operator gives the reason, which is stored",
          "[session][self-test]") {
  TestedSession session;
  session.setup.despite = "the pick-up is being repaired";
  const auto summary = session.run(kill_transducer);
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(session.tested(summary).value == "failed; continued: the pick-up is being repaired");
}

TEST_CASE("what is known about room, surface and finger is stored with the session", "[session][self-test]") {
  TestedSession session;
  session.setup.conditions = {45.0, 21.5, false, "left-index", 38.0};
  const auto summary = session.run();
  const auto stored =
      store::read_session(session.setup.database, summary.session_id).session.start.conditions;
  CHECK(stored.humidity_percent == 45.0);
  CHECK(stored.room_temperature_C == 21.5);
  CHECK(stored.surface_cleaned == false);
  CHECK(stored.finger == "left-index");
  CHECK(stored.skin_moisture == 38.0);
}

TEST_CASE("in the room, the operator ends a session after a failed check, or writes why it continues",
          "[session][self-test][threads]") {
  TemporaryFolder folder;
  live_room::Room room;
  auto setup = live_room::live_setup(folder / "a.sqlite");
  setup.self_test = true;
  const bool continues = GENERATE(true, false);
  room.reacts = [&](const Page& page) {
    if (page.kind != PageKind::fault || page.fault.kind != FaultKind::self_test) return room.cooperate(page);
    CHECK(page.fault.detail.find("gate: the gate stays open") == 0);
    room.push(continues ? input::Any(input::Note{"the oscilloscope shows that it shuts"}) : input::Stop{});
  };
  const auto lines = std::make_shared<io::SimulatedAmplifierLines>();
  lines->bridge_monostable();
  auto devices = room.devices();
  devices.amplifier = io::simulated_amplifier(lines);
  const auto summary = session::run(setup, &room, room.inputs, std::move(devices));
  const auto events = live_room::events_of(setup.database, summary, "self_test");
  REQUIRE(events.size() == 1);
  CHECK(find(events[0].checks, "gate").verdict == Verdict::failed);
  CHECK(find(events[0].checks, "stop").verdict == Verdict::not_possible);
  if (continues) {
    CHECK(summary.status == core::SessionStatus::completed);
    CHECK(events[0].value == "failed; continued: the oscilloscope shows that it shuts");
  } else {
    CHECK(summary.status == core::SessionStatus::interrupted);
    CHECK(room.stimuli == 0);
    CHECK(events[0].value == "failed");
  }
}
