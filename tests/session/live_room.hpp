// What tests of live sessions in real time need: people in the room, a protocol, and simulated GPIO lines.
#pragma once
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "station/system/clocks.hpp"
#include "tests/support/shared_lines.hpp"

namespace turnpoint::live_room {

namespace input = session::input;
using session::PageKind;

inline std::string protocol_text(const std::string& device) {
  return R"(format = "friction-protocol/1"
[protocol]
id = "live"
version = "1.0.0"
title = "Two quick trials"
languages = ["en"]
[random]
seed = 7
[[factor]]
name = "offset_mm"
range = [-24.0, 24.0]
[scene.edge]
boundary_mm = "160 + offset_mm"
edge = "p50"
displacement_um = 1.0
ramp_ms = 20
tolerance = { boundary_mm = 0.5 }
[task]
kind = "single-interval"
intervals = ["edge"]
device = ")" +
         device +
         R"("
question = { en = "Left or right?" }
choices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]
correct = { left = "offset_mm < 0", right = "offset_mm > 0" }
[timing]
response_zero = "go_cue"
explore_s = 2.0
deadline_s = 3.0
iti_s = { uniform = [0.1, 0.2] }
anticipation_s = 0.0
[[procedure]]
name = "levels"
kind = "constant-stimuli"
level = "offset_mm"
values = [-20.0, 20.0]
repeats = 1
[[block]]
name = "main"
procedures = ["levels"]
)";
}

/// Simulates the participant and the operator. The session's thread calls show() with each page; `reacts` may
/// then push inputs and change lines.
struct Room : session::Display {
  session::Inputs inputs;
  std::shared_ptr<io::SimulatedLines> lines = std::make_shared<io::SimulatedLines>(SharedLines::count);
  std::vector<session::Page> pages;
  std::function<void(const session::Page&)> reacts;
  int stimuli = 0;

  /// `after_ns` is the time of the input, counted from now.
  void push(input::Any content, std::int64_t after_ns = 0) {
    inputs.push({system::monotonic_ns() + after_ns, std::move(content)});
  }
  void press(int button) { push(input::Button{button}); }

  void show(const session::Page& page) override {
    pages.push_back(page);
    if (page.kind == PageKind::stimulus) ++stimuli;
    reacts(page);
  }

  /// Reacts like a cooperative participant, and like an operator who clears every fault.
  void cooperate(const session::Page& page) {
    if (page.kind == PageKind::instructions || page.kind == PageKind::paused) push(input::Next{});
    if (page.kind == PageKind::stimulus) press(0);
    if (page.kind == PageKind::fault) push(page.amplifier.empty() ? input::Any(input::Next{}) : input::Arm{});
  }

  session::Devices devices() {
    session::Devices devices;
    devices.amplifier = guarded(lines);
    devices.buttons =
        io::open_buttons(io::ButtonsConfig{}, io::ContactConfig{}, session::handlers_for(inputs));
    return devices;
  }

  std::vector<io::SimulatedLines::Driven> enables() const {
    auto driven = lines->driven();
    std::erase_if(driven, [](const auto& change) { return change.line != SharedLines::enable; });
    return driven;
  }
  int heartbeats() const {
    const auto driven = lines->driven();
    return static_cast<int>(std::count_if(driven.begin(), driven.end(),
                                          [](const auto& c) { return c.line == SharedLines::heartbeat; }));
  }
};

/// Says whether a machine that is too busy causes this fault by itself: it left one of the station's threads
/// without processor time for 0.1 s or more.
inline bool machine_was_busy(core::FaultKind kind) {
  using core::FaultKind;
  return kind == FaultKind::audio_silent || kind == FaultKind::session_silent ||
         kind == FaultKind::stimulus_missed;
}

inline session::Setup live_setup(const std::string& database, const std::string& device = "buttons") {
  session::Setup setup;
  setup.rig = rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
  setup.protocol = protocol::parse(protocol_text(device), "live.toml");
  setup.participant = "P01";
  setup.database = database;
  setup.run_mode = core::RunMode::live;
  setup.language = "en";
  return setup;
}

inline std::vector<core::EventRow> events_of(const std::string& database, const session::Summary& summary,
                                             const std::string& kind) {
  auto events = store::read_session(database, summary.session_id).events;
  std::erase_if(events, [&](const auto& event) { return event.kind != kind; });
  return events;
}

inline std::vector<core::TrialRow> trials_of(const std::string& database, const session::Summary& summary) {
  std::vector<core::TrialRow> all;
  for (const auto& block : store::read_session(database, summary.session_id).blocks)
    all.insert(all.end(), block.trials.begin(), block.trials.end());
  return all;
}

}  // namespace turnpoint::live_room
