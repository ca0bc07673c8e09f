#include <cmath>

#include "station/audio/device_stream.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/audio/fake_pcm.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

namespace {

StreamConfig on_fake_card() {
  reset_fake_pcm();
  StreamConfig config;
  config.output.uri = "alsa:fake";
  return config;
}

void steps(DeviceStream& stream, int count) {
  for (int k = 0; k < count; ++k) stream.step();
}

/// Returns the stream's estimate of the current frame minus the frame that the card is playing. The card must
/// be playing, and the initial silence must be over.
double error_frames(DeviceStream& stream) {
  const auto& card = fake_pcm();
  const auto next = stream.counters().frames;
  const auto heard_in = static_cast<double>(card.queued());
  const double told_ns = static_cast<double>(stream.time_of(next).value() - card.now_ns());
  return told_ns * 1e-9 * static_cast<double>(card.rate_Hz) - heard_in;
}

}  // namespace

TEST_CASE("before the device has reported its position, its time is unknown", "[drive][clock]") {
  DeviceStream stream(on_fake_card());
  CHECK(stream.clock().pairs == 0);
  CHECK_FALSE(stream.time_of(0));
  CHECK_FALSE(stream.frame_at(1'000'000'000));
  fake_pcm().stamps = false;  // this device never reports its position
  steps(stream, 50);
  CHECK_FALSE(stream.time_of(0));
  fake_pcm().stamps = true;
  steps(stream, 2);
  CHECK(std::abs(error_frames(stream)) <= 1);
}

TEST_CASE("a restart of the device is noticed even if nobody reads the positions for a long time",
          "[drive][clock]") {
  DeviceStream stream(on_fake_card());
  steps(stream, 5000);  // ten seconds: the ring of positions fills up
  fake_pcm().fail(FakePcm::State::xrun);
  fake_pcm().pass(5000);
  stream.step();
  CHECK_FALSE(stream.time_of(0));  // the ring contains only positions from before the restart
  steps(stream, 3);
  CHECK(std::abs(error_frames(stream)) <= 1);
  steps(stream, 200);
  CHECK(std::abs(error_frames(stream)) <= 1);
}

TEST_CASE("while the device is missing its time is unknown, and after its return the rate is measured again",
          "[drive][clock]") {
  DeviceStream stream(on_fake_card());
  auto& card = fake_pcm();
  steps(stream, 1500);
  REQUIRE(stream.measured_rate());
  CHECK(std::abs(stream.measured_rate()->deviation_ppm) < 10);
  card.fail(FakePcm::State::gone);
  card.present = false;
  steps(stream, 10);
  CHECK_FALSE(stream.time_of(0));
  CHECK_FALSE(stream.measured_rate());
  card.present = true;
  while (card.state != FakePcm::State::running) stream.step();
  steps(stream, 2);
  CHECK(std::abs(error_frames(stream)) <= 1);
  CHECK_FALSE(stream.measured_rate());
  // After its return the device runs 400 ppm fast: every 2500th frame takes no time.
  std::int64_t due = card.now + 2500;
  card.before_call = [&] {
    if (card.now < due) return;
    due += 2500;
    --card.now;
  };
  bool wrong = false;
  for (int k = 0; k < 12'000 && !wrong; ++k) {
    stream.step();
    while (const auto event = stream.poll()) wrong |= event->kind == EventKind::rate_wrong;
  }
  CHECK(wrong);
  REQUIRE(stream.measured_rate());
  CHECK(stream.measured_rate()->deviation_ppm > RateCheck::tolerance_ppm);
}

TEST_CASE("an underrun is reported with its first lost frame and with the burst that lost frames",
          "[drive][gaps]") {
  DeviceStream stream(on_fake_card());
  auto& card = fake_pcm();
  steps(stream, 20);
  Burst burst = one_tone(20000, 0.4);
  burst.start_frame = stream.earliest_frame() + 5000;
  const auto id = stream.schedule(burst);
  const auto underrun = [&] {
    std::optional<Event> found;
    while (const auto event = stream.poll())
      if (event->kind == EventKind::underrun) found = event;
    return found;
  };
  const auto rendered = stream.counters().frames;
  card.pass(card.queued() + 100);
  stream.step();
  auto told = underrun();
  REQUIRE(told);
  CHECK(told->frame == rendered);
  CHECK(told->frames == 100 + 384);
  CHECK(told->burst == 0);  // 0 means none: no burst had begun yet
  steps(stream, 100);
  const auto in_burst = stream.counters().frames;
  card.pass(card.queued() + 50);
  stream.step();
  told = underrun();
  REQUIRE(told);
  CHECK(told->frame == in_burst);
  CHECK(told->burst == id);
  CHECK(stream.counters().lost_frames == 100 + 384 + 50 + 384);
}
