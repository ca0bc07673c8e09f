#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <vector>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/engine_core.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/audio/watch.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

TEST_CASE("negative control: the counter detects an allocation, a lock and a log line", "[drive][realtime]") {
  CHECK(violations_in([] {
          std::vector<int>* const made = new std::vector<int>(7);
          delete made;
        }) >= 2);
  std::mutex mutex;
  CHECK(violations_in([&] { const std::lock_guard lock(mutex); }) >= 1);
  CHECK(violations_in([] { std::puts(""); }) >= 1);
}

TEST_CASE("the audio thread's code allocates, locks and logs nothing, whatever commands it gets",
          "[drive][realtime]") {
  StreamConfig config;
  EngineCore core(config);
  std::vector<std::int32_t> block(2 * 384);
  std::int64_t frame = 0;
  Burst burst = one_tone(20000, 0.4);
  burst.tones.count = 3;
  burst.tones.tones[1] = {23000, 0.2, 0, 0};
  burst.tones.tones[2] = {25000, 0.2, 0, 1};
  burst.start_frame = 1000;
  burst.change_count = 1;
  burst.changes[0] = {30000, 9600, one_tone(21000, 0.4).tones};
  burst.marker.kind = MarkerKind::tone;
  burst.marker.amplitude = 0.1;
  burst.noise.rms = 0.01;
  const auto id = core.schedule(burst, [] { return std::int64_t{0}; });
  Burst following = one_tone(30000, 0.1);
  following.start_frame = 1000;
  following.following = {1, 0.5, 960, 480, 1920};
  const auto follows = core.schedule(following, [] { return std::int64_t{0}; });
  bool gains = true;  // whether gains come for the burst that follows them
  const auto run = [&](int blocks) {
    return violations_in([&] {
      for (int k = 0; k < blocks; ++k, frame += 384) {
        for (std::int64_t at = frame; gains && at < frame + 384; at += 96)
          static_cast<void>(core.follow({follows, 96, at, {1, 0.9f, 0.8f, 0.7f, 0.8f, 0.9f, 1, 1}}));
        core.process(frame, block);
      }
    });
  };
  CHECK(run(50) == 0);
  gains = false;
  CHECK(run(20) == 0);
  gains = true;
  Change change;
  change.at_frame = 60000;
  change.to = one_tone(24000, 0.3).tones;
  core.change(id, change);
  CHECK(run(50) == 0);
  core.stop(0, Ramp{}, std::nullopt);
  frame += 1000;  // simulates lost frames
  CHECK(run(100) == 0);
  CHECK(violations_in([&] { core.report({EventKind::underrun, 0, frame, 1000, -EPIPE}); }) == 0);
  while (core.poll()) {
  }
  CHECK(core.counters().events_dropped == 0);
}

TEST_CASE("writing through alsa-lib allocates, locks and logs nothing", "[drive][realtime][alsa]") {
  ::setenv("ALSA_CONFIG_PATH", TURNPOINT_SOURCE_DIR "/tests/audio/asound.conf", 1);
  // alsa-lib locks a mutex around plug-ins, but not around hardware. Switch this mutex off, so that the null
  // plug-in behaves like hardware.
  ::setenv("LIBASOUND_THREAD_SAFE", "0", 1);
  OutputConfig config;
  config.uri = "alsa:straight";
  config.allow_plugin = {"null"};
  const auto output = open_output(config);
  const std::vector<std::int32_t> block(2 * 384);
  WriteResult result;
  CHECK(violations_in([&] {
          for (int k = 0; k < 100 && result.status == WriteStatus::ok; ++k) {
            result = output->write(block);
            static_cast<void>(output->position());
          }
        }) == 0);
  CHECK(result.status == WriteStatus::ok);
}

TEST_CASE("capturing through alsa-lib allocates, locks and logs nothing, even if nobody takes the frames",
          "[drive][realtime][alsa][capture]") {
  ::setenv("ALSA_CONFIG_PATH", TURNPOINT_SOURCE_DIR "/tests/audio/asound.conf", 1);
  ::setenv("LIBASOUND_THREAD_SAFE", "0", 1);
  OutputConfig config;
  config.uri = "alsa:straight";
  config.allow_plugin = {"null"};
  DeviceCapture capture(config);
  CHECK(violations_in([&] {
          for (int k = 0; k < 2000; ++k) capture.step();
        }) == 0);
  CHECK(capture.counters().frames == 2000 * 384);
  CHECK(capture.counters().lost_frames > 0);
}
