#include <array>
#include <cmath>

#include "station/maintenance/force_weights.hpp"
#include "station/session/stage.hpp"
#include "tests/session/card_session.hpp"
#include "tests/support/catch.hpp"

// Tests force cells on the simulated sound card: they are calibrated with dead weights and then used in a
// live session.

using namespace turnpoint;
using namespace turnpoint::card_session;
using maintenance::WeightStep;

namespace {

/// Simulated force cells: output channel 2 excites three bridges, and the captured channels 2 to 4 read them.
/// Channel 0 captures the excitation.
struct Cells {
  double normal_N = 0, lateral_N = 0, position_mm = 0;
  double length_mm = 300;
  bool wire_off = false;  ///< true if a wire of cell b is off

  void capture(std::int32_t excitation, std::span<std::int32_t> captured) const {
    constexpr double per_N = 0.05, zero = 0.01, height_mm = 8;
    const double turn_N = lateral_N * height_mm / length_mm;
    const double share = position_mm / length_mm;
    const std::array forces{normal_N * (1 - share) - turn_N, normal_N * share + turn_N, lateral_N};
    captured[0] = static_cast<std::int32_t>(std::lrint(0.8 * excitation));
    for (std::size_t k = 0; k < 3; ++k)
      captured[2 + k] = static_cast<std::int32_t>(std::lrint(0.8 * excitation * (zero + per_N * forces[k])));
    if (wire_off) captured[3] = captured[0];
  }
};

void add_cells(rig::Rig& rig) {
  rig.capture->channels = 5;
  rig.capture->bridges = {2, 3, 4};
}

/// Reads the force cells' bridges on the simulated sound card, whose time passes as fast as the computer
/// allows.
struct CardRoom {
  const bool holding = false;
  bool captures = true;
  SteppedCapture* capture = nullptr;
  std::unique_ptr<maintenance::BridgeReader> bridges;

  explicit CardRoom(const rig::Rig& rig) {
    maintenance::BridgeDevices devices;
    devices.pause = [] {};
    devices.stream = std::make_unique<SteppedStream>(session::session_stream(rig), holding, [this] {
      if (captures) capture->follow();
    });
    auto opened = std::make_unique<SteppedCapture>(session::card_capture_of(rig).value().device);
    opened->backlog_frames = 200'000;
    capture = opened.get();
    devices.capture = std::move(opened);
    bridges = maintenance::card_bridges(rig, std::move(devices));
  }
};

/// Puts the weights on the cells before the reader reads them.
struct WithWeights : maintenance::BridgeReader {
  maintenance::BridgeReader& bridges;
  Cells& cells;
  std::function<void(const WeightStep&)> before = [](auto&) {};
  WithWeights(maintenance::BridgeReader& reader, Cells& loaded) : bridges(reader), cells(loaded) {}
  maintenance::BridgeReading read(const WeightStep& step) override {
    cells.normal_N = 9.81e-3 * step.mass_g, cells.lateral_N = 9.81e-3 * step.pull_g;
    cells.position_mm = step.position_mm;
    before(step);
    return bridges.read(step);
  }
};

rig::ForceCells calibrated(const rig::Rig& rig, Cells& cells) {
  CardRoom room(rig);
  WithWeights reader(*room.bridges, cells);
  const auto made = maintenance::weigh(
      rig, reader, [](auto&) { return true; }, [](auto&) { return false; });
  for (const auto& rest : made.residuals) CHECK(std::abs(rest.normal_N) < 1e-4);
  CHECK(made.zero_moved_mN < 0.1);
  return made.cells;
}

}  // namespace

