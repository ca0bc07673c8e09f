// IntervalProof must not allocate memory while it takes captured frames.
#include "station/sensing/interval_proof.hpp"
#include "station/sensing/lock_in.hpp"
#include "station/sensing/pilot.hpp"
#include "station/sensing/raw_ring.hpp"
#include "station/sensing/silence_proof.hpp"
#include "tests/audio/watch.hpp"
#include "tests/sensing/room.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;

TEST_CASE(
    "the proof of an interval, silence, pilot, lock-in and raw ring allocate nothing while they take frames",
    "[sensing]") {
  Room room;
  audio::Burst burst;
  burst.start_frame = 100'000;
  burst.length_frames = 120'000;
  burst.tones.count = 2;
  burst.tones.tones[0] = {25000, 0.3, 0, 0};
  burst.tones.tones[1] = {30000, 0.3, 0, 0};
  IntervalPlan plan;
  plan.burst = audio::prepare(burst, {room.rate_Hz, 1, 24});
  plan.pick_ups = {calibrated(room.pick_ups[0])};
  plan.delay_frames = room.delay_frames;
  const auto samples = captured(room, burst, 90'000, 150'000);
  IntervalProof proof(plan);
  SilenceProof silence(plan);
  PilotListener pilot({}, 90'000, room.channels, 0);
  LockIn lock_in(room.rate_Hz, room.channels, {4}, {{{0, 1ULL << 61}, 0}}, 0);
  RawRing raw(room.rate_Hz, room.channels, 0.5);
  double sum = 0;
  CHECK(audio::violations_in([&] {
          const CaptureBlock block{samples, room.channels, 90'000, room.rate_Hz};
          proof.push(block);
          silence.push(block);
          pilot.push(block);
          raw.push(block);
          lock_in.push(block, [&](double frame, std::span<const std::complex<double>>) { sum += frame; });
        }) == 0);
  CHECK(proof.complete());
  CHECK(proof.result(false).verdict == core::Proof::ok);
  CHECK(audio::violations_in([&] { IntervalProof again(plan); }) > 0);
}
