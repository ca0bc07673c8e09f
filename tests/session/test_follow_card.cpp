#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/device_stream.hpp"
#include "station/session/follow_loop.hpp"
#include "tests/audio/fake_pcm.hpp"
#include "tests/follow/lab.hpp"
#include "tests/follow/plant.hpp"
#include "tests/support/catch.hpp"

// The loop on a sound card: the station's real stream, output and capture run step by step on the simulated
// card, whose playback and capture share one time. What counts is what the card has played.

using namespace turnpoint;
using audio::fake_pcm;

namespace {

constexpr std::int64_t kPeriod = 96, kEighth = 12;
constexpr double kTone_Hz = 32000, kAmplitude = 0.5, kPer_N = 0.08, kReference = 0.5;

/// A card with 96 frames in a period and two periods of buffer, and a plant behind it, which hears what was
/// played `loop_delay` frames ago and is captured at once.
class Card {
 public:
  Card(const plant::Setup& setup, follow::Plan plan, std::int64_t loop_delay, double seconds)
      : plant_(setup), span_m_(setup.span_m) {
    audio::reset_fake_pcm();
    fake_pcm().loop_delay = loop_delay;
    fake_pcm().wires = [this](auto played, auto captured) { wire(played, captured); };
    audio::StreamConfig config;
    config.output.uri = "alsa:fake";
    config.output.period_frames = kPeriod;
    config.output.periods = 2;
    stream_ = std::make_unique<audio::DeviceStream>(config);
    auto inputs = config.output;
    inputs.channels = 4;
    capture_ = std::make_unique<audio::DeviceCapture>(inputs);
    loop_ = std::make_unique<session::FollowLoop>(*stream_, 4);
    capture_->listen(*loop_);
    run(0.15);
    const auto shared = std::make_shared<const follow::Plan>(plan);
    audio::Burst burst;
    burst.length_frames = static_cast<std::int64_t>(192000 * seconds);
    burst.ramp.frames = 1920;
    burst.tones.count = 1;
    burst.tones.tones[0] = {kTone_Hz, kAmplitude, 0, 0};
    burst.following = {plan.map.most_gain(), plan.resting_gain, 960, 960, 1920};
    auto prepared = audio::prepare(burst, {192000, 2, 24});
    sensing::FingerSetup cells;
    cells.bridges.reference_amplitude = kReference;
    cells.calibration = sensing::ForceCalibration(
        {{{1 / kPer_N, 0, 0}, {1 / kPer_N, 0, 1e3 * span_m_ / kPer_N}, {0, 1 / kPer_N, 0}}}, {});
    loop_->prepare({shared}, {&prepared, 1}, cells);
    prepared.start_frame = stream_->earliest_frame() + 9600;
    const auto scheduled = stream_->schedule_together({&prepared, 1});
    // a pilot would find this
    const std::int64_t shift = fake_pcm().played - fake_pcm().captured - loop_delay;
    const std::array bursts{session::FollowLoop::Burst{scheduled[0].burst, scheduled[0].start_frame,
                                                       scheduled[0].start_frame + prepared.length_frames}};
    delay = loop_->check_delay({shift, 0});
    loop_->begin(bursts, sensing::Readings{}, {shift, 0});
  }
  ~Card() { fake_pcm().wires = nullptr; }

  /// Lets so many seconds of the card's time pass, in which the audio and the capture thread do their work.
  void run(double seconds) {
    const auto end = fake_pcm().now + static_cast<std::int64_t>(192000 * seconds);
    while (fake_pcm().now < end) {
      stream_->step();
      const auto& card = fake_pcm();
      while (captures && (card.capture_state != audio::FakePcm::State::running ||
                          card.captured - card.taken >= card.period))
        capture_->step();
      while (const auto event = stream_->poll()) loop_->note(*event);
      while (capture_->take() != nullptr) {
      }
      loop_->gather();
    }
  }

  /// Gain of what the card has played from this frame of time on, over an eighth of a period.
  static double gain_at(std::int64_t now) {
    std::complex<double> sum;
    for (std::int64_t i = 0; i < kEighth; ++i)
      sum += std::polar(0x1p-31 * fake_pcm().heard[static_cast<std::size_t>(now + i)],
                        -2 * std::numbers::pi * kTone_Hz / 192000 * static_cast<double>(now + i));
    return std::abs(sum) / 6 / kAmplitude;
  }
  session::Followed followed() { return loop_->take(); }
  const audio::DeviceStream& stream() const { return *stream_; }

  std::optional<session::DelayCheck> delay;  ///< before the burst
  bool captures = true;
  std::int64_t jump_at = -1;  ///< frame of time at which the force doubles

 private:
  void wire(std::span<const std::int32_t> played, std::span<std::int32_t> captured) {
    const auto now = fake_pcm().now;
    sum_ +=
        std::polar(0x1p-31 * played[0], -2 * std::numbers::pi * kTone_Hz / 192000 * static_cast<double>(now));
    if (now % kEighth == kEighth - 1) {
      plant_.step(std::abs(sum_) / 6 / kAmplitude);
      sum_ = 0;
    }
    const auto force = plant_.now();
    // The jump is added here, at its very frame; the plant only knows of eighths.
    const double more = jump_at >= 0 && now >= jump_at ? 2 : 1;
    const double carrier = std::cos(2 * std::numbers::pi * 10525 / 192000 * static_cast<double>(now));
    const double b = more * force.moment_Nm / span_m_;
    const std::array volts{1.0, kPer_N * (more * force.normal_N - b), kPer_N * b,
                           kPer_N * more * force.lateral_N};
    for (std::size_t c = 0; c < 4; ++c)
      captured[c] = static_cast<std::int32_t>(
          std::lround((kReference * volts[c] * carrier + 1e-6 * dice_.bell()) * 0x1p31));
  }

