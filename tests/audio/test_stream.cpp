#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>

#include "station/audio/engine.hpp"
#include "station/audio/synth.hpp"
#include "station/core/usage_error.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint::audio;

namespace {

std::string scratch_file(const char* name) {
  static const TemporaryFolder folder;
  return folder / name;
}

std::vector<std::int32_t> samples_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  REQUIRE(bytes.size() >= 68);
  std::vector<std::int32_t> samples((bytes.size() - 68) / 4);
  std::memcpy(samples.data(), bytes.data() + 68, samples.size() * 4);
  return samples;
}

}  // namespace

TEST_CASE("10 000 onsets in a rendered stream are exactly at the requested frames", "[drive][stream]") {
  const std::string path = scratch_file("onsets.wav");
  StreamConfig config;
  config.output.uri = "wav:" + path;
  config.output.channels = 1;
  const auto stream = open_synchronous(config);
  std::vector<std::int64_t> asked;
  std::int64_t next = 500;
  std::uint64_t random = 1;
  for (int k = 0; k < 10000; ++k) {
    Burst burst = one_tone(24000, 0.5, M_PI / 8);  // with this phase no sample is 0
    burst.start_frame = next;
    burst.length_frames = 64;
    burst.ramp.frames = 0;
    stream->schedule(burst);
    asked.push_back(next);
    random = random * 6364136223846793005u + 1442695040888963407u;
    next += 100 + static_cast<std::int64_t>(random >> 56);
    stream->advance(next - 90 - stream->frame());
    while (stream->poll()) {
    }
  }
  stream->advance(1000);
  stream->finish();
  const auto samples = samples_of(path);
  std::vector<std::int64_t> found;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    if (samples[k] != 0 && samples[k - 1] == 0) found.push_back(static_cast<std::int64_t>(k));
  }
  CHECK((found == asked));
  CHECK(stream->counters().bursts == 10000);
  std::remove(path.c_str());
}

TEST_CASE(
    "a stream that only passes frames without rendering them reports the same events as one that renders",
    "[drive][stream]") {
  StreamConfig passing;
  passing.samples = Samples::passed;
  const auto rendered = open_synchronous({}), passed = open_synchronous(passing);
  std::uint64_t random = 7;
  const auto draw = [&random](std::int64_t below) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::int64_t>((random >> 33) % static_cast<std::uint64_t>(below));
  };
  int events = 0;
  for (int k = 0; k < 300; ++k) {
    Burst burst = one_tone(20000 + 10.0 * k, 0.2);
    burst.start_frame = rendered->frame() + draw(3000);
    burst.length_frames = 2000 + draw(8000);
    burst.ramp.frames = draw(900);
    if (k % 3 == 0) {
      burst.change_count = 1;
      burst.changes[0].at_frame = 500 + draw(500), burst.changes[0].frames = 1 + draw(900);
      burst.changes[0].to = one_tone(30000, 0.1).tones;
    }
    const auto id = rendered->schedule(burst);
    REQUIRE(passed->schedule(burst) == id);
    const auto first = draw(4000), second = draw(9000);
    for (auto* stream : {rendered.get(), passed.get()}) {
      stream->advance(first);
      if (k % 4 == 0) stream->stop(id, Ramp{300});
      stream->advance(second);
    }
    while (const auto event = rendered->poll()) {
      const auto same = passed->poll();
      REQUIRE(same);
      CHECK((same->kind == event->kind && same->burst == event->burst && same->frame == event->frame));
      ++events;
    }
    CHECK_FALSE(passed->poll());
  }
  CHECK(events >= 400);
  passing.output.uri = "wav:" + scratch_file("never.wav");
  CHECK_THROWS_AS(open_synchronous(passing), turnpoint::core::UsageError);
}

