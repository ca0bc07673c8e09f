#include <algorithm>
#include <random>
#include <vector>

#include "station/sensing/interval_proof.hpp"
#include "tests/sensing/room.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;
using terms::Proof;
using terms::ProofCause;

namespace {

drive::Burst burst_of(std::vector<drive::Tone> tones, std::int64_t length = 76800, std::int64_t ramp = 960) {
  drive::Burst burst;
  burst.start_frame = 123'456'789'012;
  burst.length_frames = length;
  burst.ramp.frames = ramp;
  burst.tones.count = static_cast<std::int32_t>(tones.size());
  std::copy(tones.begin(), tones.end(), burst.tones.tones.begin());
  return burst;
}

drive::Burst three_tones() {
  return burst_of({{25000.5, 0.3, 0.2, 0}, {30321.7, 0.25, 1.9, 0}, {36543.2, 0.2, -2.5, 0}});
}

IntervalPlan plan_of(const Room& room, const drive::Burst& burst) {
  IntervalPlan plan;
  plan.burst = burst;
  plan.rate_Hz = room.rate_Hz;
  plan.capture_channels = room.channels;
  for (const SimplePickUp& pick_up : room.pick_ups) plan.pick_ups.push_back(calibrated(pick_up));
  plan.delay_frames = room.delay_frames;
  return plan;
}

IntervalResult proven(const Room& room, const drive::Burst& burst, std::optional<bool> in_contact = false,
                      const IntervalPlan* other_plan = nullptr) {
  IntervalProof proof(other_plan != nullptr ? *other_plan : plan_of(room, burst));
  const std::int64_t first = proof.first_frame();
  const auto samples = captured(room, burst, first, proof.end_frame() - first);
  in_blocks(room, samples, first, {384}, [&](const CaptureBlock& block) { proof.push(block); });
  CHECK(proof.complete());
  return proof.result(in_contact);
}

}  // namespace

TEST_CASE("an interval that vibrates as planned is proven", "[sensing][proof]") {
  const IntervalResult proof = proven(Room{}, three_tones());
  CAPTURE(name(proof.cause));
  CHECK(proof.verdict == Proof::ok);
  CHECK(proof.cause == ProofCause::none);
  REQUIRE(proof.tones.size() == 3);
  for (const ToneProof& tone : proof.tones) {
    CHECK(tone.seen);
    CHECK(std::fabs(tone.ratio_dB) < 0.01);
    CHECK(std::fabs(tone.phase_error_deg) < 0.1);
  }
  CHECK(std::fabs(proof.ratio_dB) < 0.01);
  CHECK(proof.residual_dB < -60);
  REQUIRE(proof.onset_error_us);
  CHECK(std::fabs(*proof.onset_error_us) < 30);
  CHECK(proof.lost_frames == 0);
}

TEST_CASE("each fault of the drive is named", "[sensing][proof]") {
  Room room;
  const auto check = [&](Proof verdict, ProofCause cause) {
    const IntervalResult proof = proven(room, three_tones());
    CAPTURE(proof.ratio_dB, proof.residual_dB, proof.onset_error_us.value_or(-1e9), proof.largest_sample,
            proof.product ? name(*proof.product) + " " + std::to_string(proof.product->level_dB) : "");
    CHECK(std::string(name(proof.cause)) == name(cause));
    CHECK(std::string(name(proof.verdict)) == name(verdict));
    return proof;
  };
  SECTION("dead") {
    room.drive_gain = 0;
    check(Proof::stopped, ProofCause::dead);
  }
  SECTION("half") {
    room.drive_gain = 0.5;
    const IntervalResult proof = check(Proof::stopped, ProofCause::half);
    CHECK(proof.ratio_dB == Approx(-6.02).margin(0.01));
  }
  SECTION("another frequency") {
    room.frequency_factor = 1.03;
    const IntervalResult proof = check(Proof::stopped, ProofCause::frequency);
    REQUIRE(proof.found_Hz);
    CHECK(*proof.found_Hz == Approx(25000.5 * 1.03).margin(10));
  }
  SECTION("late") {
    room.late_s = 0.005;
    const IntervalResult proof = check(Proof::refused, ProofCause::late);
    REQUIRE(proof.onset_error_us);
    CHECK(*proof.onset_error_us == Approx(5000).margin(30));
  }
  SECTION("a limiter in the drive") {
    room.limiter = 0.25;
    check(Proof::refused, ProofCause::clipped);
  }
  SECTION("a capture at its limit") {
    room.extra = [](double t) { return t > 0.1 && t < 0.1001 ? 1.0 : 0.0; };
    check(Proof::refused, ProofCause::clipped);
  }
  SECTION("a level that is a little wrong") {
    room.drive_gain = std::pow(10, -0.7 / 20);
    check(Proof::flagged, ProofCause::level);
  }
  SECTION("a rattling clamp") {
    room.extra = [](double t) { return 0.025 * std::sin(2 * M_PI * 25000.5 / 2 * t); };
    const IntervalResult proof = check(Proof::stopped, ProofCause::residual);
    REQUIRE(proof.product);
    CHECK(name(*proof.product) == "f1 / 2");
  }
  SECTION("nothing: the control") { check(Proof::ok, ProofCause::none); }
}

TEST_CASE("a gap of the capture is named", "[sensing][proof]") {
  const Room room;
  const auto burst = three_tones();
  IntervalProof proof(plan_of(room, burst));
  const std::int64_t first = proof.first_frame();
  const auto samples = captured(room, burst, first, proof.end_frame() - first);
  in_blocks(room, samples, first, {384}, [&, k = 0](const CaptureBlock& block) mutable {
    if (++k != 100) proof.push(block);
  });
  CHECK(proof.complete());
  const IntervalResult& result = proof.result(false);
  CHECK(result.verdict == Proof::lost);
  CHECK(result.cause == ProofCause::gap);
  CHECK(result.lost_frames >= 384);
  CHECK(result.lost_frames <= 384 + 4 * 96);
}
