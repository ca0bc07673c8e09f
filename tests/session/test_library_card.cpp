// Tests force cells whose bridges are captured through the real alsa-lib: a live session in real time on a
// simulated card, which is a plug-in of alsa-lib (library_card_plugin.cpp).
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "station/audio/alsa_device.hpp"
#include "station/core/limits.hpp"
#include "station/maintenance/calibrate.hpp"
#include "station/rig/apply.hpp"
#include "station/sensing/carrier.hpp"
#include "station/sensing/force_calibration.hpp"
#include "station/session/self_test.hpp"
#include "station/session/stage.hpp"
#include "station/session/vibration_watch.hpp"
#include "station/store/open.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/stored_signals.hpp"
#include "tests/session/library_card.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using live_room::PageKind;

namespace turnpoint {

std::int64_t LibraryCard::frame_now() {
  return static_cast<std::int64_t>(static_cast<double>(system::monotonic_ns()) * 1e-9 * kRate_Hz);
}

void LibraryCard::start(bool capture) {
  const std::lock_guard lock(mutex_);
  if (!capture) played_.reserve(static_cast<std::size_t>(played_channels) * kRate_Hz * 60);
  started_[capture ? 1 : 0] = frame_now();
}

std::int64_t LibraryCard::position(bool capture) const {
  const std::lock_guard lock(mutex_);
  return frame_now() - started_[capture ? 1 : 0];
}

void LibraryCard::play(std::int64_t first, std::span<const std::int32_t> samples) {
  const std::lock_guard lock(mutex_);
  const auto at = static_cast<std::size_t>(first * played_channels);
  if (played_.size() < at + samples.size()) played_.resize(at + samples.size());
  std::copy(samples.begin(), samples.end(), played_.begin() + static_cast<std::ptrdiff_t>(at));
}

void LibraryCard::capture(std::int64_t first, std::span<std::int32_t> samples) {
  const std::lock_guard lock(mutex_);
  const std::vector<std::int32_t> silence(static_cast<std::size_t>(played_channels));
  const auto channels = static_cast<std::size_t>(captured_channels);
  for (std::size_t n = 0; n * channels < samples.size(); ++n) {
    const auto frame = started_[1] + first + static_cast<std::int64_t>(n);
    const auto at = (frame - delay_frames - started_[0]) * played_channels;
    const bool known = at >= 0 && static_cast<std::size_t>(at + played_channels) <= played_.size();
    const auto played =
        known ? std::span<const std::int32_t>(played_).subspan(static_cast<std::size_t>(at), silence.size())
              : std::span<const std::int32_t>(silence);
    wires(played, samples.subspan(n * channels, channels), frame);
  }
}

}  // namespace turnpoint

namespace {

LibraryCard card;

constexpr double kPi = 3.14159265358979;
constexpr double kPerN = 0.05, kZero = 0.01, kReference = 0.8;
constexpr double kNormal_N = 0.5, kFriction = 0.6, kReach_mm = 50, kStrokes_Hz = 1;

/// Forces on the cells a, b and lateral.
std::array<double, 3> forces_of(double normal_N, double lateral_N, double share) {
  return {normal_N * (1 - share), normal_N * share, lateral_N};
}

/// A finger that slides to and fro, and the wires of bridges that it loads.
struct Finger {
  std::atomic<std::int64_t> touches_at{-1};  ///< frame of the card; -1: it does not touch
  std::atomic<bool> wire_off{false};
  double length_mm = 300;

