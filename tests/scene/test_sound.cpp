#include "station/scene/sound.hpp"

#include "physics/airborne.hpp"
#include "station/core/limits.hpp"
#include "station/scene/planner.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;

namespace {

constexpr auto kModel = physics::Model::mode;

double level_dB(const rig::Rig& rig, const physics::Tone& tone) {
  return physics::loudest_sound(rig::surface_of(rig), tone, kModel, scene::kEarDistance_m).level_dB;
}

scene::SoundBound bound_of(const rig::Rig& rig, const std::vector<physics::Tone>& tones) {
  const auto bound = scene::sound_bound(rig, tones, kModel);
  REQUIRE(bound);
  return *bound;
}

}  // namespace

TEST_CASE("the limit is 75 dB in the third-octave bands up to 20 kHz and 110 dB above", "[scene][sound]") {
  CHECK(core::allowed_sound_dB(20000) == 75);
  CHECK(core::allowed_sound_dB(22399) == 75);
  CHECK(core::allowed_sound_dB(22400) == 110);
}

TEST_CASE("the powers of tones in one third-octave band add up, but not those of tones in different bands",
          "[scene][sound]") {
  const auto rig = quick_rig();
  const physics::Tone low{30000, 1e-6, 0}, near{32000, 1e-6, 0}, far{44000, 1e-7, 0};
  const double a = level_dB(rig, low), b = level_dB(rig, near), c = level_dB(rig, far);
  const double sum = 10 * std::log10(std::pow(10, a / 10) + std::pow(10, b / 10));
  CHECK(bound_of(rig, {low, near}).level_dB == Approx(sum).margin(1e-9));
  REQUIRE(c < sum);
  CHECK(bound_of(rig, {low, near, far}).level_dB == Approx(sum).margin(1e-9));
  CHECK(bound_of(rig, {far}).level_dB == Approx(c).margin(1e-9));
  CHECK(bound_of(rig, {low, near}).frequency_Hz == (a > b ? 30000 : 32000));
}

TEST_CASE("the band that exceeds its limit most is reported, even if another is louder", "[scene][sound]") {
  const auto rig = quick_rig();
  const physics::Tone audible{22000, 3e-7, 0}, loud{32000, 1e-6, 0};
  const double quiet_dB = level_dB(rig, audible), loud_dB = level_dB(rig, loud);
  REQUIRE(quiet_dB < loud_dB);
  REQUIRE(quiet_dB - 75 > loud_dB - 110);
  const auto bound = bound_of(rig, {loud, audible});
  CHECK(bound.frequency_Hz == 22000);
  CHECK(bound.allowed_dB == 75);
}

TEST_CASE("without a tone there is no sound, and for a surface too wide for the bound no level is stated",
          "[scene][sound]") {
  auto rig = quick_rig();
  const physics::Tone tone{44000, 1e-6, 0}, silent{44000, 0, 0};
  CHECK_FALSE(scene::sound_bound(rig, {}, kModel));
  CHECK_FALSE(scene::sound_bound(rig, {&silent, 1}, kModel));
  rig.surface.taper.half_width_m = 0.08;
  CHECK_FALSE(scene::sound_bound(rig, {&tone, 1}, kModel));
}