TEST_CASE("virtual time is exactly the frame number divided by the rate, even after a month",
          "[drive][stream]") {
  const auto stream = open_synchronous({}, 1'000);
  CHECK(stream->time_of(192000LL * 86400 * 30) == 1'000 + 1'000'000'000LL * 86400 * 30);
  CHECK(stream->frame_at(stream->time_of(123456789012).value()) == 123456789012);
}

TEST_CASE(
    "a burst is refused if it is too late, if all voices are in use, or if it is too loud together with "
    "others",
    "[drive][stream]") {
  const auto stream = open_synchronous({});
  stream->advance(1000);
  Burst burst = one_tone(20000, 0.4);
  burst.start_frame = 999;
  CHECK_THROWS_WITH(
      stream->schedule(burst),
      "burst refused: start frame 999 is already past; the earliest possible start is frame 1000");
  {
    const auto other = open_synchronous({});
    other->advance(1000);
    CHECK(other->schedule_soon(burst).start_frame == 1000);
  }
  burst.start_frame = 2000;
  stream->schedule(burst);
  stream->schedule(burst);
  CHECK_THROWS_AS(stream->schedule(burst), BurstRefused);  // refused because 3 * 0.4 > 1
  burst.tones.tones[0].amplitude = 0.01;
  for (int more = 2; more < Synth::max_voices; ++more) stream->schedule(burst);
  // refused because all voices are in use (a voice plays one burst)
  CHECK_THROWS_AS(stream->schedule(burst), BurstRefused);
  stream->advance(200000);
  burst.start_frame = stream->earliest_frame();
  CHECK_NOTHROW(stream->schedule(burst));
  // Two bursts of 0.49998 fit into 32 bits, but at 16 bits they leave no room for the dither.
  for (const int bits : {16, 32}) {
    StreamConfig config;
    config.output.bits = bits;
    const auto other = open_synchronous(config);
    Burst half = one_tone(20000, 0.49998);
    half.start_frame = 1000;
    other->schedule(half);
    if (bits == 16) CHECK_THROWS_AS(other->schedule(half), BurstRefused);
    if (bits == 32) CHECK_NOTHROW(other->schedule(half));
  }
}

TEST_CASE("a live change alters the tone of a playing burst, and a stop ends the burst", "[drive][stream]") {
  const auto stream = open_synchronous({});
  Burst burst = one_tone(20000, 0.4);
  burst.length_frames = 1920000;
  const auto id = stream->schedule(burst);
  stream->advance(50000);
  Change change;
  change.at_frame = 60000;
  change.to = one_tone(25000, 0.2).tones;
  stream->change(id, change);
  change.to = one_tone(25000, 1.2).tones;
  CHECK_THROWS_AS(stream->change(id, change), BurstRefused);
  stream->advance(50000);
  stream->stop(id, {9600});
  stream->advance(9600);
  const auto started = stream->poll();
  const auto ended = stream->poll();
  REQUIRE(ended.has_value());
  CHECK(started->kind == EventKind::burst_started);
  CHECK(ended->kind == EventKind::burst_ended);
  CHECK(ended->frame == 109600);
  CHECK_THROWS_AS(stream->change(id, change), BurstRefused);
}

TEST_CASE(
    "a live change is refused if it would clip together with other bursts or with the burst's own later "
    "changes",
    "[drive][stream]") {
  const auto stream = open_synchronous({});
  Burst first = one_tone(20000, 0.2);
  first.length_frames = 400'000;
  first.change_count = 1;
  first.changes[0] = {300'000, 9600, one_tone(20000, 0.6).tones};
  const auto id = stream->schedule(first);
  stream->advance(20'000);
  Change louder{30'000, 9600, one_tone(20000, 0.5).tones};
  stream->change(id, louder);
  Burst second = one_tone(20500, 0.45);
  second.start_frame = 60'000;
  // refused because 0.6 + 0.45 > 1, although the first burst has not reached 0.6 yet
  CHECK_THROWS_AS(stream->schedule(second), BurstRefused);
  second.tones.tones[0].amplitude = 0.39;
  stream->schedule(second);
  louder.at_frame = 80'000;
  louder.to.tones[0].amplitude = 0.65;
  CHECK_THROWS_AS(stream->change(id, louder),
                  BurstRefused);  // the change would be too loud with the second burst
  // The change is allowed once the second burst is over.
  stream->advance(200'000);
  louder.at_frame = 250'000;
  CHECK_NOTHROW(stream->change(id, louder));
  stream->advance(400'000);
  CHECK(stream->counters().saturated == 0);
  CHECK(stream->largest_sample() < 1);
}

TEST_CASE("after a live change makes a burst louder, other bursts may be only that much softer",
          "[drive][stream]") {
  const auto stream = open_synchronous({});
  Burst first = one_tone(20000, 0.2);
  first.length_frames = 400'000;
  const auto id = stream->schedule(first);
  stream->advance(20'000);
  stream->change(id, Change{30'000, 9600, one_tone(20000, 0.7).tones});
  Burst second = one_tone(20500, 0.45);
  second.start_frame = 60'000;
  CHECK_THROWS_AS(stream->schedule(second),
                  BurstRefused);  // refused because 0.7 + 0.45 > 1; without the change, 0.2 + 0.45 would fit
  second.tones.tones[0].amplitude = 0.29;
  stream->schedule(second);
  stream->advance(400'000);
  CHECK(stream->counters().saturated == 0);
  CHECK(stream->largest_sample() < 1);
}

TEST_CASE("bursts that are scheduled together keep their distances, or all are refused", "[drive][stream]") {
  const auto stream = open_synchronous({});
  stream->advance(5000);
  std::vector<PreparedBurst> bursts(3, prepare(one_tone(20000, 0.6), Format{}));
  bursts[0].start_frame = 1000;
  bursts[1].start_frame = 98'765;
  bursts[2].start_frame = 200'001;
  const auto scheduled = stream->schedule_together(bursts);
  REQUIRE(scheduled.size() == 3);
  CHECK(scheduled[0].start_frame == 5000);
  CHECK(scheduled[1].start_frame == 5000 + 97'765);
  CHECK(scheduled[2].start_frame == 5000 + 199'001);
  stream->stop(0, {}, {});  // stop all three before the first one begins
  stream->advance(384);
  while (stream->poll()) {
  }
  bursts[1].start_frame = 2000;  // two bursts of 0.6 at the same time are too loud
  CHECK_THROWS_AS(stream->schedule_together(bursts), BurstRefused);
  stream->advance(400'000);
  CHECK(stream->counters().bursts == 0);
}

TEST_CASE("play renders a file with the predicted peak", "[drive][stream]") {
  const std::string path = scratch_file("play.wav");
  StreamConfig config;
  config.output.uri = "wav:" + path;
  const PlayReport report = play(config, one_tone(20000, 0.5));
  CHECK(report.counters.bursts == 1);
  CHECK(report.counters.saturated == 0);
  CHECK(report.peak == Approx(0.5));
  CHECK(report.largest_sample == Approx(0.5).epsilon(1e-4));
  CHECK(samples_of(path).size() == 2 * 96000);
  std::remove(path.c_str());
  config.output.uri = "wav:/nonexistent/a.wav";
  CHECK_THROWS_AS(play(config, one_tone(20000, 0.5)), std::system_error);
  config.output.uri = "mp3:x";
  CHECK_THROWS_AS(play(config, one_tone(20000, 0.5)), turnpoint::core::UsageError);
}
