#include <array>
#include <cmath>
#include <set>

#include "station/session/guidance.hpp"
#include "station/store/open.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/stored_signals.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

// Tests that the bars that guide the finger show nothing that gives the answer away.

using namespace turnpoint;
using namespace measured;

namespace {

/// What somebody would see who looked only at the bars: for each trial and interval, the mean of each bar.
struct Watcher : session::Display {
  struct Seen {
    std::array<double, 2> force{}, speed{};
    std::array<int, 2> looks{};
  };
  std::vector<Seen> trials;
  std::set<std::optional<double>> paces;  ///< what the pacer showed
  session::Page page;
  int moved_in_stimulus = 0, moved = 0;

  void show(const session::Page& shown) override {
    if (shown.kind == session::PageKind::cue) trials.emplace_back();
    page = shown;
    if (page.guidance) look(*page.guidance);
  }
  void guide(const session::Guidance& guidance) override {
    ++moved;
    moved_in_stimulus += page.kind == session::PageKind::stimulus ? 1 : 0;
    look(guidance);
  }
  void look(const session::Guidance& guidance) {
    paces.insert(guidance.pace_mm_s);
    if (trials.empty() || !guidance.force || !guidance.force->value) return;
    // What the bars show in the pause counts as part of the first interval; what they show after the second
    // interval counts as part of the second.
    const bool second = page.interval.number == 2;
    if (page.kind == session::PageKind::cue || page.kind == session::PageKind::interval) return;
    auto& seen = trials.back();
    seen.force[second] += *guidance.force->value;
    seen.speed[second] += guidance.speed->value.value_or(0);
    ++seen.looks[second];
  }
};

std::string two_intervals(const TemporaryFolder& folder, const std::string& guidance) {
  const auto path = folder / "guided.toml";
  std::ofstream(path) << R"(format = "friction-protocol/1"
[protocol]
id = "guided"
version = "1.0.0"
title = "Guided"
languages = ["en"]
[[factor]]
name = "contrast_dB"
range = [-30.0, -3.0]
[scene.reference]
boundary_mm = 185.0
edge = "p50"
zone = { from_mm = 60.0, friction = 0.8, tones = 3 }
[scene.comparison]
base = "reference"
friction_contrast_dB = "contrast_dB"
[task]
kind = "2ifc"
intervals = ["reference", "comparison"]
duration_s = 2.0
gap_s = 0.5
device = "touch"
question = { en = "Which was smoother?" }
choices = [ { id = "1", label = { en = "1st" } }, { id = "2", label = { en = "2nd" } } ]
correct = "comparison"
[sensing]
normal_N = [0.3, 0.8]
speed_mm_s = [30, 200]
strokes = 1
guidance = true
)" << guidance << R"(
[timing]
response_zero = "interval_off"
deadline_s = 3.0
iti_s = 0.5
[[procedure]]
name = "levels"
kind = "constant-stimuli"
level = "contrast_dB"
values = [-6.0]
repeats = 40
[[block]]
name = "main"
procedures = ["levels"]
)";
  return path;
}

struct Session {
  Watcher watcher;
  std::vector<bool> second_is_right;
  /// mean friction in each interval, from the stored signal
  std::vector<std::array<double, 2>> friction;
};

/// Returns |lateral| / normal for both intervals of a signal with 1000 points per second, which ends at the
/// end of the second interval.
std::array<double, 2> friction_of(const std::vector<double>& normal, const std::vector<double>& lateral) {
  std::array<double, 2> friction{};
  const std::array<std::size_t, 2> before_end{4500, 2000};
  for (std::size_t i = 0; i < 2; ++i) {
    double lateral_sum = 0, normal_sum = 0;
    for (auto k = normal.size() - before_end[i]; k < normal.size() - before_end[i] + 2000; ++k)
      if (normal[k] > 0.1) lateral_sum += std::abs(lateral[k]), normal_sum += normal[k];
    friction[i] = lateral_sum / normal_sum;
  }
  return friction;
}

void run_guided(Session& made, const std::string& guidance) {
  TemporaryFolder folder;
  const auto request = request_in(folder, two_intervals(folder, guidance));
  const auto setup = session::prepare(request);
  session::Inputs inputs;
  const auto summary = session::run(setup, &made.watcher, inputs,
                                    std::make_unique<session::SimulatedRoom>(setup.rig), nullptr);
  auto database = store::open_reader(request.database);
  store::SignalReader signals(database, summary.session_id, "finger");
  while (const auto signal = signals.next()) {
    const auto values = store::decode(signal->row);
    made.friction.push_back(friction_of(values[0], values[1]));
  }
  const auto stored = store::read_session(request.database, summary.session_id);
  for (const auto& trial : stored.blocks.at(0).trials)
    made.second_is_right.push_back(trial.correct_response == "2");
}