  plant::Plant plant_;
  double span_m_;
  plant::Dice dice_{5};
  std::complex<double> sum_;
  std::unique_ptr<audio::DeviceStream> stream_;
  std::unique_ptr<session::FollowLoop> loop_;  ///< outlives the capture
  std::unique_ptr<audio::DeviceCapture> capture_;
};

plant::Setup finger() {
  plant::Setup s;
  s.resonance_Hz = kTone_Hz;
  return s;
}

follow::Plan click_at_075_N(const plant::Setup& s, std::int64_t loop_delay) {
  auto plan = lab::plan_of(s);
  plan.timing.converter_s = static_cast<double>(loop_delay) / 192000;
  follow::Part click;
  click.to = 0.4;
  click.trigger = {follow::Event::force, 0.75};
  add(plan.pattern, click);
  return plan;
}

}  // namespace

TEST_CASE(
    "on a card with periods of 96 frames, two of them buffered, it takes less than 4 ms from the force to "
    "the amplitude, and the same to one period",
    "[session][card][follow]") {
  const std::int64_t loop_delay = GENERATE(0, 192);
  CAPTURE(loop_delay);
  std::vector<std::int64_t> delays;
  for (std::int64_t phase = 0; phase < kPeriod; phase += 13) {
    const auto s = finger();
    Card card(s, click_at_075_N(s, loop_delay), loop_delay, 0.6);
    card.run(0.2);
    card.jump_at = fake_pcm().now / kPeriod * kPeriod + 10 * kPeriod + phase;
    card.run(0.05);
    CHECK(Card::gain_at(card.jump_at - 960) < 0.02);
    auto at = card.jump_at;
    while (Card::gain_at(at) < 0.05) REQUIRE(++at < card.jump_at + 4 * 192);
    delays.push_back(at - card.jump_at);
    const auto followed = card.followed();
    CHECK(followed.late.empty());
    CHECK(followed.periods.back().update.interrupted == 0);
    CHECK(card.stream().counters().underruns == 0);
  }
  const auto [least, most] = std::minmax_element(delays.begin(), delays.end());
  CAPTURE(*least, *most);
  CHECK(*most + kPeriod <= 4 * 192);  // also the last frame of the period
  CHECK(*most - *least <= kPeriod);
}

TEST_CASE("if the card's capture stalls, what is played rests within 10 ms", "[session][card][follow]") {
  const auto s = finger();
  auto plan = lab::plan_of(s);
  plan.resting_gain = 0.1;
  follow::Part constant;
  constant.to = 0.4;
  add(plan.pattern, constant);
  Card card(s, plan, 0, 0.8);
  card.run(0.25);
  const auto from = fake_pcm().now;
  CHECK(Card::gain_at(from - 96) > 0.3);
  card.captures = false;
  card.run(0.1);
  CHECK(Card::gain_at(from + 1920) == Approx(0.1).margin(0.002));
  CHECK(Card::gain_at(from + 9600) == Approx(0.1).margin(0.002));
  REQUIRE(card.followed().late.size() == 1);
}

TEST_CASE("the stated delay of the converters is compared with that of the card", "[session][card][follow]") {
  const auto s = finger();
  const auto stated_for = [&](std::int64_t stated_frames, std::int64_t loop_delay) {
    auto plan = lab::plan_of(s);
    plan.timing.converter_s = static_cast<double>(stated_frames) / 192000;
    return Card(s, plan, loop_delay, 0.1).delay.value();
  };
  for (const std::int64_t loop_delay : {0, 48}) {
    CAPTURE(loop_delay);
    const auto right = stated_for(loop_delay, loop_delay);
    CAPTURE(right.least_s * 192000, right.most_s * 192000);
    // On this card a period is captured just before the next one is played, so a period less would do.
    CHECK(192000 * right.most_s == Approx(static_cast<double>(loop_delay - kPeriod)));
    CHECK(192000 * right.least_s >= static_cast<double>(loop_delay - 2 * kPeriod));
    CHECK_FALSE(right.tight());
    CHECK_FALSE(right.too_long());
    const auto late = stated_for(loop_delay, loop_delay + 3 * kPeriod);
    CHECK(late.too_short());
    CHECK_FALSE(late.too_long());
    const auto early = stated_for(loop_delay + 2 * kPeriod, loop_delay);
    CHECK(early.too_long());
    CHECK_FALSE(early.tight());
  }
  const auto said = stated_for(96, 480).sentence();
  CAPTURE(said);
  CHECK(said.find("states 0.50 ms") != std::string::npos);
  CHECK(said.find("all gains come too late") != std::string::npos);
  CHECK(said.find("are needed") != std::string::npos);
}

TEST_CASE(
    "a card whose converters are slower than stated is never followed wrongly: gains come too late, and the "
    "surface rests",
    "[session][card][follow]") {
  const auto s = finger();
  auto plan = lab::plan_of(s);
  follow::Part constant;
  constant.to = 0.4;
  add(plan.pattern, constant);
  Card card(s, plan, 400, 0.6);  // stated: 0
  card.run(0.4);
  CHECK(Card::gain_at(fake_pcm().now - 96) < 0.02);
  CHECK_FALSE(card.followed().late.empty());
}
