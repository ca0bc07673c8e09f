#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "station/maintenance/force_weights.hpp"
#include "station/rig/apply.hpp"
#include "station/rig/calibration.hpp"
#include "station/session/cell_feed.hpp"
#include "tests/session/card_session.hpp"
#include "tests/support/catch.hpp"

// Force cells on a converter with a clock of its own: calibrated with dead weights, then used by a live
// session on the simulated sound card. The converter is invented here; tests/bench reads one of the kernel.

using namespace turnpoint;
using namespace turnpoint::card_session;
using maintenance::WeightStep;

namespace {

constexpr std::int64_t converter_step_ns = 1'000'000;
constexpr double converter_length_mm = 300;

struct Load {
  double normal_N = 0, lateral_N = 0, position_mm = 0;
};

/// What the cells read under a load, in an invented unit. The last digits change from sample to sample.
std::array<double, 3> converter_readings(const Load& load, std::int64_t time_ns) {
  constexpr double per_N = 2.5, height_mm = 8;
  const double turn_N = load.lateral_N * height_mm / converter_length_mm;
  const double share = load.position_mm / converter_length_mm;
  const double noise = 1e-12 * static_cast<double>(time_ns / converter_step_ns * 7919 % 13);
  return {0.4 + per_N * (load.normal_N * (1 - share) - turn_N) + noise,
          0.3 + per_N * (load.normal_N * share + turn_N) + noise, -0.2 + per_N * load.lateral_N + noise};
}

rig::CellConverter converter_in_rig() { return {"iio:cells", {"voltage0", "voltage1", "voltage2"}}; }

/// Sends samples as fast as they are read.
struct WeighedConverter : io::Converter {
  const Load& load;
  std::int64_t time_ns = system::monotonic_ns();
  int until_gap = -1;  ///< number of samples until five are left out
  bool wire_off = false, dead = false;
  std::int64_t step_ns = converter_step_ns;

  explicit WeighedConverter(const Load& weights) : load(weights) {}
  std::vector<io::Sample> read() override {
    std::vector<io::Sample> samples;
    for (int k = 0; k < 20; ++k) {
      time_ns += step_ns * (until_gap-- == 0 ? 6 : 1);
      samples.push_back({time_ns, converter_readings(load, dead ? 0 : time_ns), {false, wire_off, false}});
    }
    return samples;
  }
};

struct WeighedRoom {
  Load load;
  WeighedConverter* converter = nullptr;
  std::unique_ptr<maintenance::BridgeReader> bridges;

  WeighedRoom() {
    bridges = maintenance::converter_bridges(converter_in_rig(), [this](const io::Config& config) {
      CHECK(config.device == "cells");
      auto opened = std::make_unique<WeighedConverter>(load);
      converter = opened.get();
      return opened;
    });
  }
};

struct PutsWeights : maintenance::BridgeReader {
  WeighedRoom& room;
  explicit PutsWeights(WeighedRoom& weighed) : room(weighed) {}
  maintenance::BridgeReading read(const WeightStep& step) override {
    room.load = {9.81e-3 * step.mass_g, 9.81e-3 * step.pull_g, step.position_mm};
    return room.bridges->read(step);
  }
};

/// A finger that strokes to and fro from the time `touched_ns` on, at the card's time.
struct Stroking {
  static constexpr double turn = std::numbers::pi, reach_mm = 50, friction = 0.6;
  std::atomic<std::int64_t> touched_ns{-1};

  Load at(std::int64_t time_ns) const {
    const auto since_ns = touched_ns.load();
    if (since_ns < 0 || time_ns < since_ns) return {};
    const double s = 1e-9 * static_cast<double>(time_ns - since_ns);
    const double normal_N = 0.5 * std::min(1.0, s / 0.05);
    return {normal_N, friction * normal_N * std::tanh(turn * reach_mm * std::cos(turn * s) / 5),
            0.5 * converter_length_mm + reach_mm * std::sin(turn * s)};
  }
};

/// What the test and the converter's thread share.
struct Board {
  Stroking finger;
  std::atomic<std::int64_t> now_ns{0};   ///< the card's time
  std::atomic<std::int64_t> sent_ns{0};  ///< stamp of the newest sample
  std::atomic<int> leave_out{0};         ///< leave out so many of the next samples
  std::atomic<bool> gone{false};
  std::atomic<int> opened{0};

