#include <cmath>
#include <memory>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/physical.hpp"
#include "station/scene/planner.hpp"
#include "station/session/burst.hpp"
#include "station/session/programs.hpp"
#include "station/session/rows.hpp"
#include "station/session/stage.hpp"
#include "station/store/signal_code.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

// A stage on the virtual clock with the simulated laboratory (station/simulation): its finger strokes the
// surface, its cells are captured, and the stage makes the gain follow it.

using namespace turnpoint;

namespace {

rig::Rig rig_of(const TemporaryFolder& folder) {
  auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  rig.output.period_frames = 96;
  rig.output.periods = 2;
  return rig;
}

/// Stiff cells and a steady, light finger, which strokes from the first moment on and does not load the
/// surface.
void quick(simulation::Setup& room) {
  room.finger.impedance_Ns_per_m = 0;
  room.cells.normal_Hz = room.cells.lateral_Hz = 400;
  room.cells.damping = 0.15;
  room.finger.normal_noise = room.finger.friction_noise = 0;
  room.finger.pause_s = 0.01;
  room.finger.from_m = 0.04, room.finger.to_m = 0.15, room.finger.stroke_s = 1.2;
}

struct Lab {
  explicit Lab(const std::function<void(simulation::Setup&)>& change = {})
      : rig(rig_of(folder)),
        programs("protocol.toml"),
        participant(programs.respondent("sim")),
        planner(rig) {
    auto made = std::make_unique<session::SimulatedRoom>(rig, [&](simulation::Setup& laboratory) {
      quick(laboratory);
      if (change) change(laboratory);
    });
    room = made.get();
    stage = session::virtual_stage(session::simulated_stream(rig), participant, inputs, std::move(made));
    // one tone whose boundary is far out, so that most of the strip is smooth at gain 1
    scene::Scene wanted;
    wanted.name = "texture";
    wanted.boundary_m = 0.19;
    wanted.displacement_m = 3e-6;
    drive = planner.plan(wanted);
    const auto profile = planner.profile(drive, 400);
    plan.map = follow::GainMap(profile.x_m, profile.displacement_m, {}, planner.friction(),
                               rig.friction.fingertip_m, 1);
    const auto& setup = room->plant().setup();
    plan.envelope.time_constant_s =
        1e-5;  // the simulated finger feels the drive edge, not the plate's ringing
    plan.timing.cells_s = 2 * setup.cells.damping / (2 * 3.14159265358979 * setup.cells.normal_Hz);
    plan.timing.converter_s = setup.loop_delay_frames / 192000;
    // the film, the window in which the simulation finds amplitudes, and its steps
    plan.timing.film_s = 1 / (2 * 3.14159265358979 * setup.finger.film_Hz) + 0.5e-3 + 0.125e-3;
    plan.ramp_s = 4e-3;
    plan.resting_friction = setup.finger.friction;
  }

