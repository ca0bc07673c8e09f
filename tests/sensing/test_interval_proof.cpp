#include <algorithm>
#include <random>
#include <vector>

#include "tests/sensing/proofs.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;
using core::Proof;
using core::ProofCause;

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
  REQUIRE(proof.offset_error_us);
  CHECK(std::fabs(*proof.offset_error_us) < 30);
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
  SECTION("cut short: the last ramp breaks off at half its level") {
    const auto burst = three_tones();
    const double half_s = (static_cast<double>(burst.length_frames) - 480) / 192000;
    room.gain_at = [=](double t) { return t < half_s ? 1.0 : 0.0; };
    const IntervalResult proof = check(Proof::flagged, ProofCause::offset);
    REQUIRE(proof.offset_error_us);
    CHECK(*proof.offset_error_us < -300);
  }
  SECTION("a drive that stops 3 ms late") {
    auto longer = three_tones();
    const auto plan = plan_of(room, longer);
    longer.length_frames += 576;
    const IntervalResult proof = proven(room, longer, false, &plan);
    CHECK(proof.verdict == Proof::refused);
    CHECK(proof.cause == ProofCause::offset);
    CHECK(proof.offset_error_us.value() == Approx(3000).margin(30));
  }
  SECTION("a pulse of 0.1 ms in the middle") {
    room.extra = [](double t) { return t > 0.1 && t < 0.1001 ? 0.05 * std::sin(2 * M_PI * 33000 * t) : 0.0; };
    const IntervalResult proof = check(Proof::refused, ProofCause::residual);
    CHECK(proof.residual_dB < -40);  // which alone would be no reason
    CHECK(proof.brief_dB > -24);
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
  SECTION("phases that differ from the calibration") {
    IntervalPlan plan = plan_of(room, three_tones());
    for (const auto& [turn_deg, verdict] : {std::pair{15, Proof::flagged}, {40, Proof::refused}}) {
      SimplePickUp turned = room.pick_ups[0];
      turned.phase_rad -= turn_deg * M_PI / 180;
      plan.pick_ups = {calibrated(turned)};
      const IntervalResult result = proven(room, three_tones(), false, &plan);
      CHECK(result.verdict == verdict);
      CHECK(result.cause == ProofCause::phase);
      CHECK(result.tones[0].phase_error_deg == Approx(turn_deg).margin(0.1));
    }
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
  CHECK(result.lost_frames <= 384 + 2 * 192);
}

TEST_CASE("amplitude and phase are measured to 0.01 dB and 0.1 degrees", "[sensing][proof]") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int tones = 1; tones <= 8; ++tones)
    for (int k = 0; k < 3; ++k) {
      Room room;
      room.seed = random();
      room.delay_frames = 96000 * uniform(random);
      const auto burst = random_burst(random, tones, 0.3);
      const IntervalResult result = proven(room, burst);
      REQUIRE(result.tones.size() == static_cast<std::size_t>(tones));
      for (const ToneProof& tone : result.tones) {
        CAPTURE(tones, tone.frequency_Hz);
        CHECK(tone.seen);
        CHECK(std::fabs(tone.ratio_dB) < 0.01);
        CHECK(std::fabs(tone.phase_error_deg) < 0.1);
      }
    }
}

TEST_CASE(
    "a last ramp that breaks off is seen at whatever level, and so is a pulse of 0.1 ms at whatever time",
    "[sensing][proof]") {
  const auto burst = three_tones();
  Room room;
  SECTION("ramp") {
    const double share = GENERATE(0.35, 0.5, 0.65, 0.8, 0.95, 1.0);
    const double ramp_frames = std::acos(2 * share - 1) / M_PI * 960;
    const double stop_s = (static_cast<double>(burst.length_frames) - 960 + ramp_frames) / 192000;
    room.gain_at = [=](double t) { return t < stop_s ? 1.0 : 0.0; };
    const auto proof = proven(room, burst);
    CAPTURE(share, proof.offset_error_us.value_or(0));
    CHECK(proof.verdict != Proof::ok);
    CHECK(proof.cause == ProofCause::offset);
  }
  SECTION("pulse") {
    // The first ramp and the 5 ms in which the plate settles after it are not judged.
    const double at_s = GENERATE(0.0123, 0.05, 0.2, 0.3456, 0.38, 0.3938), level = GENERATE(0.05, 0.5);
    room.extra = [=](double t) {
      return t > at_s && t < at_s + 1e-4 ? level * std::sin(2 * M_PI * 33000 * t) : 0.0;
    };
    const auto proof = proven(room, burst);
    CAPTURE(at_s, level, proof.brief_dB);
    CHECK((proof.verdict == Proof::refused || proof.verdict == Proof::stopped));
  }
}

