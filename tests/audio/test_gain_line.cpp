#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>

#include "station/audio/engine.hpp"
#include "station/audio/synth.hpp"
#include "station/system/clocks.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/audio/spectrum.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

namespace {

constexpr Format format{192000, 2, 24};
constexpr std::int64_t kPeriod = 96;
constexpr double kRest = 0.25, kMost = 1.5;

Following following() { return {kMost, kRest, 960, 480, 1920}; }

/// A function of the frame, as the gain of which periods are made.
using Gain = std::function<double(std::int64_t frame)>;

GainPeriod period_of(const Gain& gain, std::int64_t frame, std::uint32_t burst = 0) {
  GainPeriod made{burst, kPeriod, frame, {}};
  for (std::size_t k = 0; k < made.gain.size(); ++k)
    made.gain[k] = static_cast<float>(gain(frame + 12 * static_cast<std::int64_t>(k + 1)));
  return made;
}

/// The polygon through the gains of all periods from `first`, which begins at the resting gain there. Written
/// without the code that is tested.
double polygon(const Gain& gain, std::int64_t first, std::int64_t frame) {
  const std::int64_t k = (frame - first) / 12;
  const auto knot = [&](std::int64_t i) {
    return i == 0 ? kRest : static_cast<double>(static_cast<float>(gain(first + 12 * i)));
  };
  return knot(k) + (knot(k + 1) - knot(k)) * static_cast<double>((frame - first) % 12) / 12.0;
}

double wave(std::int64_t frame) { return 0.8 + 0.4 * std::sin(2 * std::numbers::pi * frame / 1700.0); }

/// Renders a burst from its start in blocks, and gives it gains before each block. `gives` says whether the
/// period that begins at this frame comes in time. Returns channel 0.
struct Rendering {
  std::vector<double> samples;
  std::vector<SynthEvent> lost, back;
};
Rendering rendered(Burst burst, const Gain& gain, const std::function<bool(std::int64_t)>& gives,
                   std::int64_t first = 0, std::int64_t skip_from = -1, std::int64_t skip_to = -1) {
  Synth synth(format);
  auto prepared = prepare(burst, format);
  prepared.id = 7;
  REQUIRE(synth.start(prepared));
  Rendering out;
  std::vector<double> block(2 * kPeriod);
  std::int64_t next = first;
  for (std::int64_t frame = 0; frame < burst.start_frame + burst.length_frames;) {
    if (frame == skip_from) {
      out.samples.resize(static_cast<std::size_t>(skip_to), 0);
      frame = skip_to;
    }
    for (; next < frame + 2 * kPeriod; next += kPeriod)
      if (gives(next)) synth.follow(period_of(gain, next, 7));
    synth.render(frame, std::span<double>(block));
    for (std::size_t n = 0; n < block.size(); n += 2) out.samples.push_back(block[n]);
    for (const auto& event : synth.events())
      if (event.kind == SynthEventKind::unfollowed)
        out.lost.push_back(event);
      else if (event.kind == SynthEventKind::follows)
        out.back.push_back(event);
    synth.clear_events();
    frame += kPeriod;
  }
  return out;
}

const auto always = [](std::int64_t) { return true; };

Burst steady_tone(double frequency_Hz = 30000, double amplitude = 0.5) {
  Burst burst = one_tone(frequency_Hz, amplitude, 0.3);
  burst.ramp.frames = 0;
  return burst;
}

}  // namespace

