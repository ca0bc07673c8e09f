#pragma once
// Sessions on the simulated sound card of tests/audio, with the station's real stream and output. All
// times are on the card's clock.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <deque>
#include <stdexcept>
#include <thread>
#include <utility>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/device_stream.hpp"
#include "tests/audio/fake_pcm.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

namespace turnpoint::card_session {

using audio::fake_pcm;

struct Buffer {
  int period_frames, periods;
};

inline void use_card(rig::Rig& rig, const Buffer& buffer) {
  rig.output.uri = "alsa:fake";
  rig.output.period_frames = buffer.period_frames;
  rig.output.periods = buffer.periods;
  rig.marker = rig::Marker{};
}

using core::FaultKind;
namespace input = session::input;
using session::PageKind;

constexpr std::int64_t kRate_Hz = 192000;

/// A real stream that advances each time the session polls it. The session then takes as long as the card
/// plays.
struct SteppedStream : audio::DeviceStream {
  SteppedStream(const audio::StreamConfig& config, const bool& holds, const std::function<void()>& then)
      : DeviceStream(config), holding(holds), after_step(then) {}

  std::optional<audio::Event> poll() override {
    step();
    after_step();
    if (fake_pcm().now > 300 * kRate_Hz)
      throw std::runtime_error("the session did not end within 300 s of the card's time");
    auto event = DeviceStream::poll();
    if (event && event->kind == audio::EventKind::burst_heard) {
      held.push_back(*event);
      event.reset();
    }
    if (event || holding || held.empty()) return event;
    event = held.front();
    held.pop_front();
    return event;
  }

  const bool& holding;  ///< while true, the stream delays its reports of what was played
  const std::function<void()> after_step;
  std::deque<audio::Event> held;
};

/// A real capture that is read whenever the stream has advanced. It waits for the station's sensing thread,
/// which runs in real time while the card's time runs faster.
struct SteppedCapture : audio::DeviceCapture {
  using DeviceCapture::DeviceCapture;

  void follow() {
    const auto& card = fake_pcm();
    if (card.capture_state != audio::FakePcm::State::running || card.captured - card.taken >= card.period) {
      step();
      const auto now = counters();
      put = now.frames - now.lost_frames;
    }
    while (put - got > backlog_frames) std::this_thread::yield();
  }
  const audio::CapturedBlock* take() noexcept override {
    const auto* block = DeviceCapture::take();
    if (block != nullptr) got = block->first_frame + block->count / fake_pcm().capture_channels;
    return block;
  }

  std::int64_t backlog_frames = 20'000;  ///< most frames that may wait for the sensing thread
  std::int64_t put = 0;
  std::atomic<std::int64_t> got{0};
};

/// An amplifier that follows the guard's rules on the card's clock. It has no thread of its own.
struct RuledAmplifier : audio::Amplifier {
  using Answer = std::optional<io::Guard::Refusal>;
  static Refusal refusal(const Answer& why) {
    return why ? Refusal(core::Fault{why->kind, ""}) : std::nullopt;
  }
  Refusal arm() override { return refusal(guard.arm(system::monotonic_ns())); }
  void disarm() noexcept override { guard.disarm(); }
  Refusal enable() override { return refusal(guard.enable(system::monotonic_ns())); }
  void disable() noexcept override { guard.disable(); }
  void trip(FaultKind kind, std::string_view why) noexcept override {
    guard.trip(system::monotonic_ns(), kind);
    detail = why;
  }
  Refusal clear() override { return refusal(guard.clear()); }
  void audio_alive() noexcept override { guard.audio_alive(system::monotonic_ns()); }
  void session_alive() noexcept override { guard.session_alive(system::monotonic_ns()); }
  void page_alive(std::int64_t time_ns) noexcept override { guard.page_alive(time_ns); }
  audio::AmplifierState state() const noexcept override { return guard.state(); }
  audio::AmplifierFault fault() const override {
    return {{guard.fault().kind, detail}, guard.fault().time_ns};
  }
  std::int64_t reaction_ns() const noexcept override { return -1; }
  io::Guard guard;
  std::string detail;  ///< of the last call of trip()
};

/// Runs a live session of two trials on the card. The participant answers 0.3 s after an onset.
struct CardSession {
  TemporaryFolder folder;
  session::Setup setup = live_room::live_setup(folder / "a.sqlite", "touch");
  live_room::Room room;
  bool holding = false;
  bool first_answered = true;  ///< whether the participant answers the first stimulus
  double repair_s = 0;         ///< time that the operator takes before clearing a fault
  double reading_s = 0;        ///< time for which other pages than a stimulus are read
  std::vector<std::pair<std::int64_t, std::function<void()>>> agenda;
  std::function<void(const session::Page&)> reacts = [](const auto&) {};
  std::function<void()> stepped = [] {};  ///< called whenever the card's time has advanced
  /// opens the converter of force cells that the card does not capture
  std::function<std::unique_ptr<io::Converter>(const io::Config&)> open_cells = io::open;
  std::vector<FaultKind> faults;
  std::vector<std::string> details;
  session::Summary summary;