  /// Waits for the converter's thread, which runs in real time while the card's time runs faster.
  void follow() {
    now_ns = system::monotonic_ns();
    while (!gone && opened > 0 && now_ns - sent_ns > 40 * converter_step_ns) std::this_thread::yield();
  }
};

struct BoardConverter : io::Converter {
  Board& board;
  std::int64_t next_ns;
  explicit BoardConverter(Board& shared) : board(shared), next_ns(board.now_ns) {
    board.sent_ns = next_ns;
    ++board.opened;
  }

  std::vector<io::Sample> read() override {
    if (board.gone) throw std::system_error(ENODEV, std::generic_category(), "iio:cells: reading");
    std::vector<io::Sample> samples;
    for (; next_ns + 20 * converter_step_ns <= board.now_ns;) {
      next_ns += converter_step_ns * (1 + board.leave_out.exchange(0));
      samples.push_back({next_ns, converter_readings(board.finger.at(next_ns), next_ns), {}});
    }
    if (samples.empty())
      std::this_thread::yield();
    else
      board.sent_ns = next_ns;
    return samples;
  }
};

rig::ForceCells weighed_cells(const rig::Rig& rig) {
  WeighedRoom room;
  PutsWeights reader(room);
  const auto made = maintenance::weigh(
      rig, reader, [](auto&) { return true; }, [](auto&) { return false; });
  for (const auto& rest : made.residuals) CHECK(std::abs(rest.normal_N) < 1e-9);
  CHECK(made.cells.carrier_Hz == 0);
  CHECK(made.cells.rated_ratio[0] == Approx(2.5 * 10 * 0.9).epsilon(0.02));
  return made.cells;
}

}  // namespace