TEST_CASE("the onset is measured to 30 us for ramps of 5 ms, and to 150 us for ramps of 50 ms",
          "[sensing][proof]") {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const auto& [ramp, tolerance_us] : {std::pair<std::int64_t, double>{960, 30}, {9600, 150}})
    for (int k = 0; k < 20; ++k) {
      Room room;
      room.seed = random();
      room.noise = 1e-3;
      room.delay_frames = 1000 * uniform(random);
      room.late_s = k % 4 == 0 ? 0 : 0.004 * uniform(random) - 0.002;
      auto burst = random_burst(random, 1 + k % 4, 0.2);
      burst.ramp.frames = ramp;
      const IntervalResult result = proven(room, burst);
      REQUIRE(result.onset_error_us);
      CHECK(*result.onset_error_us == Approx(1e6 * room.late_s).margin(tolerance_us));
    }
}

TEST_CASE("a tone on a node of the pick-up is not proven, unless another pick-up can measure it",
          "[sensing][proof]") {
  Room room;
  room.pick_ups = {{4, 0.5, 0.7, 3e-4}, {5, 0.4, -0.4, 2e-4}};
  const auto burst = three_tones();
  IntervalPlan plan = plan_of(room, burst);
  Transfer& first = plan.pick_ups[0].transfers[0];
  for (std::size_t k = 0; k < first.response.size(); ++k)
    if (std::fabs(first.frequency_Hz[k] - 30321.7) < 500) first.response[k] *= 0.04;
  const IntervalResult both = proven(room, burst, false, &plan);
  CHECK(both.verdict == Proof::ok);
  CHECK(both.tones[1].pick_up == 1);
  room.pick_ups.pop_back();
  plan.pick_ups.pop_back();
  const IntervalResult one = proven(room, burst, false, &plan);
  CHECK(one.verdict == Proof::unproven);
  CHECK(one.tones[0].seen);
  CHECK_FALSE(one.tones[1].seen);
}

TEST_CASE("mains hum and friction noise of the finger hardly count", "[sensing][proof]") {
  Room room;
  room.hum = 0.05;
  room.extra = [](double t) { return 0.02 * std::sin(2 * M_PI * 731 * t); };
  const IntervalResult result = proven(room, three_tones());
  CHECK(result.verdict == Proof::ok);
  CHECK(result.residual_dB < -50);
}

TEST_CASE("a finger may change the level more before the trial is void", "[sensing][proof]") {
  Room room;
  room.gain_at = [](double t) { return t < 0.1 ? 1 : std::pow(10, -2.0 / 20); };
  const auto burst = three_tones();
  const IntervalResult alone = proven(room, burst, false), touched = proven(room, burst, true);
  CHECK(alone.verdict == Proof::stopped);  // the step in level also leaves a residual
  CHECK(alone.tones[0].worst_ratio_dB == Approx(-2).margin(0.05));
  CHECK(touched.tones[0].worst_ratio_dB == Approx(-2).margin(0.05));
}