/// Returns the proportion of right answers of somebody who always chooses the interval with the smaller
/// number, or, if that is better, always the other interval.
template <class Number>
double best_share(const Session& made, const Number& number) {
  double right = 0;
  const auto n = static_cast<double>(made.second_is_right.size());
  for (std::size_t i = 0; i < made.second_is_right.size(); ++i) {
    const auto [first, second] = number(i);
    right += (second < first) == made.second_is_right[i] ? 1 : 0;
  }
  return std::max(right, n - right) / n;
}

/// In fewer than 1 of 100 sessions of 40 answers, an observer who guesses gets more than this share right, or
/// more than this share wrong.
constexpr double kChance = 0.71;

}  // namespace

TEST_CASE("an observer who sees only the bars stays at chance; one who sees friction does not",
          "[session][guidance]") {
  const auto live = GENERATE(false, true);
  Session made;
  run_guided(made, live ? "live_guidance = true" : "");
  REQUIRE(made.second_is_right.size() == 40);
  REQUIRE(made.watcher.trials.size() == 40);
  REQUIRE(made.friction.size() == 40);
  CHECK(made.watcher.moved > 200);
  CHECK((made.watcher.moved_in_stimulus > 0) == live);
  // The pacer shows the same speed throughout the session, so it tells nothing about any trial.
  CHECK(made.watcher.paces == std::set<std::optional<double>>{115.0});
  const auto mean = [&](auto member) {
    return [&made, member](std::size_t i) {
      const auto& seen = made.watcher.trials[i];
      const auto of = [&](std::size_t k) { return (seen.*member)[k] / std::max(1, seen.looks[k]); };
      return std::pair(of(0), of(1));
    };
  };
  CHECK(best_share(made, mean(&Watcher::Seen::force)) <= kChance);
  CHECK(best_share(made, mean(&Watcher::Seen::speed)) <= kChance);
  // Negative control: deciding by friction in the same way is nearly always right, so bars that showed
  // friction would have given the answer away.
  CHECK(best_share(made, [&](std::size_t i) { return std::pair(made.friction[i][0], made.friction[i][1]); }) >
        0.9);
}

TEST_CASE(
    "the bars show force and speed relative to the ranges of the protocol, and nothing during a stimulus",
    "[session][guidance]") {
  protocol::Sensing sensing;
  sensing.normal_N = std::pair(0.4, 0.8);
  sensing.guidance = true;
  session::Guide guide(sensing);
  REQUIRE(guide.bars());
  CHECK_FALSE(guide.bars()->pace_mm_s);
  CHECK_FALSE(guide.bars()->speed);  // there is no bar for the speed, because the protocol accepts any speed
  CHECK(guide.bars()->force->low == Approx(1.0 / 3));
  CHECK(guide.bars()->force->high == Approx(2.0 / 3));
  CHECK_FALSE(guide.bars()->force->value);
  CHECK(guide.move(sensing::FingerNow{0.6, 80, true}));
  CHECK(guide.bars()->force->value.value() == Approx(0.5));
  // a change of 0.001 N is too small to be seen, so the bar does not move
  CHECK_FALSE(guide.move(sensing::FingerNow{0.601, 300, true}));
  CHECK(guide.freeze(true));
  CHECK_FALSE(guide.move(sensing::FingerNow{1.1, 80, true}));
  CHECK(guide.bars()->force->value.value() == Approx(0.5));
  CHECK(guide.freeze(false));
  CHECK(guide.move(sensing::FingerNow{5, 80, true}));
  CHECK(guide.bars()->force->value.value() == 1);
  CHECK(guide.move(sensing::FingerNow{0.01, 80, false}));
  CHECK_FALSE(guide.bars()->force->value);
  SECTION("without guidance there are no bars") {
    sensing.guidance = false;
    CHECK_FALSE(session::Guide(sensing).bars());
    CHECK_FALSE(session::Guide(std::nullopt).bars());
  }
  SECTION("the pacer shows the middle of the range of speeds") {
    sensing.speed_mm_s = std::pair(40.0, 120.0);
    CHECK(session::Guide(sensing).bars()->pace_mm_s.value() == Approx(80));
  }
  SECTION("live guidance moves during a stimulus") {
    sensing.live_guidance = true;
    session::Guide live(sensing);
    live.freeze(true);
    CHECK(live.move(sensing::FingerNow{0.6, 80, true}));
  }
}