TEST_CASE("force cells on a converter with its own clock are weighed, and a live session measures the finger",
          "[card][forces][converter]") {
  CardSession card;
  Board board;
  card.add_capture(12'345);
  board.now_ns = system::monotonic_ns();
  auto& rig = card.setup.rig;
  rig.surface.length_m = 1e-3 * converter_length_mm;
  rig.capture->converter = converter_in_rig();
  rig.capture->forces = weighed_cells(rig);
  card.open_cells = [&board](const io::Config&) -> std::unique_ptr<io::Converter> {
    if (board.gone) throw std::runtime_error("iio:cells: there is no such device; there are: none");
    return std::make_unique<BoardConverter>(board);
  };
  card.stepped = [&board] { board.follow(); };
  card.first_answered = false;  // the first stimulus then lasts to its deadline
  std::function<void()> during_first = [] {};
  card.reacts = [&](const session::Page& page) {
    board.finger.touched_ns = -1;
    if (page.kind == PageKind::fault && page.fault.kind == FaultKind::capture) {
      const int before = board.opened;
      board.gone = false;
      while (board.opened == before) std::this_thread::yield();
    }
    if (page.kind != PageKind::stimulus) return;
    card.later(0.1, [&] { board.finger.touched_ns = system::monotonic_ns(); });
    if (card.room.stimuli == 1) card.later(1.0, [&] { during_first(); });
  };
  const auto notices = [&] { return live_room::events_of(card.setup.database, card.summary, "notice"); };

  SECTION("forces, speed and friction are those of the finger") {
    const auto trials = card.runs();
    const auto& finger = trials.front().finger;
    REQUIRE(finger.sensing == "ok");
    CHECK(finger.normal_N.value() == Approx(0.5).epsilon(0.01));
    CHECK(finger.mu.value() == Approx(Stroking::friction).epsilon(0.02));
    CHECK(finger.speed_mm_s.value() > 80);
    CHECK(finger.speed_mm_s.value() < Stroking::turn * Stroking::reach_mm);
    CHECK(trials.front().surface.proof == core::Proof::ok);
    CHECK(notices().empty());
  }
  SECTION("five lost samples make the forces of their trial unknown, and are in the log") {
    during_first = [&] { board.leave_out = 5; };
    const auto trials = card.runs();
    CHECK(trials.front().finger.sensing == "lost");
    CHECK_FALSE(trials.front().finger.normal_N);
    CHECK(trials.front().surface.proof == core::Proof::ok);
    CHECK(trials.back().finger.sensing == "ok");
    REQUIRE(notices().size() == 1);
    CHECK(notices()[0].value.find("lost 5 samples in 1 gaps; 0 time stamps") != std::string::npos);
  }
  SECTION("a converter that is disconnected stops the session until it is back") {
    during_first = [&] { board.gone = true; };
    const auto trials = card.runs();
    CHECK(trials.front().finger.sensing == "lost");
    REQUIRE(std::count(card.faults.begin(), card.faults.end(), FaultKind::capture) == 1);
    CHECK(card.details.back().find("iio:cells: ") == 0);
    CHECK(trials.back().finger.sensing == "ok");
    const auto told = notices();
    // On a slow machine, the station also tries to open the converter while it is gone, and tells this once.
    REQUIRE((told.size() == 3 || told.size() == 4));
    CHECK(told[0].value.find("iio:cells: reading: No such device") != std::string::npos);
    if (told.size() == 4)
      CHECK(told[1].value.find("iio:cells: there is no such device") != std::string::npos);
    CHECK(told[told.size() - 2].value == "the force cells are read again");
    CHECK(told.back().value.find("samples in 1 gaps") != std::string::npos);
  }
}

TEST_CASE("the calibration of cells on a converter names a wire that is off and lost samples",
          "[card][forces][converter]") {
  WeighedRoom room;
  PutsWeights reader(room);
  const WeightStep weight{false, 100, 150, 0}, empty{true, 0, 0, 0};
  const auto zero = reader.read(empty);
  CHECK(zero.reference == 0);
  CHECK(zero.ratio[0] == Approx(0.4));
  CHECK(reader.read(weight).ratio[1] - zero.ratio[1] == Approx(2.5 * 0.981 / 2));
  SECTION("a wire") {
    room.converter->wire_off = true;
    CHECK_THROWS_WITH(reader.read(weight),
                      "cell b on captured channel voltage1: a wire is off, or the cell is overloaded");
  }
  SECTION("samples without any noise") {
    room.converter->dead = true;
    CHECK_THROWS_WITH(reader.read(weight),
                      Catch::Matchers::ContainsSubstring(
                          "cell a on captured channel voltage0: the samples do not change at all"));
  }
  SECTION("lost samples, which do not matter for the next reading") {
    room.converter->until_gap = 100;
    CHECK_THROWS_WITH(reader.read(weight), "iio:cells: 5 samples were lost");
    CHECK_NOTHROW(reader.read(weight));
  }
  SECTION("another rate") {
    room.converter->step_ns = 1'100'000;
    CHECK_THROWS_WITH(reader.read(weight),
                      "iio:cells sends 909.1 samples a second, and rate_Hz in [force_cells] is 1000");
    CHECK_FALSE(session::wrong_rate("cells", 1000, 1010));
  }
}

TEST_CASE(
    "a calibration of cells on a converter is written and read, and does not fit cells that a card captures",
    "[card][forces][converter]") {
  const TemporaryFolder folder;
  CardSession card;
  card.add_capture(37);
  auto& rig = card.setup.rig;
  rig.surface.length_m = 1e-3 * converter_length_mm;
  rig.capture->converter = converter_in_rig();
  const auto made = weighed_cells(rig);
  const auto read = rig::load_calibration(maintenance::write_forces(rig, made, folder / "made.toml"));
  const auto used = rig::applied(read, rig);
  CHECK(used.capture.value().forces.value().matrix == made.matrix);
  CHECK(used.capture->forces->changes == made.changes);
  CHECK(used.capture->forces->rated_ratio == made.rated_ratio);
  CHECK(used.capture->forces->carrier_Hz == 0);
  auto captured = rig;
  captured.capture->converter.reset();
  captured.capture->bridges = {2, 3, 4};
  CHECK_THROWS_WITH(
      rig::applied(read, captured),
      "the force cells of the calibration were on a converter with a clock of its own, those of the "
      "rig are captured by the card; calibrate them again");
  auto with_carrier = read;
  with_carrier.forces->carrier_Hz = 10'525;
  with_carrier.forces->reference_amplitude = 0.4;
  CHECK_THROWS_WITH(rig::applied(with_carrier, rig),
                    "the force cells of the calibration were captured by the card, those of the rig are on a "
                    "converter with a clock of its own; calibrate them again");
}
