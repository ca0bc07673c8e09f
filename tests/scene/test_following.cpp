// What the planner makes of scenes that follow the finger. Expected frictions come from the figures under a
// finger (under_finger.cpp), which know nothing of gains, and from closed formulas.
#include "station/scene/following.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "station/core/texts.hpp"
#include "station/scene/planner.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::scene;
using Catch::Matchers::ContainsSubstring;

namespace {

rig::Rig following() {
  return rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/simulated-following.toml");
}

Scene vibrating(double displacement_m = 5e-6, double frequency_Hz = 29222) {
  Scene scene;
  scene.name = "s";
  ToneTarget tone;
  tone.frequency_Hz = frequency_Hz, tone.displacement_m = displacement_m;
  scene.tones = {tone};
  return scene;
}

follow::Part texture(follow::Shape shape, double from, double to, double period_m) {
  follow::Part part;
  part.shape = shape, part.from = from, part.to = to;
  part.begin_m = 0.03, part.end_m = 0.12;
  part.cycles_per_m = 1 / period_m;
  return part;
}

Scene that_follows(Scene scene, const std::vector<follow::Part>& parts, double base = 1,
                   std::optional<std::pair<double, double>> speeds_m_s = {}) {
  FollowTarget target;
  target.pattern.base = base;
  for (const auto& part : parts) follow::add(target.pattern, part);
  target.speeds_m_s = speeds_m_s;
  scene.follow = std::make_shared<const FollowTarget>(target);
  return scene;
}

const std::vector<follow::Part> sine{texture(follow::Shape::sine, 0.4, 0.8, 4e-3)};

std::string refusal(const rig::Rig& rig, const Scene& scene) {
  try {
    Planner(rig).plan(scene);
    return "";
  } catch (const Unreachable& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("the gain for a friction gives that friction under the finger, by figures that know no gain",
          "[scene][follow]") {
  Planner planner(following());
  const auto plan = planner.plan(that_follows(vibrating(), sine));
  REQUIRE(plan.follow);
  const auto& map = plan.follow->map;
  for (const double place_m : {0.040, 0.075, 0.110})
    for (const double friction : {0.3, 0.5, 0.8}) {
      const double gain = map.gain(place_m, friction);
      REQUIRE(gain > 0);
      REQUIRE(gain < 1);
      const auto under = planner.under_finger(planner.plan(vibrating(5e-6 * gain)));
      const auto at = std::lower_bound(under.profile_x_m.begin(), under.profile_x_m.end(), place_m - 1e-9);
      const auto reached = under.profile_friction[static_cast<std::size_t>(at - under.profile_x_m.begin())];
      CAPTURE(place_m, friction, gain, reached);
      CHECK(std::abs(reached - friction) < 0.02);
    }
}

TEST_CASE(
    "a plan that follows has the delay of the rig, the plate's time constant, and the limits of full gain",
    "[scene][follow]") {
  const auto rig = following();
  const auto plan = Planner(rig).plan(that_follows(vibrating(), sine));
  const auto& follow = *plan.follow;
  // half of 288 frames, two periods of 96 and one more at 192 kHz; cells of 400 Hz with a damping of 0.15
  const double delay_s = (144 + 3 * 96) / 192e3 + 2 * 0.15 / (2 * std::numbers::pi * 400);
  CHECK(std::abs(follow::total_delay(follow.timing).total_s - delay_s) < 1e-9);
  CHECK(std::abs(follow.envelope.time_constant_s - 30 / (std::numbers::pi * 29222)) < 1e-9);
  CHECK(follow.map.most_gain() == 1);
  CHECK(follow.estimator.skin_m_per_N == rig.finger.skin_m_per_N);
  CHECK(std::abs(plan.peak_displacement_m - 5e-6) < 1e-9);  // at full gain, whatever is asked for
  CHECK_THAT(refusal(rig, that_follows(vibrating(9e-6), {}, 1)), ContainsSubstring("8"));
  CHECK(plan.cues.friction > 0.35);  // the lowest friction that is asked for, not that of full gain
  CHECK(plan.lowest_friction < 0.2);
}

TEST_CASE("a rig that cannot follow is refused, with what is missing", "[scene][follow]") {
  const auto scene = that_follows(vibrating(), sine);
  REQUIRE(refusal(following(), scene).empty());
  const auto with = [&](const std::function<void(rig::Rig&)>& change) {
    auto rig = following();
    change(rig);
    return refusal(rig, scene);
  };
  CHECK_THAT(with([](rig::Rig& r) { r.capture.reset(); }), ContainsSubstring("needs force cells"));
  CHECK_THAT(with([](rig::Rig& r) { r.capture->bridges.clear(); }), ContainsSubstring("\"bridges\""));
  CHECK_THAT(with([](rig::Rig& r) { r.capture->excitation_channel.reset(); }),
             ContainsSubstring("\"reference\""));
  CHECK_THAT(with([](rig::Rig& r) { r.capture->converter = rig::CellConverter{}; }),
             ContainsSubstring("clock of its own"));
  CHECK_THAT(with([](rig::Rig& r) { r.capture->cells_resonance_Hz.reset(); }),
             ContainsSubstring("cells_resonance_Hz"));
  CHECK_THAT(with([](rig::Rig& r) { r.output.periods = 6; }),
             ContainsSubstring("4.37 ms from the finger's place"));
  CHECK_THAT(with([](rig::Rig& r) {
               r.capture->forces = rig::ForceCells{};
               r.capture->forces->carrier_Hz = 29222 - 2600;
             }),
             ContainsSubstring("only 2600 Hz from the carrier"));
  CHECK_THAT(with([](rig::Rig& r) { r.surface.quality_factor = std::numeric_limits<double>::infinity(); }),
             ContainsSubstring("quality_factor"));
  // a resonance that the calibration measured goes before the one in the file: a third of it is usable
  CHECK(with([](rig::Rig& r) {
          r.capture->cells_resonance_Hz.reset();
          r.capture->forces = rig::ForceCells{};
          r.capture->forces->usable_Hz = 150;
        }) == "");
}

TEST_CASE("tones away from a resonance, or with different time constants, are refused", "[scene][follow]") {
  const auto rig = following();
  const auto refused = refusal(rig, that_follows(vibrating(5e-6, 30300), sine));
  CAPTURE(refused);
  CHECK_THAT(refused, ContainsSubstring("from the nearest resonance (31321."));
  CHECK_THAT(refused, ContainsSubstring("within 505 Hz"));  // 30300 / (2 * 30)
  auto two = vibrating(3e-6);
  auto other = two.tones.front();
  other.frequency_Hz = 37610, other.displacement_m = 1e-6;
  two.tones.push_back(other);
  CHECK_THAT(refusal(rig, that_follows(two, sine)), ContainsSubstring("ring for 0.254 to 0.327 ms"));
  two.tones.back().frequency_Hz = 33414;  // ring for 0.286 and 0.327 ms: within 15 %
  CHECK(refusal(rig, that_follows(two, sine)) == "");
}

TEST_CASE("a texture is refused at a speed at which the plate cannot present it, and only then",
          "[scene][follow]") {
  const auto rig = following();
  const double period_m = 0.4e-3;
  const std::vector<follow::Part> fine{texture(follow::Shape::sine, 0.4, 0.8, period_m)};
  const auto figures = follow_figures(Planner(rig).plan(that_follows(vibrating(), fine)));
  REQUIRE(figures.textures.size() == 1);
  REQUIRE(figures.textures[0].most_speed_m_s);
  const double most_m_s = *figures.textures[0].most_speed_m_s;
  CAPTURE(most_m_s, figures.textures[0].bandwidth_Hz);
  CHECK(most_m_s < 0.9);
  CHECK(most_m_s > 0.01);
  // The amplitude of a plate that only rings down falls by e in T, and gains cannot be below 0: that is the
  // same limit as a bandwidth, so the two agree within a factor.
  CHECK(most_m_s / period_m < 3 * figures.textures[0].bandwidth_Hz);
  CHECK(most_m_s / period_m > figures.textures[0].bandwidth_Hz / 6);
  const auto at = [&](double speed_m_s) {
    return refusal(rig, that_follows(vibrating(), fine, 1, std::pair{0.5 * speed_m_s, speed_m_s}));
  };
  CHECK(at(0.8 * most_m_s) == "");
  CHECK_THAT(at(1.5 * most_m_s), ContainsSubstring("the plate cannot follow that"));
  CHECK_THAT(at(1.5 * most_m_s), ContainsSubstring("mm/s it can"));
}

TEST_CASE("slow force cells leave the long periods, and the refusal says which", "[scene][follow]") {
  auto rig = following();
  rig.capture->cells_resonance_Hz = 90;  // usable up to 30 Hz
  rig.capture->cells_damping = 0.05;
  const auto scene = [](double period_m) {
    return that_follows(vibrating(), {texture(follow::Shape::sine, 0.4, 0.8, period_m)}, 1,
                        std::pair{0.05, 0.1});
  };
  CHECK(refusal(rig, scene(4e-3)) == "");  // 25 Hz at 100 mm/s
  const auto refused = refusal(rig, scene(2e-3));
  CAPTURE(refused);
  CHECK_THAT(refused, ContainsSubstring("usable up to 30 Hz"));
  CHECK_THAT(refused, ContainsSubstring("varies with 50 Hz"));
  CHECK_THAT(refused, ContainsSubstring("periods of 3.33 mm and more remain"));
  CHECK_THAT(refused, ContainsSubstring("lag by 0.18 ms (0.018 mm"));
}

TEST_CASE("a part with begin and end is refused where it cannot be reached; one without is only remarked on",
          "[scene][follow]") {
  const auto rig = following();
  auto part = sine.front();
  part.end_m = 0.16;
  const auto refused = refusal(rig, that_follows(vibrating(), {part}));
  CAPTURE(refused);
  CHECK_THAT(refused, ContainsSubstring("part 1: from 14"));
  CHECK_THAT(refused, ContainsSubstring("is reached (at 1"));
  part.end_m = 0.4;
  CHECK_THAT(refusal(rig, that_follows(vibrating(), {part})), ContainsSubstring("beyond the surface"));
  const auto plan = Planner(rig).plan(that_follows(vibrating(), {}, 0.5));
  const auto missed = unmet_of(plan);
  REQUIRE(missed.size() == 1);
  CHECK(missed[0].from_m > 0.14);
  CHECK(missed[0].from_m < 0.15);
  CHECK(std::abs(missed[0].to_m - 0.3) < 1e-3);
  CHECK(missed[0].least > 0.99);
  // and where it can be reached, the curve is what was asked for
  const auto curve = follow_curve(plan, 301, Events::none);
  CHECK(curve.reached[100] == curve.asked[100]);
  CHECK(curve.reached[200] > 0.99);
  // far too little vibration for any place
  CHECK_THAT(refusal(rig, that_follows(vibrating(1e-8), sine)), ContainsSubstring("part 1: from 30 to"));
}

TEST_CASE("a part that would never be felt is refused", "[scene][follow]") {
  const auto rig = following();
  follow::Part edge;
  edge.shape = follow::Shape::edge, edge.from = 1, edge.to = 0.8;
  edge.begin_m = 0.05, edge.end_m = 0.1, edge.place_m = 0.075;
  CHECK(refusal(rig, that_follows(vibrating(), {edge})).empty());
  edge.place_m = 0.11;
  CHECK_THAT(refusal(rig, that_follows(vibrating(), {edge})),
             ContainsSubstring("part 1 is to change at 110 mm, but it acts from 50 to 100 mm only"));
  edge.width_m = 0.03;  // its slope reaches into the stretch
  CHECK(refusal(rig, that_follows(vibrating(), {edge})).empty());
  edge.shape = follow::Shape::bump, edge.width_m = 0.01;
  CHECK_THAT(refusal(rig, that_follows(vibrating(), {edge})), ContainsSubstring("is to change at 110 mm"));
  follow::Part begins;
  begins.to = 0.8, begins.begin_m = 0.31;
  CHECK_THAT(refusal(rig, that_follows(vibrating(), {begins})),
             ContainsSubstring("part 1 begins at 310 mm, beyond the surface, which is 300 mm long"));
  follow::Part event;
  event.to = 0.8, event.begin_m = 0.05, event.end_m = 0.1;
  event.trigger = {follow::Event::place, 0.06};
  CHECK(refusal(rig, that_follows(vibrating(), {event})).empty());
  event.trigger.threshold = 0.5;
  CHECK_THAT(refusal(rig, that_follows(vibrating(), {event})),
             ContainsSubstring("the event of part 1 is at 500 mm, which no finger passes"));
}

TEST_CASE(
    "two patterns on the same tones have plans of their own; a closed loop has the cut-off of its delay",
    "[scene][follow]") {
  Planner planner(following());
  const auto one = planner.plan(that_follows(vibrating(), sine));
  const auto other = planner.plan(that_follows(vibrating(), {texture(follow::Shape::sine, 0.4, 0.7, 4e-3)}));
  CHECK(one.follow->pattern.parts[0].to == 0.8);
  CHECK(other.follow->pattern.parts[0].to == 0.7);
  CHECK_FALSE(planner.plan(vibrating()).follow);
  auto scene = that_follows(vibrating(), {}, 0.6);
  auto target = *scene.follow;
  target.unit = FollowUnit::coefficient, target.control = follow::Control::closed;
  target.resting_friction = 0.9;
  scene.follow = std::make_shared<const FollowTarget>(target);
  const auto held = planner.plan(scene);
  const double delay_s = follow::total_delay(held.follow->timing).horizon_s + 0.5 * 96 / 192e3;
  for (const double slope : {0.7, 1.3}) {
    CHECK(follow::loop_margins(held.follow->loop.cutoff_Hz, delay_s, delay_s + 5e-3, slope).most_amplified <=
          1.51);
  }
  CHECK(held.follow->loop.cutoff_Hz >= 7);
  CHECK(follow_figures(held).loop_cutoff_Hz == held.follow->loop.cutoff_Hz);
}

TEST_CASE("noise is judged by its frequencies, not by the period after which it repeats", "[scene][follow]") {
  const auto rig = following();
  const auto noise = [](double low_per_m, double high_per_m, int samples) {
    FollowTarget target;
    const std::vector<follow::SpectrumPoint> spectrum{{low_per_m, 1}, {high_per_m, 0.2}};
    const auto section = follow::add_noise(target.pattern, spectrum, 60e-3, samples, {});
    auto part = texture(follow::Shape::table, 0.45, 0.55, 60e-3);
    part.table_first = section.first, part.table_count = section.count;
    follow::add(target.pattern, part);
    target.speeds_m_s = std::pair{0.03, 0.3};
    auto scene = vibrating();
    scene.follow = std::make_shared<const FollowTarget>(target);
    return scene;
  };
  CHECK(refusal(rig, noise(50, 300, 144)) == "");  // up to 90 Hz
  CHECK_THAT(refusal(rig, noise(7500, 8500, 2048)), ContainsSubstring("the plate cannot follow that"));
  auto slow = rig;
  slow.capture->cells_resonance_Hz = 90, slow.capture->cells_damping = 0.05;  // usable up to 30 Hz
  CHECK_THAT(refusal(slow, noise(240, 300, 144)), ContainsSubstring("periods of 10 mm and more remain"));
}

TEST_CASE("a texture that moves is checked in both directions, and its figures never stop the program",
          "[scene][follow]") {
  const auto rig = following();
  const auto moving = [](double frequency_Hz, std::optional<std::pair<double, double>> speeds_m_s) {
    auto part = texture(follow::Shape::sine, 0.4, 0.8, 0.1e-3);
    part.cycles_per_s = frequency_Hz;
    return that_follows(vibrating(), {part}, 1, speeds_m_s);
  };
  // 0 Hz in one direction, 3000 Hz in the other
  CHECK_THAT(refusal(rig, moving(-1500, std::pair{0.15, 0.15})), ContainsSubstring("varies with 3000 Hz"));
  for (const double frequency_Hz : {-1.0, 100.0, -10.0})
    CHECK_NOTHROW(follow_figures(Planner(rig).plan(moving(frequency_Hz, {}))));
}

TEST_CASE("a promised stretch is proved at all times", "[scene][follow]") {
  auto part = texture(follow::Shape::sine, 0, 1, 4e-3);
  part.cycles_per_m = 0, part.cycles_per_s = 5;  // 0.5 at time 0
  CHECK_THAT(refusal(following(), that_follows(vibrating(), {part})), ContainsSubstring("is reached (at"));
}

TEST_CASE("cues see events, phases in time, and what sounds before touch", "[scene][follow]") {
  Planner planner(following());
  follow::Part part;
  part.to = 0.4, part.begin_m = 0.03, part.end_m = 0.12;
  part.trigger.event = follow::Event::force, part.trigger.threshold = 1;
  const auto gains = followed_gains(*planner.plan(that_follows(vibrating(), {part})).follow);
  CHECK(gains.rms > 0);
  CHECK(gains.lowest_friction < 0.45);
  auto in_time = texture(follow::Shape::sine, 0.4, 0.8, 4e-3);
  in_time.cycles_per_m = 0, in_time.cycles_per_s = 5;
  CHECK(followed_gains(*planner.plan(that_follows(vibrating(), {in_time})).follow).lowest_friction < 0.45);
  auto resting = that_follows(vibrating(), {});
  auto target = *resting.follow;
  target.resting_gain = 0.5;
  resting.follow = std::make_shared<const FollowTarget>(target);
  CHECK(followed_gains(*planner.plan(resting).follow).rms == 0.5);
}

TEST_CASE("slow cells are refused also without a texture, and without a speed", "[scene][follow]") {
  auto rig = following();
  rig.capture->cells_resonance_Hz = 90, rig.capture->cells_damping = 0.05;
  follow::Part edge;
  edge.shape = follow::Shape::edge, edge.from = 0.4, edge.to = 0.8, edge.place_m = 0.07;
  edge.begin_m = 0.03, edge.end_m = 0.12;
  CHECK_THAT(refusal(rig, that_follows(vibrating(), {edge})), ContainsSubstring("give \"speed_mm_s\""));
  CHECK_THAT(refusal(rig, that_follows(vibrating(), {edge}, 1, std::pair{0.05, 0.1})),
             ContainsSubstring("changes over 3.33 mm and more remain"));
  edge.width_m = 5e-3;
  const auto scene = that_follows(vibrating(), {edge}, 1, std::pair{0.05, 0.1});
  CHECK(refusal(rig, scene) == "");
  CHECK(remark_on(rig, Planner(rig).plan(scene)));
  CHECK_FALSE(remark_on(following(), Planner(following()).plan(scene)));
  // An open loop takes its word for the friction at rest; a closed one measures it.
  FollowTarget target;
  target.pattern.base = 0.8;
  target.unit = FollowUnit::coefficient;
  const auto remarked = [&] {
    auto held = vibrating();
    held.follow = std::make_shared<const FollowTarget>(target);
    return remark_on(following(), Planner(following()).plan(held)).has_value();
  };
  CHECK(remarked());
  target.resting_friction = 1;
  CHECK_FALSE(remarked());
  target.resting_friction.reset(), target.control = follow::Control::closed;
  CHECK_FALSE(remarked());
  rig.capture->cells_resonance_Hz = 20;
  CHECK_THAT(refusal(rig, scene), ContainsSubstring("fingers change their movement"));
}