  void capture(std::span<const std::int32_t> played, std::span<std::int32_t> captured,
               std::int64_t frame) const {
    std::array<double, 3> forces{};
    const auto from = touches_at.load();
    if (from >= 0 && frame > from) {
      const double s = static_cast<double>(frame - from) / LibraryCard::kRate_Hz;
      const double phase = 2 * kPi * kStrokes_Hz * s;
      const double speed_mm_s = 2 * kPi * kStrokes_Hz * kReach_mm * std::cos(phase);
      const double normal_N = kNormal_N * std::min(1.0, s / 0.05);
      forces = forces_of(normal_N, kFriction * normal_N * std::tanh(speed_mm_s / 5),
                         0.5 + kReach_mm * std::sin(phase) / length_mm);
    }
    captured[0] = static_cast<std::int32_t>(std::lrint(kReference * played[2]));
    captured[1] = played[0] / 2;
    for (std::size_t k = 0; k < 3; ++k)
      captured[2 + k] =
          static_cast<std::int32_t>(std::lrint(kReference * played[2] * (kZero + kPerN * forces[k])));
    if (wire_off) captured[3] = captured[0];
  }
};

rig::ForceCells cells_of(double length_mm) {
  std::vector<sensing::DeadWeight> weights;
  for (const double share : {0.2, 0.5, 0.8})
    for (const double pull_N : {-0.5, 0.0, 0.5}) {
      auto& weight = weights.emplace_back(sensing::DeadWeight{1, pull_N, share * length_mm, {}});
      const auto forces = forces_of(1, pull_N, share);
      for (std::size_t k = 0; k < 3; ++k) weight.readings[k] = kPerN * forces[k];
    }
  rig::ForceCells cells;
  cells.matrix = sensing::fit_weights(weights).calibration.matrix();
  cells.carrier_Hz = core::kForceCarrier_Hz;
  cells.reference_amplitude = kReference * session::kCarrier;
  cells.rated_ratio.fill(10 * kPerN);
  return cells;
}

/// Makes alsa-lib read a configuration in which the device `looped` is the plug-in.
void use_plugin(const TemporaryFolder& folder) {
  const auto path = folder / "asound.conf";
  std::ofstream(path) << "pcm_type.looped { lib \"" << LIBRARY_CARD_PLUGIN << "\" }\n"
                      << "pcm.looped { type looped }\n"
                      << "ctl_type.looped { lib \"" << LIBRARY_CARD_PLUGIN << "\" }\n"
                      << "ctl.looped { type looped }\n"
                      << "ctl.another { type looped }\n";
  ::setenv("ALSA_CONFIG_PATH", path.c_str(), 1);
}

session::Setup setup_on(const TemporaryFolder& folder) {
  auto setup = live_room::live_setup(folder / "a.sqlite");
  auto& rig = setup.rig;
  rig.output.uri = "alsa:looped";
  rig.output.allow_plugin = {"ioplug"};
  rig.output.period_frames = 1920;
  rig.output.periods = 16;
  rig.capture = rig::Capture{"alsa:looped", 5, {1}, 0, 2, {}};
  rig.capture->bridges = {2, 3, 4};
  rig.capture->forces = cells_of(1e3 * rig.surface.length_m);
  rig.capture->responses = {{1, 0, {{1'000, 0.5, 0}, {40'000, 0.5, 0}, {80'000, 0.5, 0}}}};
  return setup;
}

}  // namespace

extern "C" LibraryCard* turnpoint_library_card() { return &card; }

TEST_CASE("a live session reads its force cells through alsa-lib, and stores what the finger did",
          "[session][alsa][forces]") {
  const TemporaryFolder folder;
  use_plugin(folder);
  auto setup = setup_on(folder);
  Finger finger;
  finger.length_mm = 1e3 * setup.rig.surface.length_m;
  finger.wire_off = GENERATE(false, true);
  card.played_channels = session::session_stream(setup.rig).output.channels;
  card.captured_channels = setup.rig.capture->channels;
  card.wires = [&](auto played, auto captured, std::int64_t frame) {
    finger.capture(played, captured, frame);
  };
  live_room::Room room;
  std::string faults;
  room.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::fault) faults += page.text + " " + page.fault.detail + "; ";
    finger.touches_at = page.kind == PageKind::stimulus ? LibraryCard::frame_now() + 20'000 : -1;
    if (page.kind == PageKind::response) return room.press(0);
    if (page.kind != PageKind::stimulus) room.cooperate(page);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  CAPTURE(faults);
  CHECK(summary.status == core::SessionStatus::completed);
  const auto trials = live_room::trials_of(setup.database, summary);
  REQUIRE(trials.size() == 2);
  for (const auto& trial : trials) {
    CHECK(trial.outcome == core::Outcome::answered);
    CHECK(trial.surface.proof == core::Proof::ok);
    if (finger.wire_off) {
      CHECK(trial.finger.sensing != "ok");
      CHECK_FALSE(trial.finger.normal_N);
      continue;
    }
    REQUIRE(trial.finger.sensing == "ok");
    CHECK(trial.finger.normal_N.value() == Approx(kNormal_N).epsilon(0.02));
    CHECK(trial.finger.mu.value() == Approx(kFriction).epsilon(0.03));
    CHECK(trial.finger.strokes.value() >= 1);
  }
  auto database = store::open_reader(setup.database);
  store::SignalReader signals(database, summary.session_id, "finger");
  int rows = 0;
  while (const auto signal = signals.next()) {
    ++rows;
    const auto values = store::decode(signal->row);
    CHECK(*std::max_element(values[0].begin(), values[0].end()) == Approx(kNormal_N).epsilon(0.1));
  }
  CHECK(rows == (finger.wire_off ? 0 : 2));
}

TEST_CASE(
    "a level of the mixer that changes during a session stops it at the end of the block, or is stored with "
    "the reason",
    "[session][alsa][mixer]") {
  using Kind = LibraryCard::Control::Kind;
  const TemporaryFolder folder;
  use_plugin(folder);
  auto setup = setup_on(folder);
  setup.rig.capture.reset();
  card.played_channels = session::session_stream(setup.rig).output.channels;
  card.controls = {{Kind::level, "Digital Playback Volume", {207, 207}},
                   {Kind::toggle, "Speaker Switch", {1, 0}}};
  setup.rig.mixer = session::mixer_levels(setup.rig);
  REQUIRE(setup.rig.mixer.size() == 2);
  // What happens after the first stimulus, and what the operator then says.
  enum class Change { none, level, muted, renamed, gone, again };
  const auto [change, continues] = GENERATE(table<Change, bool>({{Change::none, true},
                                                                 {Change::level, true},
                                                                 {Change::again, true},
                                                                 {Change::level, false},
                                                                 {Change::muted, false},
                                                                 {Change::renamed, false},
                                                                 {Change::gone, false}}));
  live_room::Room room;
  int asked = 0;
  room.reacts = [&, change = change, continues = continues](const session::Page& page) {
    if (page.kind == PageKind::fault && page.fault.kind == core::FaultKind::self_test) {
      ++asked;
      if (change == Change::again) card.controls[0].values = {207, 207};
      return room.push(continues ? live_room::input::Any(live_room::input::Note{"set back by hand"})
                                 : live_room::input::Stop{});
    }
    if (page.kind == PageKind::stimulus && (change == Change::level || change == Change::again))
      card.controls[0].values = {207, 180};
    if (page.kind == PageKind::stimulus && change == Change::muted) card.controls[1].values = {0, 0};
    if (page.kind == PageKind::stimulus && change == Change::renamed)
      card.controls[0].name = "Master Playback Volume";
    if (page.kind == PageKind::stimulus && change == Change::gone) card.controls.clear();
    if (page.kind == PageKind::response) return room.press(0);
    if (page.kind != PageKind::stimulus) room.cooperate(page);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices());
  const auto events = live_room::events_of(setup.database, summary, "mixer");
  CHECK(asked == (change == Change::none ? 0 : 1));
  REQUIRE(events.size() == (change == Change::none ? 0 : 1));
  const bool completes = change == Change::none || continues;
  CHECK(summary.status == (completes ? core::SessionStatus::completed : core::SessionStatus::interrupted));
  if (change == Change::level)
    CHECK(events[0].value ==
          std::string("the control \"Digital Playback Volume\" of the sound device is at 207, 180; "
                      "during the calibration it was at 207, 207") +
              (continues ? "; continued: set back by hand" : ""));
  if (change == Change::muted)
    CHECK(events[0].value.find("\"Speaker Switch\" of the sound device is at off") != std::string::npos);
  if (!completes) CHECK(summary.reason.find("mixer: ") == 0);
  card.controls.clear();
}

TEST_CASE("the mixer's levels belong to a calibration", "[session][alsa][mixer]") {
  using Kind = LibraryCard::Control::Kind;
  const TemporaryFolder folder;
  use_plugin(folder);
  card.controls = {{Kind::level, "Digital Playback Volume", {207, 207}},
                   {Kind::toggle, "Auto Mute Switch", {0, 0}},
                   {Kind::choice, "Output", {1, 0}},
                   {Kind::level, "Mic", {10, 12}, false, 1},
                   {Kind::level, "Meter", {3, 4}, true}};
  auto rig = rig::load(TURNPOINT_SOURCE_DIR "/deploy/rigs/raspberry-pi-aluminium.toml");
  rig.output.uri = "alsa:looped";
  CHECK(audio::card_switch(rig.output.uri, "Auto Mute Switch") == false);
  CHECK_FALSE(audio::card_switch(rig.output.uri, "Headphone Switch"));
  CHECK_FALSE(audio::mixer_levels("alsa:absent"));
  CHECK_FALSE(audio::mixer_levels("sim:"));

  // What a calibration writes comes back from the file, and the rig then has it.
  rig::Calibration calibration;
  calibration.rig_name = rig.name, calibration.rig_sha256 = rig.sha256;
  calibration.made_on = rig::today();
  const auto path = folder / "calibration.toml";
  maintenance::write_calibration(calibration, rig, path);
  const auto made = rig::load_calibration(path);
  const std::map<std::string, std::string> levels{{"Digital Playback Volume", "207, 207"},
                                                  {"Auto Mute Switch", "off"},
                                                  {"Output", "Phones"},
                                                  {"Mic,1", "10, 12"}};
  CHECK(made.mixer == levels);
  const auto calibrated = rig::applied(made, rig);
  const auto check = [&] { return session::row_of(session::judged(session::read_mixer(calibrated))); };
  card.controls.back().values = {90, 90};  // a meter may move
  CHECK(check().verdict == core::Verdict::passed);
  CHECK(session::judged(session::read_mixer(rig)).verdict == core::Verdict::not_possible);

  SECTION("another card that captures counts, even if its mixer is equal") {
    CHECK(audio::card_of("alsa:plughw:CARD=X,DEV=1") == audio::card_of("alsa:hw:CARD=X,DEV=0"));
    auto two = rig;
    two.capture = rig::Capture{"alsa:another", 5, {1}, 0, 2, {}};
    const auto both = session::mixer_levels(two);
    CHECK(both.size() == 2 * levels.size());
    CHECK(both.at("capture: Mic,1") == "10, 12");
    two.capture->uri = "alsa:looped,1";
    CHECK(session::mixer_levels(two) == levels);
  }
  SECTION("a level that was changed is named with both values") {
    card.controls[0].values = {207, 180};
    CHECK(check().verdict == core::Verdict::failed);
    CHECK(check().what ==
          "the control \"Digital Playback Volume\" of the sound device is at 207, 180; during the "
          "calibration it was at 207, 207");
  }
  SECTION("a switch and a choice that were changed are named too") {
    card.controls[1].values = {1, 0}, card.controls[2].values = {0, 0};
    CHECK(check().what.find("\"Auto Mute Switch\" of the sound device is at on;") != std::string::npos);
    CHECK(check().what.find("\"Output\" of the sound device is at Line;") != std::string::npos);
  }
  SECTION("a control that is gone is named") {
    card.controls.erase(card.controls.begin());
    CHECK(check().what ==
          "the control \"Digital Playback Volume\" of the sound device cannot be read; during the "
          "calibration it was at 207, 207");
  }
  SECTION("a calibration is not continued with other levels") {
    maintenance::write_calibration(made, rig, path);
    card.controls[0].values = {1, 1};
    CHECK_THROWS_WITH(maintenance::write_calibration(made, rig, path),
                      Catch::Matchers::ContainsSubstring("Digital Playback Volume") &&
                          Catch::Matchers::ContainsSubstring("set it back"));
    CHECK(rig::load_calibration(path).mixer == levels);
    // A new calibration takes the new levels.
    maintenance::write_calibration(calibration, rig, path);
    CHECK(rig::load_calibration(path).mixer.at("Digital Playback Volume") == "1, 1");
  }
  card.controls.clear();
}