TEST_CASE("the result does not depend on the sizes of the captured blocks", "[sensing][proof]") {
  const Room room;
  const auto burst = three_tones();
  const auto run = [&](const std::vector<std::int64_t>& sizes) {
    IntervalProof proof(plan_of(room, burst));
    const std::int64_t first = proof.first_frame() - 1000;
    const auto samples = captured(room, burst, first, proof.end_frame() + 500 - first);
    in_blocks(room, samples, first, sizes, [&](const CaptureBlock& block) { proof.push(block); });
    return proof.result(false);
  };
  const IntervalResult expected = run({100'000});
  for (const auto& sizes : std::vector<std::vector<std::int64_t>>{{1}, {384}, {7, 500, 1, 96}}) {
    const IntervalResult result = run(sizes);
    CHECK(result.verdict == expected.verdict);
    CHECK(result.residual_dB == expected.residual_dB);
    CHECK(result.onset_error_us == expected.onset_error_us);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(result.tones[k].ratio_dB == expected.tones[k].ratio_dB);
      CHECK(result.tones[k].phase_error_deg == expected.tones[k].phase_error_deg);
    }
  }
}

TEST_CASE("an interval that was not captured is lost", "[sensing][proof]") {
  const Room room;
  IntervalProof proof(plan_of(room, three_tones()));
  CHECK_FALSE(proof.complete());
  CHECK(proof.result().verdict == Proof::lost);
  CHECK(proof.result().cause == ProofCause::gap);
}

TEST_CASE("a burst that was stopped is judged up to the stop", "[sensing][proof]") {
  const Room room;
  auto burst = burst_of({{25000.5, 0.3, 0.2, 0}, {30321.7, 0.25, 1.9, 0}}, 192000);
  auto played = burst;
  played.length_frames = 100'000;
  for (const bool told : {true, false}) {
    IntervalProof proof(plan_of(room, burst));
    const std::int64_t first = proof.first_frame();
    const auto samples = captured(room, played, first, proof.end_frame() - first);
    if (told) proof.stopped(burst.start_frame + played.length_frames - played.ramp.frames);
    in_blocks(room, samples, first, {384}, [&](const CaptureBlock& block) { proof.push(block); });
    CHECK(proof.result(false).verdict == (told ? Proof::ok : Proof::stopped));
  }
}

TEST_CASE("tones of equal frequency on two channels are measured as one", "[sensing][proof]") {
  Room room;
  auto burst = burst_of({{25000.5, 0.3, 0.2, 0}, {25000.5, 0.2, 1.0, 1}, {30321.7, 0.25, 1.9, 0}});
  IntervalPlan plan = plan_of(room, burst);
  plan.pick_ups[0].transfers.push_back(calibrated(room.pick_ups[0], 1).transfers[0]);
  const IntervalResult result = proven(room, burst, false, &plan);
  CHECK(result.verdict == Proof::ok);
  REQUIRE(result.tones.size() == 3);
  plan.pick_ups[0].transfers.pop_back();  // the second channel is not calibrated
  CHECK(proven(room, burst, false, &plan).verdict == Proof::unproven);
}

TEST_CASE("both sets of tones of a burst with a change are proven as the synthesiser plays them",
          "[sensing][proof]") {
  auto burst = burst_of({{25000.5, 0.3, 0.2, 0}, {30321.7, 0.25, 1.9, 0}}, 96000);
  burst.start_frame = 10'000;
  burst.change_count = 1;
  burst.changes[0].at_frame = 40'000;
  burst.changes[0].frames = 9600;
  burst.changes[0].to = burst_of({{26000.5, 0.2, 0, 0}, {30321.7, 0.3, 0, 0}, {35000.1, 0.1, 0.4, 0}}).tones;
  const audio::Format format{192000, 1, 24};
  audio::Synth synth(format);
  REQUIRE(synth.start(audio::prepare(burst, format)));
  std::vector<std::int32_t> samples(120'000);
  synth.render(0, std::span(samples));
  Room room;
  room.channels = 1;
  room.delay_frames = 0;
  room.pick_ups = {{0, 1, 0, 0}};
  IntervalPlan plan = plan_of(room, burst);
  const auto run = [&] {
    IntervalProof proof(plan);
    proof.push({samples, 1, 0, 192000});
    return proof.result(false);
  };
  const IntervalResult result = run();
  CHECK(result.verdict == Proof::ok);
  REQUIRE(result.tones.size() == 5);
  for (const ToneProof& tone : result.tones) {
    CAPTURE(tone.stretch, tone.tone);
    CHECK(std::fabs(tone.ratio_dB) < 0.001);
    CHECK(std::fabs(tone.phase_error_deg) < 0.01);
  }
  plan.burst.changes[0].frames += 1;  // one more frame turns the phase after the glide by 0.6 degrees
  CHECK(std::fabs(run().tones[2].phase_error_deg) > 0.5);
}