  /// Presents `intervals` bursts of this plan, and runs until the last was heard.
  void run(double seconds, const std::function<void(double s)>& meanwhile = {}, int intervals = 1) {
    drive.follow = std::make_shared<const follow::Plan>(plan);
    std::vector<audio::PreparedBurst> bursts;
    for (int i = 0; i < intervals; ++i) {
      auto burst = session::burst_of({drive}, {}, {}, seconds, 192000);
      burst.start_frame = i * std::llround(192000 * (seconds + 0.2));
      const auto stream = session::simulated_stream(rig);
      bursts.push_back(audio::prepare(burst, audio::format_of(stream.output), stream.limits));
      follows.push_back(drive.follow);
    }
    REQUIRE_FALSE(stage->open_amplifier());
    stage->follow(follows, bursts);
    stage->drain();
    const auto onsets = stage->present(bursts, stage->now_ns() + 500'000'000);
    REQUIRE(onsets.size() == bursts.size());
    onset = {onsets.front().frame, 1e-9 * static_cast<double>(onsets.front().time_ns)};
    for (const auto& one : onsets) ranges.push_back({one.frame, one.frame + std::llround(192000 * seconds)});
    int heard = 0;
    for (std::int64_t t = stage->now_ns(); heard < intervals;) {
      auto input = stage->wait_until(t += 500'000);
      const double s = 1e-9 * static_cast<double>(stage->now_ns() - onsets.front().time_ns);
      if (meanwhile) meanwhile(s);
      if (!input) continue;
      if (const auto* one = input->as<session::input::Measured>()) measured.push_back(*one);
      heard += input->is<session::input::Heard>() ? 1 : 0;
    }
    followed = stage->followed();
  }

  TemporaryFolder folder;
  rig::Rig rig;
  session::Inputs inputs;
  session::Programs programs;
  session::SimulatedParticipant participant;
  scene::Planner planner;
  scene::DrivePlan drive;
  follow::Plan plan;
  session::SimulatedRoom* room = nullptr;
  std::unique_ptr<session::Stage> stage;
  session::FollowPlans follows;
  session::FrameTime onset;
  std::vector<session::FollowedRange> ranges;
  std::vector<session::input::Measured> measured;
  session::Followed followed;
};

void add_sine(follow::Plan& plan, double from, double to, double cycles_per_m) {
  follow::Part part;
  part.shape = follow::Shape::sine;
  part.from = from, part.to = to, part.cycles_per_m = cycles_per_m;
  add(plan.pattern, part);
}

}  // namespace

TEST_CASE(
    "on the virtual clock the surface follows the simulated finger, and the trial records and proves it",
    "[session][follow]") {
  Lab lab;
  add_sine(lab.plan, 0.35, 0.65, 50);                    // a period of 20 mm
  std::vector<std::pair<std::int64_t, double>> contact;  // captured frame and true place
  lab.run(1.5, [&](double) {
    contact.emplace_back(std::llround(192e-6 * static_cast<double>(lab.stage->now_ns())),
                         lab.room->plant().truth().finger.contact_m);
  });
  REQUIRE(lab.followed.periods.size() > 2900);
  CHECK(lab.followed.late.empty());
  CHECK(lab.followed.not_recorded == 0);
  // The place for which the gain was computed is where the finger was when the surface moved: a loop delay
  // after the frame was played.
  double squares = 0, count = 0;
  std::size_t k = 0;
  for (const auto& one : lab.followed.periods) {
    if (one.update.following < 1) continue;
    const auto at = one.frame + 48 + std::llround(lab.room->plant().setup().loop_delay_frames);
    while (k + 1 < contact.size() && contact[k].first < at) ++k;
    if (k + 1 >= contact.size()) break;
    squares += std::pow(one.update.place_m - contact[k].second, 2), count += 1;
  }
  REQUIRE(count > 2000);
  CAPTURE(1e3 * std::sqrt(squares / count));
  CHECK(std::sqrt(squares / count) < 1e-3);

  core::TrialRow row;
  add_followed(row, lab.followed, lab.follows, lab.ranges, 192000, lab.onset);
  CAPTURE(row.follow.followed, row.follow.mu_asked.value(), row.follow.mu_felt.value(),
          row.follow.mu_commanded.value(), row.follow.inside.value());
  CHECK(row.follow.followed == "ok");
  CHECK(row.follow.mu_asked.value() == Approx(0.5).margin(0.05));
  CHECK(row.follow.mu_felt.value() == Approx(row.follow.mu_asked.value()).epsilon(0.05));
  CHECK(row.follow.mu_commanded.value() == Approx(row.follow.mu_asked.value()).epsilon(0.05));
  CHECK(row.follow.inside.value() > 0.8);
  REQUIRE(row.follow.lag_ms);
  CHECK(std::abs(*row.follow.lag_ms) < 3);

  // the signals are the updates and gains, at their frames
  REQUIRE(row.signal_rows.size() == 2);
  const auto& updates = row.signal_rows[0];
  const auto& envelope = row.signal_rows[1];
  CHECK(updates.stream == core::kFollowStream);
  CHECK(envelope.stream == core::kEnvelopeStream);
  CHECK(envelope.rate_Hz == 16000);
  CHECK(updates.rate_Hz == 2000);
  const auto gains = store::decode(envelope).at(0);
  REQUIRE(gains.size() == 8 * lab.followed.periods.size());
  const auto& some = lab.followed.periods[1234];
  CHECK(envelope.start_frame == lab.followed.periods[0].frame + 12);
  for (std::size_t g = 0; g < 8; ++g)
    CHECK(gains[8 * 1234 + g] == Approx(static_cast<double>(some.update.gain[g])).margin(1e-5));
  CHECK(store::decode(updates).at(2)[1234] == Approx(some.update.asked).margin(1e-4));
  CHECK(updates.start_s ==
        Approx(lab.onset.time_s + static_cast<double>(updates.start_frame - lab.onset.frame) / 192000));

  // and pick-ups prove that the surface did it
  REQUIRE(lab.measured.size() == 1);
  const auto& result = *lab.measured[0].result;
  CAPTURE(result.envelope_error_dB.value(), result.ratio_dB, name(result.cause));
  CHECK(result.verdict == core::Proof::ok);
  CHECK(result.envelope_error_dB.value() < -25);
  CHECK(std::abs(result.envelope_lag_us.value()) < 100);
}

TEST_CASE("if nobody states the friction at rest, it is the one that agrees with what was felt",
          "[session][follow]") {
  Lab lab;
  const double resting = lab.plan.resting_friction;
  REQUIRE(resting != Approx(1).margin(0.1));
  lab.plan.resting_friction = 1, lab.plan.resting_known = false;
  add_sine(lab.plan, 0.35 / resting, 0.65 / resting, 50);
  lab.run(1.5);
  core::TrialRow row;
  add_followed(row, lab.followed, lab.follows, lab.ranges, 192000, lab.onset);
  CHECK(row.follow.mu_asked.value() == Approx(0.5).margin(0.05));
  CHECK(row.follow.mu_commanded.value() == Approx(row.follow.mu_felt.value()));
  CHECK(row.follow.inside.value() > 0.8);
  // the same trial, if 1 is taken for the truth
  lab.plan.resting_known = true;
  const std::vector taken{std::make_shared<const follow::Plan>(lab.plan)};
  core::TrialRow wrong;
  add_followed(wrong, lab.followed, taken, lab.ranges, 192000, lab.onset);
  CHECK(wrong.follow.inside.value() < 0.2);
}

TEST_CASE("what interrupts following is named in the trial", "[session][follow]") {
  Lab lab;
  add_sine(lab.plan, 0.35, 0.65, 50);
  std::string expected = "ok";
  std::function<void()> strikes = [] {};
  SECTION("the finger lifts") {
    expected = "lifted";
    strikes = [&] { lab.room->lift(0); };
  }
  SECTION("the excitation fails") {
    expected = "reference";
    strikes = [&] {
      lab.room->plant().add({simulation::FaultKind::no_reference, lab.room->plant().frames() + 1});
    };
  }
  SECTION("a bridge is open") {
    expected = "force";
    strikes = [&] {
      lab.room->plant().add({simulation::FaultKind::broken_bridge, lab.room->plant().frames() + 1});
    };
  }
  bool struck = false;
  lab.run(1.0, [&](double s) {
    if (s > 0.5 && !std::exchange(struck, true)) strikes();
  });
  core::TrialRow row;
  add_followed(row, lab.followed, lab.follows, lab.ranges, 192000, lab.onset);
  CAPTURE(row.follow.followed);
  // A finger that lifts is first too light to tell its place.
  if (expected == "ok")
    CHECK(row.follow.followed == "ok");
  else
    CHECK(row.follow.followed.find(expected) != std::string::npos);
  if (expected != "ok")
    for (const float gain : lab.followed.periods.back().update.gain) CHECK(gain == 0);
}

TEST_CASE("each interval of a trial follows its own plan", "[session][follow]") {
  Lab lab;
  add_sine(lab.plan, 0.35, 0.65, 50);
  lab.run(0.5, {}, 2);
  CHECK(lab.followed.periods.front().interval == 0);
  CHECK(lab.followed.periods.back().interval == 1);
  core::TrialRow row;
  add_followed(row, lab.followed, lab.follows, lab.ranges, 192000, lab.onset);
  const auto gains = store::decode(row.signal_rows.at(1)).at(0);
  // between the intervals nothing is commanded
  const auto middle =
      static_cast<std::size_t>((lab.ranges[0].end_frame + 9600 - row.signal_rows[1].start_frame) / 12);
  CHECK(std::isnan(gains.at(middle)));
  CHECK(lab.measured.size() == 2);
}

TEST_CASE("a plan's friction is what the simulated finger feels, which loads the surface",
          "[session][follow]") {
  const auto rig = rig::load(measured::kSource + "/deploy/rigs/simulated-following.toml");
  scene::Scene wanted;
  wanted.name = "even";
  scene::ToneTarget tone_wanted;
  tone_wanted.frequency_Hz = 29222, tone_wanted.displacement_m = 5e-6;
  wanted.tones.push_back(tone_wanted);
  scene::FollowTarget target;
  target.pattern.base = 1;
  wanted.follow = std::make_shared<const scene::FollowTarget>(target);
  scene::Planner planner(rig);
  const auto plan = planner.plan(wanted);
  const auto& map = plan.follow->map;
  double worst = 0, without = 0;
  for (const double gain : {0.2, 0.5, 1.0}) {
    // a finger that strokes slowly where the surface vibrates
    session::SimulatedRoom room(rig, [](simulation::Setup& laboratory) {
      laboratory.finger.normal_noise = laboratory.finger.friction_noise = 0;
      laboratory.finger.from_m = 0.03, laboratory.finger.to_m = 0.115, laboratory.finger.stroke_s = 1.5;
      laboratory.finger.pause_s = 0.1;
    });
    auto& plant = room.plant();
    const auto& tone = plan.tones.at(0);
    const auto stream = session::simulated_stream(rig);
    room.expect(std::vector{audio::prepare(session::burst_of({plan}, {}, {}, 1.5, 192000),
                                           audio::format_of(stream.output), stream.limits)});
    plant.touch(2 * 192000);
    const auto outputs = static_cast<std::size_t>(plant.setup().playback_channels);
    std::vector<double> played(192 * outputs),
        captured(192 * static_cast<std::size_t>(plant.setup().capture.count));
    for (std::int64_t frame = 0; frame < 192000 * 3 / 2; frame += 192) {
      for (std::int64_t k = 0; k < 192; ++k)
        played[static_cast<std::size_t>(k) * outputs +
               static_cast<std::size_t>(plant.setup().transducers[0].channel)] =
            1e6 * gain * tone.amplitude_m / plant.setup().transducers[0].um_per_full_scale *
            std::sin(2 * M_PI * std::fmod(tone.frequency_Hz / 192000 * static_cast<double>(frame + k), 1.0));
      plant.advance(played, captured);
      if (frame < 19200) continue;
      const auto& finger = plant.truth().finger;
      worst =
          std::max(worst, std::abs(finger.relative_friction - map.relative_friction(finger.contact_m, gain)));
      without = std::max(without, 1 - finger.relative_friction);
    }
  }
  CAPTURE(worst, without);
  CHECK(without > 0.8);
  CHECK(worst < 0.03);
}

TEST_CASE("a stage without force cells refuses a scene that follows the finger", "[session][follow]") {
  TemporaryFolder folder;
  auto rig = rig::load(measured::kSource + "/tests/support/thin_plate.toml");
  session::Programs programs("protocol.toml");
  session::SimulatedParticipant participant(programs.respondent("sim"));
  session::Inputs inputs;
  const auto stage = session::virtual_stage(session::simulated_stream(rig), participant, inputs);
  CHECK_NOTHROW(stage->follow({nullptr}, {}));
  CHECK_THROWS_AS(stage->follow({std::make_shared<const follow::Plan>()}, {}), audio::BurstRefused);
}
