#include <algorithm>
#include <vector>

#include "station/audio/alsa_capture.hpp"
#include "tests/audio/fake_pcm.hpp"
#include "tests/support/catch.hpp"

// These tests run the station's capture step by step on a simulated sound card. Each captured frame carries
// the time at which the card captured it, so that every frame can be checked against its number.

using namespace turnpoint::audio;

namespace {

OutputConfig two_channels() {
  OutputConfig config;
  config.uri = "alsa:fake";
  return config;
}

/// A simulated card that captures the time on channel 0 and its negative on channel 1.
struct Card {
  explicit Card(const OutputConfig& config = two_channels()) : channels(config.channels) {
    reset_fake_pcm();
    fake_pcm().wires = [](auto, std::span<std::int32_t> captured) {
      captured.front() = static_cast<std::int32_t>(fake_pcm().now);
      captured.back() = -captured.front();
    };
    capture = std::make_unique<DeviceCapture>(config);
  }

  /// Takes all blocks that are waiting, and checks that they are in order.
  void take() {
    while (const auto* block = capture->take()) {
      CHECK(block->first_frame >= next);
      next = block->first_frame + block->count / channels;
      numbering = block->numbering;
      const auto used = block->used();
      for (std::size_t n = 0; n < used.size(); n += static_cast<std::size_t>(channels))
        times.push_back(used[n]), last.push_back(used[n + static_cast<std::size_t>(channels) - 1]);
    }
  }

  int channels;
  std::unique_ptr<DeviceCapture> capture;
  std::int64_t next = 0;
  std::uint32_t numbering = 0;
  std::vector<std::int32_t> times, last;
};

bool is_consecutive(const std::vector<std::int32_t>& times, std::size_t first, std::size_t end) {
  for (std::size_t n = first + 1; n < end; ++n)
    if (times[n] != times[n - 1] + 1) return false;
  return true;
}

}  // namespace

TEST_CASE("a capture delivers every sample of every channel, numbered from 0", "[drive][capture]") {
  const auto [channels, period] = GENERATE(std::pair{2, 384}, std::pair{6, 384}, std::pair{3, 1000});
  auto config = two_channels();
  config.channels = channels;
  config.period_frames = period;
  Card card(config);
  for (int k = 0; k < 100; ++k) {
    card.capture->step();
    card.take();
  }
  REQUIRE(card.times.size() == static_cast<std::size_t>(100 * period));
  CHECK(card.times.front() == 0);
  CHECK(is_consecutive(card.times, 0, card.times.size()));
  CHECK(std::equal(card.times.begin(), card.times.end(), card.last.begin(),
                   [](std::int32_t a, std::int32_t b) { return a == -b; }));
  const auto counters = card.capture->counters();
  CHECK(counters.frames == 100 * period);
  CHECK(counters.overruns == 0);
  CHECK(counters.unknown_gaps == 0);
  CHECK(card.numbering == 0);
}

TEST_CASE("an overrun is counted with its length, and the numbers of later frames stay right",
          "[drive][capture]") {
  Card card;
  card.capture->step();
  fake_pcm().pass(10'000);  // more than the buffer's 1536 frames
  card.capture->step();     // detects the overrun
  card.capture->step();
  card.take();
  const auto counters = card.capture->counters();
  CHECK(counters.overruns == 1);
  CHECK(counters.lost_frames == 10'000);
  CHECK(counters.unknown_gaps == 0);
  CHECK(card.numbering == 1);
  REQUIRE(card.times.size() == 768);
  CHECK(is_consecutive(card.times, 384, 768));
  CHECK(card.times[384] == 384 + 10'000);
  CHECK(card.next == card.times.back() + 1);
}

TEST_CASE("frames that the device overwrites during a read are lost, not delivered", "[drive][capture]") {
  Card card;
  card.capture->step();
  fake_pcm().before_read = [] { fake_pcm().pass(3'000); };
  card.capture->step();
  fake_pcm().before_read = nullptr;
  card.capture->step();
  card.capture->step();
  card.take();
  CHECK(card.capture->counters().overruns == 2);
  CHECK(is_consecutive(card.times, 0, 384));
  CHECK(is_consecutive(card.times, 384, card.times.size()));
  CHECK(card.next == card.times.back() + 1);
}

TEST_CASE("a capture that was restarted continues under another numbering", "[drive][capture]") {
  const auto how = GENERATE(FakePcm::State::xrun, FakePcm::State::suspended);
  Card card;
  card.capture->step();
  fake_pcm().capture_state = how;
  fake_pcm().pass(500);
  card.capture->step();
  card.capture->step();
  card.take();
  const auto counters = card.capture->counters();
  CHECK(counters.unknown_gaps == 1);
  CHECK(counters.overruns == 0);
  CHECK(counters.present);
  CHECK(card.numbering == 1);
  REQUIRE(card.times.size() == 768);
  CHECK(card.times[384] == 384 + 500);
  CHECK(card.next > 768);
}

TEST_CASE("a capture whose device is unplugged is absent until it is back", "[drive][capture]") {
  Card card;
  card.capture->step();
  fake_pcm().capture_state = FakePcm::State::gone;
  fake_pcm().present = false;
  for (int k = 0; k < 1000; ++k) card.capture->step();
  CHECK_FALSE(card.capture->counters().present);
  CHECK(card.capture->counters().unknown_gaps == 1);
  fake_pcm().present = true;
  for (int k = 0; k < 1000; ++k) {
    card.capture->step();
    card.take();
  }
  CHECK(card.capture->counters().present);
  CHECK(card.numbering == 1);
  CHECK(is_consecutive(card.times, 384, card.times.size()));
}

TEST_CASE("if nobody takes the blocks, new frames are lost and counted", "[drive][capture]") {
  Card card;
  while (card.capture->counters().overruns == 0) card.capture->step();
  card.take();
  CHECK(card.times.size() > 192'000);
  CHECK(is_consecutive(card.times, 0, card.times.size()));
  card.capture->step();
  const auto before = card.times.size();
  card.take();
  CHECK(card.numbering == 1);
  CHECK(card.times[before] == static_cast<std::int32_t>(before) + card.capture->counters().lost_frames);
}

TEST_CASE("a listener hears every captured period on the capture's thread, also if nobody takes the blocks",
          "[drive][capture][follow]") {
  struct Hears : CaptureListener {
    std::vector<std::int32_t> times;
    std::vector<std::int64_t> first;
    std::uint32_t numbering = 0;
    void captured(std::int64_t first_frame, std::uint32_t number,
                  std::span<const std::int32_t> samples) noexcept override {
      first.push_back(first_frame);
      numbering = number;
      for (std::size_t n = 0; n < samples.size(); n += 2) times.push_back(samples[n]);
    }
  } hears;
  Card card;
  card.capture->step();
  card.capture->listen(hears);
  for (int k = 0; k < 5; ++k) card.capture->step();
  CHECK(hears.first == std::vector<std::int64_t>{384, 768, 1152, 1536, 1920});
  CHECK(is_consecutive(hears.times, 0, hears.times.size()));
  CHECK(hears.times.front() == 384);
  fake_pcm().pass(10'000);  // an overrun
  card.capture->step();
  card.capture->step();
  CHECK(hears.numbering == 1);
  CHECK(hears.times.back() == hears.first.back() + 383);
  while (card.capture->counters().overruns < 2)
    card.capture->step();  // the ring is full: nobody takes blocks
  CHECK(hears.first.back() + 384 == card.capture->counters().frames);
}