TEST_CASE("a burst that follows a gain of 1 has the same bits as one that follows nothing",
          "[drive][synth][follow]") {
  Burst burst = one_tone(20000, 0.3, 0.4);
  burst.tones.count = 3;
  burst.tones.tones[1] = {23000, 0.2, 0, 0};
  burst.tones.tones[2] = {25000, 0.2, 0, 1};
  burst.change_count = 1;
  burst.changes[0] = {30000, 9600, one_tone(21000, 0.4).tones};
  burst.marker.kind = MarkerKind::tone;
  burst.marker.amplitude = 0.1;
  burst.noise.rms = 0.01;
  const auto samples_of = [&](double gain, bool follows) {
    Burst made = burst;
    if (follows) made.following = {1, 1, 960, 480, 1920};
    Synth synth(format);
    auto prepared = prepare(made, format);
    prepared.id = 1;
    REQUIRE(synth.start(prepared));
    std::vector<std::int32_t> out(2 * static_cast<std::size_t>(burst.length_frames));
    for (std::int64_t frame = 0; frame < burst.length_frames; frame += kPeriod) {
      synth.follow(period_of([&](auto) { return gain; }, frame, 1));
      synth.render(frame, std::span(out).subspan(2 * static_cast<std::size_t>(frame), 2 * kPeriod));
    }
    return out;
  };
  const auto plain = samples_of(1, false);
  CHECK(samples_of(1, true) == plain);
  CHECK(samples_of(0.999999, true) != plain);  // negative control
}

TEST_CASE("a burst is multiplied by the straight lines through the gains, whatever the blocks are",
          "[drive][synth][follow]") {
  Burst burst = steady_tone();
  burst.start_frame = 1000;
  burst.following = following();
  // the first period begins before the burst, and periods do not begin where blocks do
  const std::int64_t first = 1000 - 41;
  const auto found = rendered(burst, wave, always, first);
  CHECK(found.lost.empty());
  double worst = 0, off_by_one = 0;
  for (std::int64_t frame = 1000; frame < 1000 + burst.length_frames; ++frame) {
    const double tone =
        0.5 * std::sin(2 * std::numbers::pi * 30000 * static_cast<double>(frame - 1000) / 192000 + 0.3);
    const double sample = found.samples[static_cast<std::size_t>(frame)];
    worst = std::max(worst, std::abs(sample - tone * polygon(wave, first, frame)));
    off_by_one = std::max(off_by_one, std::abs(sample - tone * polygon(wave, first, frame + 1)));
  }
  CHECK(worst < 1e-10);      // the phase of the sine of this test
  CHECK(off_by_one > 1e-4);  // negative control: a gain that is one frame early is noticed
}

TEST_CASE("a gain that swings puts lines beside the tone, and nothing else", "[drive][synth][follow]") {
  Burst burst = steady_tone(30000, 0.5);
  burst.length_frames = 3 * 65536;
  burst.following = following();
  // 750 Hz is 16 gains in a cycle, on a bin of the transform of 65536 frames
  const auto swing = [](std::int64_t n) { return 0.8 + 0.2 * std::sin(2 * std::numbers::pi * n / 256.0); };
  const auto found = rendered(burst, swing, always);
  const std::vector<double> part(found.samples.begin() + 65536, found.samples.begin() + 2 * 65536);
  const auto levels = levels_dB(part);
  const std::size_t tone = 30000 * 65536 / 192000, line = 750 * 65536 / 192000;
  CHECK(levels[tone] == Approx(20 * std::log10(0.5 * 0.8)).margin(0.01));
  // Straight lines between 256/12 gains in a cycle lower the swing by sinc^2 of 12/256 (0.06 dB).
  for (const std::size_t side : {tone - line, tone + line})
    CHECK(levels[side] == Approx(20 * std::log10(0.5 * 0.1)).margin(0.1));
  // what the corners leave behind is at the distance of the gains, 16 kHz
  CHECK(levels[tone + line / 2] < -100);
}

TEST_CASE(
    "the gain is limited in the synthesiser, whatever comes, and a gain that is not a number counts "
    "as missing",
    "[drive][synth][follow]") {
  Burst burst = steady_tone(48000, 0.5);
  burst.following = following();
  const auto wild = [](std::int64_t frame) {
    return frame < 24000 ? 1e6 : frame < 48000 ? -5.0 : std::numeric_limits<double>::quiet_NaN();
  };
  const auto found = rendered(burst, wild, always);
  double most = 0;
  for (const double sample : found.samples) most = std::max(most, std::abs(sample));
  CHECK(most <= 0.5 * kMost + 1e-12);
  CHECK(most > 0.45 * kMost);
  REQUIRE(found.lost.size() == 1);
  CHECK(std::abs(found.lost[0].frame - 48000) <= kPeriod);
  for (std::size_t n = 60000; n < 60100; ++n) CHECK(std::abs(found.samples[n]) <= 0.5 * kRest + 1e-12);
}

