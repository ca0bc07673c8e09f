// Tests the silence before the first stimulus of a trial: it must be measured, or the trial says that it was
// not.
#include <cmath>

#include "physics/friction.hpp"
#include "station/session/vibration_watch.hpp"
#include "tests/sensing/proofs.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using core::Proof;
using core::ProofCause;

namespace {

/// The result of a stimulus before which nobody touches the surface for `quiet_s`, where `lost_s` of the
/// capture are missing just before the onset.
sensing::IntervalResult after_silence(double quiet_s, double lost_s = 0) {
  const sensing::Room room;
  const auto burst = sensing::three_tones();
  const auto plan = sensing::plan_of(room, burst);
  session::VibrationWatch watch(
      {room.rate_Hz, room.channels, plan.pick_ups, room.delay_frames, false, {}, {}});
  const auto frames_of = [&](double seconds) { return std::llround(seconds * room.rate_Hz); };
  watch.expect({&plan.burst, 1}, burst.start_frame - frames_of(quiet_s));
  const auto onset = burst.start_frame + static_cast<std::int64_t>(room.delay_frames);
  const auto push = [&](std::int64_t first, std::int64_t end) {
    const auto samples = sensing::captured(room, burst, first, end - first);
    sensing::in_blocks(room, samples, first, {384}, [&](const auto& block) { watch.push(block); });
  };
  // The proof of the interval itself needs the last 25 ms before the onset.
  push(onset - frames_of(0.2), onset - frames_of(0.026 + lost_s));
  push(onset - frames_of(0.026), onset + frames_of(0.5));
  return *watch.result(0);
}

}  // namespace

TEST_CASE("a trial before which the silence could not be measured is flagged, and says so",
          "[session][proof]") {
  const auto good = after_silence(1);
  CHECK(good.verdict == Proof::ok);
  REQUIRE(good.silence);
  CHECK(good.silence->verdict == Proof::ok);
  // The noise of the capture, relative to the rms of the planned tones. The high-pass filter weakens both
  // alike, to within a decibel.
  CHECK(good.silence->rms_dB == Approx(20 * std::log10(1e-4 / 0.155)).margin(1));

  for (const auto& unknown : {after_silence(0.05), after_silence(1, 0.01)}) {
    CHECK(unknown.verdict == Proof::flagged);
    CHECK(unknown.cause == ProofCause::gap);
    REQUIRE(unknown.silence);
    CHECK(unknown.silence->verdict == Proof::lost);
  }
}

TEST_CASE("a stimulus that follows as soon as it may still leaves time to measure the silence",
          "[session][proof]") {
  CHECK(after_silence(session::kExpected_ns * 1e-9).verdict == Proof::ok);
}

TEST_CASE("broadband sound at the limits of the silence lowers friction by 0.04 % and 0.4 %",
          "[session][proof]") {
  const physics::FrictionMap friction;  // the curve of a rig that has not measured its own
  const double plan_m = 1.5e-6;
  const auto lowered = [&](double level_dB) {
    return 1 - friction.relative_friction(plan_m * std::pow(10, level_dB / 20));
  };
  CHECK(lowered(-40) == Approx(0.0004).epsilon(0.25));
  CHECK(lowered(-30) == Approx(0.004).epsilon(0.25));
}
