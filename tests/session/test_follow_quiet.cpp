#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "station/session/follow_loop.hpp"
#include "tests/audio/watch.hpp"
#include "tests/follow/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

TEST_CASE("on the capture's thread the loop allocates, frees, locks and logs nothing, whatever happens",
          "[session][follow][realtime]") {
  audio::StreamConfig config;
  config.output.period_frames = 96;
  config.output.periods = 2;
  const auto stream = audio::open_synchronous(config);
  session::FollowLoop loop(*stream, 4);
  auto plan = lab::plan_of({});
  plan.control = follow::Control::closed;
  audio::Burst burst;
  burst.length_frames = 192000 * 10;
  burst.tones.count = 1;
  burst.tones.tones[0] = {30000, 0.5, 0, 0};
  burst.following = {1, 0, 960, 960, 1920};
  sensing::FingerSetup cells;
  cells.bridges.reference_amplitude = 0.5;
  cells.calibration = sensing::ForceCalibration({{{12, 0, 0}, {12, 0, 3600}, {0, 12, 0}}}, {});
  std::int64_t frame = 0;
  std::vector<std::int32_t> frames(4 * 96);
  const auto capture = [&](int periods, std::uint32_t numbering = 0) {
    int violations = 0;
    for (int k = 0; k < periods; ++k, frame += 96) {
      for (std::size_t n = 0; n < 96; ++n)
        for (std::size_t c = 0; c < 4; ++c)
          frames[4 * n + c] = static_cast<std::int32_t>(
              (c == 0 ? 0.5 : 0.02) * 0x1p31 *
              std::cos(2 * std::numbers::pi * 10525 / 192000 * static_cast<double>(frame + std::int64_t(n))));
      violations += audio::violations_in([&] { loop.captured(frame, numbering, frames); });
    }
    return violations;
  };
  const auto begin = [&] {
    const auto prepared = audio::prepare(burst, {192000, 2, 24});
    loop.prepare({std::make_shared<const follow::Plan>(plan)}, {&prepared, 1}, cells);
    const std::vector<session::FollowLoop::Burst> bursts{{1, frame, frame + burst.length_frames}};
    loop.begin(bursts, sensing::Readings{}, {0, 0});
  };
  CHECK(capture(10) == 0);  // no trial
  begin();
  CHECK(capture(200) == 0);
  begin();                      // the next trial: the capture takes it, and the session frees the one before
  CHECK(capture(200, 1) == 0);  // frames were lost
  CHECK(capture(5000) == 0);    // nobody takes what is recorded, and the stream takes no gains
  const auto followed = loop.take();
  CHECK(followed.not_recorded > 0);
  CHECK(followed.periods.size() == 4096);
  loop.end();
  CHECK(capture(10) == 0);
  CHECK(loop.take().periods.empty());
}