TEST_CASE("the peak of a burst that follows counts its largest gain", "[drive][synth][follow]") {
  Burst burst = steady_tone(30000, 0.4);
  burst.following = following();
  CHECK(prepare(burst, format).peak[0] == Approx(0.4 * kMost));
  burst.tones.tones[0].amplitude = 0.7;  // 1.05 at the largest gain
  CHECK_THROWS_AS(prepare(burst, format), BurstRefused);
  burst.following.most_gain = 1;
  CHECK(prepare(burst, format).peak[0] == Approx(0.7));
  burst.following.resting_gain = 0.2;
  auto playing = prepare(burst, format);
  Change change;
  change.to = burst.tones;
  CHECK_THROWS_AS(prepare_change(change, playing, format), BurstRefused);  // it keeps its tones
  burst.following = {};
  CHECK(prepare(burst, format).peak[0] == Approx(0.7));
  playing = prepare(burst, format);
  CHECK_NOTHROW(prepare_change(change, playing, format));
  for (const Following wrong : {Following{-1, 0, 1, 1, 1}, Following{1, 1.1, 1, 1, 1},
                                Following{1, 0, 0, 1, 1}, Following{std::nan(""), 0, 1, 1, 1}}) {
    burst.following = wrong;
    CHECK_THROWS_AS(prepare(burst, format), BurstRefused);
  }
}

TEST_CASE("if gains are missing, the gain is at rest within the ramp, and it never jumps",
          "[drive][synth][follow]") {
  const auto missing = GENERATE(1, 3, 40, 1000);
  CAPTURE(missing);
  Burst burst = steady_tone(48000, 0.5);  // sin(pi/2 n + 0.3): every second pair of frames gives the gain
  burst.following = following();
  const std::int64_t from = 200 * kPeriod, to = from + missing * kPeriod;
  const auto found = rendered(burst, wave, [&](std::int64_t frame) { return frame < from || frame >= to; });
  REQUIRE(found.lost.size() == 1);
  CHECK(found.lost[0].frame == from);
  CHECK(found.lost[0].burst == 7);
  const bool returns = std::max(from + 960, to + 480) + 1920 < burst.length_frames;
  REQUIRE(found.back.size() == (returns ? 1 : 0));
  if (returns) CHECK(std::abs(found.back[0].frame - (std::max(from + 960, to + 480) + 1920)) <= 1);
  // the amplitude, from two frames that are a quarter of a cycle apart
  std::vector<double> gain;
  for (std::size_t n = 0; n + 1 < found.samples.size(); ++n)
    gain.push_back(std::hypot(found.samples[n], found.samples[n + 1]) / 0.5);
  const auto at = [&](std::int64_t frame) { return gain[static_cast<std::size_t>(frame)]; };
  CHECK(at(from - 10) == Approx(polygon(wave, 0, from - 10)).margin(0.005));
  for (std::int64_t frame = from; frame < from + 950; ++frame) {  // a straight line
    const double line = at(from - 1) + (kRest - at(from - 1)) * static_cast<double>(frame - from) / 960;
    CHECK(std::abs(at(frame) - line) < 0.01);
  }
  const auto back = std::max(from + 960, to + 480);
  for (std::int64_t frame = from + 961; frame < std::min(back - 1, burst.length_frames - 2); ++frame)
    CHECK(std::abs(at(frame) - kRest) < 1e-9);
  if (back + 1920 < burst.length_frames)
    for (std::int64_t frame = back + 1930; frame < burst.length_frames - 10; frame += 7)
      CHECK(at(frame) == Approx(polygon(wave, 0, frame)).margin(0.005));
  for (std::size_t n = 13; n + 1 < gain.size(); ++n) {  // the first gain begins at rest
    INFO(n);
    CHECK(std::abs(gain[n] - gain[n - 1]) < 0.006);  // the wave and the way back, 0.0015 a frame each
  }
}