TEST_CASE("a card's force cells are calibrated with dead weights, and a live session measures the finger",
          "[card][forces]") {
  CardSession card;
  Cells cells;
  card.add_capture(12'345);
  add_cells(card.setup.rig);
  cells.length_mm = 1e3 * card.setup.rig.surface.length_m;
  double touched_s = -1;
  const auto now_s = [] { return static_cast<double>(fake_pcm().now) / kRate_Hz; };
  constexpr double turn = 2 * 3.14159265358979 / 2, reach_mm = 50, friction = 0.6;
  const auto wires = fake_pcm().wires;
  fake_pcm().wires = [&](std::span<const std::int32_t> played, std::span<std::int32_t> captured) {
    wires(played, captured);
    if (touched_s >= 0) {
      const double phase = turn * (now_s() - touched_s);
      const double speed_mm_s = turn * reach_mm * std::cos(phase);
      cells.normal_N = 0.5 * std::min(1.0, (now_s() - touched_s) / 0.05);
      cells.lateral_N = friction * cells.normal_N * std::tanh(speed_mm_s / 5);
      cells.position_mm = 0.5 * cells.length_mm + reach_mm * std::sin(phase);
    }
    cells.capture(played[2], captured);
  };
  const auto reset = [&] {
    const auto keep = fake_pcm().wires;
    audio::reset_fake_pcm();
    fake_pcm().loop_delay = 12'345;
    fake_pcm().wires = keep;
    cells.normal_N = cells.lateral_N = 0;
  };
  card.setup.rig.capture->forces = calibrated(card.setup.rig, cells);
  reset();
  card.first_answered = false;  // the first stimulus then lasts to its deadline
  int broken = -1;
  card.reacts = [&](const session::Page& page) {
    touched_s = -1, cells.normal_N = cells.lateral_N = 0;
    if (page.kind == PageKind::stimulus) card.later(0.1, [&] { touched_s = now_s(); });
    cells.wire_off = card.room.stimuli == broken;
  };
  SECTION("forces, speed and friction are those of the finger") {
    const auto trials = card.runs();
    const auto& finger = trials.front().finger;
    REQUIRE(finger.sensing == "ok");
    CHECK(finger.normal_N.value() == Approx(0.5).epsilon(0.01));
    CHECK(finger.mu.value() == Approx(friction).epsilon(0.02));
    CHECK(finger.speed_mm_s.value() > 80);
    CHECK(finger.speed_mm_s.value() < turn * reach_mm);
    CHECK(finger.strokes.value() >= 1);
    CHECK(trials.front().surface.proof == core::Proof::ok);
  }
  SECTION("a wire that comes off is known in its trial") {
    broken = 1;
    const auto trials = card.runs();
    CHECK(trials.front().finger.sensing != "ok");
    CHECK_FALSE(trials.front().finger.normal_N);
  }
  SECTION("without a calibration, no forces are stated") {
    card.setup.rig.capture->forces.reset();
    const auto trials = card.runs();
    CHECK(trials.front().finger.sensing.empty());
    CHECK_FALSE(trials.front().finger.normal_N);
  }
}

TEST_CASE("the card's bridges name a wire that is off, lost frames and a card that captures nothing",
          "[card][forces]") {
  CardSession card;
  Cells cells;
  card.add_capture(37);
  auto& rig = card.setup.rig;
  add_cells(rig);
  fake_pcm().wires = [&](std::span<const std::int32_t> played, std::span<std::int32_t> captured) {
    cells.capture(played[2], captured);
  };
  CardRoom room(rig);
  WithWeights reader(*room.bridges, cells);
  const WeightStep weight{false, 100, 150, 0}, empty{true, 0, 0, 0};
  const auto zero = reader.read(empty);
  CHECK(zero.reference == Approx(0.8 * session::kCarrier).epsilon(1e-3));
  CHECK(zero.ratio[0] == Approx(0.01).epsilon(1e-4));
  CHECK(reader.read(weight).ratio[1] - zero.ratio[1] == Approx(0.05 * 0.981 * 150 / cells.length_mm));
  SECTION("a wire") {
    cells.wire_off = true;
    CHECK_THROWS_WITH(reader.read(weight),
                      "cell b on captured channel 3: a wire is off, or the cell is overloaded");
  }
  SECTION("lost frames, which do not matter for the next reading") {
    reader.before = [](auto&) { fake_pcm().taken -= 5'000; };
    CHECK_THROWS_WITH(reader.read(weight), "alsa:fake: frames were lost");
    reader.before = [](auto&) {};
    CHECK_NOTHROW(reader.read(weight));
  }
  SECTION("no capture") {
    room.captures = false;
    CHECK_THROWS_WITH(reader.read(weight), "alsa:fake: the sound device captures nothing");
  }
}