  CardSession() {
    audio::reset_fake_pcm();
    use_card(setup.rig, {384, 4});
  }

  void later(double s, std::function<void()> happens) {
    agenda.emplace_back(system::monotonic_ns() + static_cast<std::int64_t>(1e9 * s), std::move(happens));
  }

  /// Adds a capture to the card. Its channel 0 is wired to output channel 2 of the playback. The pick-up on
  /// its channel 1 captures what output channel 0 plays, times `gain`.
  void add_capture(std::int64_t loop_delay, bool calibrated = true) {
    setup.rig.capture = rig::Capture{"alsa:fake", 2, {1}, 0, 2, {}};
    if (calibrated)
      setup.rig.capture->responses = {{1, 0, {{1'000, 0.5, 0}, {40'000, 0.5, 0}, {80'000, 0.5, 0}}}};
    fake_pcm().loop_delay = loop_delay;
    fake_pcm().wires = [this](std::span<const std::int32_t> played, std::span<std::int32_t> captured) {
      captured[0] = wired ? played[2] : 0;
      captured[1] = static_cast<std::int32_t>(std::lrint(gain * played[0]));
    };
  }
  double gain = 0.5;
  bool wired = true;
  SteppedCapture* capture = nullptr;
  const RuledAmplifier* amplifier = nullptr;

  std::vector<core::TrialRow> runs() {
    session::Devices devices;
    auto ruled = std::make_unique<RuledAmplifier>();
    amplifier = ruled.get();
    devices.amplifier = std::move(ruled);
    devices.clocks = [] {
      const auto now_ns = system::monotonic_ns();
      return system::Clocks{now_ns, now_ns, now_ns};
    };
    devices.open_capture = [this](const audio::OutputConfig& config) {
      auto opened = std::make_unique<SteppedCapture>(config);
      capture = opened.get();
      return opened;
    };
    devices.open_cells = open_cells;
    devices.open_stream = [this](const audio::StreamConfig& config) {
      return std::make_unique<SteppedStream>(config, holding, [this] {
        if (capture != nullptr) capture->follow();
        stepped();
        const auto due = std::find_if(agenda.begin(), agenda.end(), [](const auto& entry) {
          return entry.first <= system::monotonic_ns();
        });
        if (due == agenda.end()) return;
        const auto happens = due->second;
        agenda.erase(due);
        happens();
      });
    };
    room.reacts = [this](const session::Page& page) {
      reacts(page);
      if (page.kind == PageKind::fault)
        faults.push_back(page.fault.kind), details.push_back(page.fault.detail);
      if (page.kind == PageKind::stimulus && (first_answered || room.stimuli > 1))
        later(0.3, [this] { room.push(input::Answer{}); });
      if (page.kind == PageKind::fault) return later(repair_s, [this, page] { room.cooperate(page); });
      if (page.kind == PageKind::stimulus) return;
      if (reading_s <= 0) return room.cooperate(page);
      later(reading_s, [this, page] { room.cooperate(page); });
    };
    summary = session::run(setup, &room, room.inputs, std::move(devices));
    CHECK(summary.status == core::SessionStatus::completed);
    return live_room::trials_of(setup.database, summary);
  }
};

}  // namespace turnpoint::card_session