TEST_CASE("after lost frames the gains are those of the frames that are played", "[drive][synth][follow]") {
  Burst burst = steady_tone();
  burst.ramp.frames = 300;
  burst.following = following();
  const std::int64_t from = 100 * kPeriod, to = 117 * kPeriod + 5;
  const auto found = rendered(burst, wave, always, 0, from, to);
  CHECK(found.lost.empty());
  double worst = 0;
  for (std::int64_t frame = to + 300; frame < burst.length_frames - 400; ++frame)
    worst = std::max(
        worst,
        std::abs(found.samples[static_cast<std::size_t>(frame)] -
                 0.5 *
                     std::sin(2 * std::numbers::pi * 30000.0 / 192000.0 * static_cast<double>(frame) + 0.3) *
                     polygon(wave, 0, frame)));
  CHECK(worst < 1e-10);
}

TEST_CASE("gains of another burst, and gains that come out of order, change nothing",
          "[drive][synth][follow]") {
  GainLine line;
  line.begin(following());
  const auto one = [](std::int64_t) { return 1.0; };
  line.push(period_of(one, 96));
  line.push(period_of(wave, 0));   // older
  line.push(period_of(wave, 96));  // the same again
  GainPeriod odd = period_of(wave, 192);
  odd.frames = 100;  // not a multiple of 8
  line.push(odd);
  std::array<double, 192> gain{};
  line.fill(0, 96, gain.data());
  CHECK(line.take_news().lost == 0);  // nothing has come for these frames
  CHECK(std::all_of(gain.begin(), gain.begin() + 96, [](double g) { return g == kRest; }));
  // A ring that is full takes no more; what is in it stays right.
  line.begin(following());
  for (int k = 0; k < 100; ++k) line.push(period_of(one, 96 * k));
  line.fill(0, 96, gain.data());
  CHECK_FALSE(line.take_news().lost);
  CHECK(gain[95] == 1);
}

TEST_CASE("a real-time stream takes gains from another thread, and goes to rest when they stop",
          "[drive][realtime][threads][follow]") {
  StreamConfig config;
  config.output.period_frames = 96;
  config.output.periods = 8;
  const auto stream = open_realtime(config);
  Burst burst = one_tone(30000, 0.5);
  burst.following = following();
  burst.start_frame = stream->earliest_frame() + 19200;
  const auto id = stream->schedule(burst);
  const std::int64_t first = burst.start_frame - 50, end = burst.start_frame + 30000;
  std::jthread gives([&] {
    // far ahead, because the machine of the test may be busy
    for (std::int64_t frame = first; frame < end;) {
      if (stream->counters().frames + 20 * kPeriod > frame && stream->follow(period_of(wave, frame, id)))
        frame += kPeriod;
      else
        turnpoint::system::sleep_until_ns(turnpoint::system::monotonic_ns() + 200'000);
    }
  });
  std::vector<Event> lost;
  for (bool ended = false; !ended;) {
    turnpoint::system::sleep_until_ns(turnpoint::system::monotonic_ns() + 1'000'000);
    while (const auto event = stream->poll()) {
      if (event->kind == EventKind::burst_unfollowed) lost.push_back(*event);
      ended |= event->kind == EventKind::burst_ended;
    }
  }
  // On a busy machine gains may also be late earlier; they must be missing where none were given.
  REQUIRE_FALSE(lost.empty());
  CHECK(lost.back().burst == id);
  CHECK(lost.back().frame <= first + ((end - first + kPeriod - 1) / kPeriod) * kPeriod);
  CHECK(stream->counters().saturated == 0);
}
