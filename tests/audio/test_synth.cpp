#include <cmath>
#include <numbers>
#include <random>

#include "station/audio/oscillator.hpp"
#include "station/audio/sine.hpp"
#include "station/audio/synth.hpp"
#include "station/core/instruction_sets.hpp"
#include "tests/audio/bursts.hpp"
#include "tests/audio/spectrum.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::audio;

// The oscillator's loops for every processor, to compare them with those that this machine chooses.
namespace turnpoint::plain {
using audio::Partial;
}
#undef TURNPOINT_CLONES
#define TURNPOINT_CLONES
#define audio plain
#include "station/audio/oscillator.cpp"  // NOLINT(bugprone-suspicious-include)
#undef audio
namespace plain = turnpoint::plain;

namespace {

constexpr int rate = 192000;

// Renders `frames` frames from frame `from` on, in blocks of `block` frames, and returns channel 0.
std::vector<double> rendered(Synth& synth, std::int64_t from, std::size_t frames, std::size_t block = 384) {
  std::vector<double> out, samples;
  for (std::size_t done = 0; done < frames; done += block) {
    samples.assign(2 * std::min(block, frames - done), 0);
    synth.render(from + static_cast<std::int64_t>(done), std::span<double>(samples));
    for (std::size_t k = 0; k < samples.size(); k += 2) out.push_back(samples[k]);
  }
  return out;
}

std::vector<std::int32_t> quantised(Synth& synth, std::int64_t from, std::size_t frames, std::size_t block) {
  std::vector<std::int32_t> out(2 * frames);
  for (std::size_t done = 0; done < frames; done += block)
    synth.render(from + static_cast<std::int64_t>(done),
                 std::span(out).subspan(2 * done, 2 * std::min(block, frames - done)));
  return out;
}

std::vector<double> rendered(const Burst& burst) {
  Synth synth({rate, 2, 24});
  REQUIRE(synth.start(prepare(burst, {rate, 2, 24})));
  return rendered(synth, 0, static_cast<std::size_t>(burst.start_frame + burst.length_frames));
}

// A long burst of eight tones. Spectra are computed from the middle of it.
Burst eight_tones() {
  Burst burst;
  burst.length_frames = 300000;
  burst.tones.count = 8;
  for (int i = 0; i < 8; ++i)
    burst.tones.tones[static_cast<std::size_t>(i)] = {22512.3 + 1051.7 * i, 0.115, 0.7 * i * i, 0};
  return burst;
}

std::vector<std::size_t> bins_of(const Burst& burst, std::size_t size) {
  std::vector<std::size_t> bins;
  for (int i = 0; i < burst.tones.count; ++i)
    bins.push_back(static_cast<std::size_t>(std::llround(
        burst.tones.tones[static_cast<std::size_t>(i)].frequency_Hz * static_cast<double>(size) / rate)));
  return bins;
}

double spurious_dB(const std::vector<double>& samples, const Burst& burst) {
  const std::vector<double> middle(samples.begin() + 20000, samples.begin() + 20000 + (1 << 18));
  return largest_elsewhere_dB(levels_dB(middle), bins_of(burst, middle.size()), 24);
}

}  // namespace

TEST_CASE("eight tones in double have no spurious product above -200 dB", "[drive][synth]") {
  const Burst burst = eight_tones();
  CHECK(spurious_dB(rendered(burst), burst) < -200);
}

TEST_CASE("the measurement of spurious products detects one at -160 dB", "[drive][synth]") {
  const Burst burst = eight_tones();
  auto samples = rendered(burst);
  for (std::size_t n = 0; n < samples.size(); ++n)
    samples[n] += 1e-8 * std::sin(0.5 * static_cast<double>(n));
  CHECK(spurious_dB(samples, burst) > -170);
}

TEST_CASE("at 24 bits with dither no spurious product is above -140 dB", "[drive][synth]") {
  const Burst burst = eight_tones();
  Synth synth({rate, 2, 24});
  REQUIRE(synth.start(prepare(burst, {rate, 2, 24})));
  const auto samples = quantised(synth, 0, 300000, 384);
  std::vector<double> left;
  for (std::size_t k = 0; k < samples.size(); k += 2) {
    REQUIRE((samples[k] & 0xff) == 0);
    left.push_back(samples[k] * 0x1p-31);
  }
  CHECK(spurious_dB(left, burst) < -140);
  CHECK(synth.saturated() == 0);
}

TEST_CASE("a burst of the largest allowed peak never reaches full scale, whatever the converter's depth",
          "[drive][synth]") {
  const int bits = GENERATE(8, 16, 20, 24, 32);
  const Format format{rate, 2, bits};
  // a quarter of the sample rate, so that every other sample lies on a maximum
  Burst burst = one_tone(rate / 4, largest_peak(format, {}), std::numbers::pi / 2);
  Synth synth(format);
  REQUIRE(synth.start(prepare(burst, format)));
  quantised(synth, 0, 96000, 384);
  CHECK(synth.saturated() == 0);
  burst.tones.tones[0].amplitude = 1.0001 * largest_peak(format, {});
  CHECK_THROWS_AS(prepare(burst, format), BurstRefused);
}

TEST_CASE("loops for special processors give the same bits as the loop for all", "[drive][synth]") {
  const Partial partial{0x123456789abcdef0, phase_increment(22512.3, rate), 0xfffffffff0001234, 0.115, -0.05};
  constexpr int frames = 1003;
  std::vector<double> shape(frames), chosen(frames, 0.25), all(frames, 0.25);
  for (std::size_t n = 0; n < frames; ++n) shape[n] = static_cast<double>(n) / frames;
  add_steady(chosen.data(), frames, partial);
  plain::add_steady(all.data(), frames, partial);
  add_gliding(chosen.data(), frames - 2, partial, shape.data());
  plain::add_gliding(all.data(), frames - 2, partial, shape.data());
  CHECK(chosen == all);
}

TEST_CASE("samples do not depend on how the stream is divided into blocks", "[drive][synth]") {
  Burst burst = one_tone(20000.5, 0.5);
  burst.start_frame = 1001;
  burst.change_count = 1;
  burst.changes[0] = {30011, 7777, one_tone(23000, 0.25).tones};
  burst.marker = {MarkerKind::pulse, 1, 0.5, 0, 200};
  const auto run = [&](std::size_t block) {
    Synth synth({rate, 2, 24});
    REQUIRE(synth.start(prepare(burst, {rate, 2, 24})));
    return quantised(synth, 0, 100000, block);
  };
  const auto reference = run(384);
  CHECK(reference == run(1));
  CHECK(reference == run(512));
  CHECK(reference == run(97));
}

TEST_CASE("the phase is exact after ten days", "[drive][synth]") {
  // 10 days at 192 kHz are 165 888 000 000 frames. In this time a tone of 20 kHz makes a whole number of
  // cycles, so its phase must be exact to the last bit.
  Burst burst = one_tone(20000, 0.5, 1.0);
  Synth late({rate, 2, 24});
  burst.length_frames = 170'000'000'000;
  SynthLimits limits;
  limits.longest_frames = burst.length_frames;
  REQUIRE(late.start(prepare(burst, {rate, 2, 24}, limits)));
  const auto early = rendered(late, 0, 14400);
  const auto after = rendered(late, 165'888'000'000, 14400);
  double worst = 0;
  for (std::size_t k = 9600; k < 14400; ++k) worst = std::max(worst, std::abs(after[k] - early[k]));
  CHECK(worst < 1e-7);
}

TEST_CASE("a frequency glide keeps the phase continuous and ends on the target", "[drive][synth]") {
  Burst burst = one_tone(20000, 0.5);
  burst.change_count = 1;
  burst.changes[0] = {40000, 9600, one_tone(21000, 0.5).tones};
  const auto samples = rendered(burst);
  // The second difference of a sinusoid in this band is at most its amplitude times (2 pi f / rate)^2.
  const double bound = 0.5 * std::pow(2 * M_PI * 21000.0 / rate, 2) * 1.001;
  double largest = 0;
  for (std::size_t k = 20001; k + 1 < 80000; ++k)
    largest = std::max(largest, std::abs(samples[k + 1] - 2 * samples[k] + samples[k - 1]));
  CHECK(largest < bound);
  // After the glide the tone is exactly 21 kHz, so 192 frames are 21 cycles.
  for (std::size_t k = 50000; k < 60000; ++k) REQUIRE(samples[k + 192] == Approx(samples[k]).margin(1e-9));
}

TEST_CASE(
    "an amplitude glide reaches its target, and a tone that is in only one of the two sets fades in or out",
    "[drive][synth]") {
  Burst burst = one_tone(24000, 0.5);
  burst.change_count = 1;
  burst.changes[0].at_frame = 40000;
  burst.changes[0].to.count = 2;
  burst.changes[0].to.tones[0] = {24000, 0.25, 0, 0};
  burst.changes[0].to.tones[1] = {48000, 0.125, 0, 1};
  Synth synth({rate, 2, 24});
  REQUIRE(synth.start(prepare(burst, {rate, 2, 24})));
  std::vector<double> samples(2 * 96000);
  synth.render(0, std::span<double>(samples));
  double left = 0, right = 0, right_before = 0;
  for (std::size_t k = 0; k < 40000; ++k) right_before = std::max(right_before, std::abs(samples[2 * k + 1]));
  for (std::size_t k = 50000; k < 80000; ++k) {
    left = std::max(left, std::abs(samples[2 * k]));
    right = std::max(right, std::abs(samples[2 * k + 1]));
  }
  CHECK(right_before == 0);
  CHECK(left == Approx(0.25));
  CHECK(right == Approx(0.125));
}

TEST_CASE("a tone that comes only with the second change is silent until then, and keeps its frequency",
          "[drive][synth]") {
  Burst burst = one_tone(22000, 0.25);
  burst.length_frames = 120000;
  burst.change_count = 2;
  burst.changes[0] = {30000, 9600, one_tone(23000, 0.25).tones};
  burst.changes[1] = {60000, 9600, one_tone(23000, 0.25).tones};
  burst.changes[1].to.count = 2;
  burst.changes[1].to.tones[1] = {31000, 0.125, 0.5, 0};
  Burst from_onset = burst;
  for (auto* tones : {&from_onset.tones, &from_onset.changes[0].to}) {
    tones->count = 2;
    tones->tones[1] = {31000, 0, 0.5, 0};
  }
  CHECK((rendered(burst) == rendered(from_onset)));
}

TEST_CASE("a tone that a live change added keeps its frequency while a change of the burst fades it out",
          "[drive][synth]") {
  Burst burst = one_tone(22000, 0.25);
  burst.length_frames = 120000;
  burst.change_count = 1;
  burst.changes[0] = {60000, 9600, one_tone(22000, 0.25).tones};
  Change live{30000, 960, one_tone(22000, 0.25).tones};
  live.to.count = 2;
  live.to.tones[1] = {31000, 0.125, 0.5, 1};
  const Format format{rate, 2, 24};
  PreparedBurst prepared = prepare(burst, format);
  Synth synth(format);
  REQUIRE(synth.start(prepared));
  std::vector<double> samples(2 * 120000);
  synth.render(0, std::span<double>(samples).first(2 * 20000));
  REQUIRE(synth.change(prepared.id, prepare_change(live, prepared, format)));
  synth.render(20000, std::span<double>(samples).subspan(2 * 20000));
  // The second difference of a sinusoid is -(2 sin(pi f / rate))^2 times the sinusoid, whatever its
  // amplitude, except for what a slow change of the amplitude adds.
  const double squared = std::pow(2 * std::sin(M_PI * 31000.0 / rate), 2);
  double largest = 0, faded = 0;
  for (std::size_t k = 60001; k + 1 < 120000; ++k) {
    const double y = samples[2 * k + 1];
    largest = std::max(largest, std::abs(samples[2 * k + 3] - 2 * y + samples[2 * k - 1] + squared * y));
    if (k > 69600) faded = std::max(faded, std::abs(y));
  }
  CHECK(largest < 1e-3 * 0.125);
  CHECK(faded == 0);
}

TEST_CASE("a burst starts and ends exactly at its frames, and all samples before and after it are zero",
          "[drive][synth]") {
  Burst burst = one_tone(20000, 0.5, M_PI / 2);
  burst.start_frame = 777;
  Synth synth({rate, 2, 24});
  REQUIRE(synth.start(prepare(burst, {rate, 2, 24})));
  const auto samples = quantised(synth, 0, 100000, 500);
  for (std::size_t k = 0; k < 2 * 777; ++k) REQUIRE(samples[k] == 0);
  for (std::size_t k = 2 * (777 + 96000); k < samples.size(); ++k) REQUIRE(samples[k] == 0);
  for (std::size_t k = 1; k < samples.size(); k += 2) REQUIRE(samples[k] == 0);  // channel 1 is silent
  REQUIRE(synth.events().size() == 2);
  CHECK(synth.events()[0].kind == SynthEventKind::started);
  CHECK(synth.events()[0].frame == 777);
  CHECK(synth.events()[1].kind == SynthEventKind::ended);
  CHECK(synth.events()[1].frame == 777 + 96000);
}

TEST_CASE("a stop ramps the sound down, and after lost frames the sound ramps up again", "[drive][synth]") {
  Synth synth({rate, 2, 24});
  REQUIRE(synth.start(prepare(one_tone(20000, 0.5), {rate, 2, 24})));
  auto before = rendered(synth, 0, 30000);
  SECTION("a stop") {
    synth.stop(0, 0, {4800});
    const auto after = rendered(synth, 30000, 10000);
    CHECK(after[4799] == Approx(0).margin(1e-6));
    for (std::size_t k = 4800; k < 10000; ++k) REQUIRE(after[k] == 0);
    CHECK(std::abs(after[0] - before.back()) < 0.5 * 2 * M_PI * 20000 / rate);
    CHECK(synth.events().back().frame == 34800);
  }
  SECTION("lost frames") {
    const auto after = rendered(synth, 40000, 20000);
    CHECK(std::abs(after[0]) < 1e-6);
    Synth whole({rate, 2, 24});
    REQUIRE(whole.start(prepare(one_tone(20000, 0.5), {rate, 2, 24})));
    const auto reference = rendered(whole, 0, 60000);
    for (std::size_t k = 9600; k < 20000; ++k) REQUIRE(after[k] == reference[40000 + k]);
  }
}

TEST_CASE("successive stops continue from the current gain, and each can only bring the end forward",
          "[drive][synth]") {
  Synth synth({rate, 1, 24});
  // the magnitude of every sample is 1/2
  Burst burst = one_tone(rate / 4.0, 1 / std::sqrt(0.5) / 2, M_PI / 4);
  REQUIRE(synth.start(prepare(burst, {rate, 1, 24})));
  std::vector<double> samples;
  const auto render = [&](std::size_t frames) {
    std::vector<double> block(frames);
    synth.render(static_cast<std::int64_t>(samples.size()), std::span<double>(block));
    samples.insert(samples.end(), block.begin(), block.end());
  };
  render(20'000);
  synth.stop(0, 0, {38'400});
  render(14'000);
  synth.stop(0, 0, {9'600});
  render(2'000);
  synth.stop(0, 36'500,
             {1'000});         // this stop takes effect at frame 36 500; until then the earlier stops go on
  synth.stop(0, 0, {48'000});  // this stop would end later than the others, so it changes nothing
  render(4'000);
  double largest_step = 0;
  for (std::size_t k = 20'000; k < samples.size(); ++k) {
    const double rise = 2 * (std::abs(samples[k]) - std::abs(samples[k - 1]));
    REQUIRE(rise < 1e-9);
    largest_step = std::max(largest_step, -rise);
  }
  CHECK(largest_step < 3.0 / 1'000);
  CHECK(samples[37'498] != 0);
  for (std::size_t k = 37'500; k < samples.size(); ++k) REQUIRE(samples[k] == 0);
  CHECK(synth.events().back().frame == 37'500);
}

TEST_CASE("masking noise has the requested band and rms", "[drive][synth]") {
  Burst burst;
  burst.length_frames = 400000;
  burst.noise = {1, 0.05, 300, 6000, 42};
  Synth synth({rate, 2, 24});
  REQUIRE(synth.start(prepare(burst, {rate, 2, 24})));
  std::vector<double> samples(2 * 400000);
  synth.render(0, std::span<double>(samples));
  double square = 0;
  std::vector<double> noise;
  for (std::size_t k = 50000; k < 50000 + (1 << 18); ++k) {
    square += samples[2 * k + 1] * samples[2 * k + 1];
    noise.push_back(samples[2 * k + 1]);
  }
  CHECK(std::sqrt(square / (1 << 18)) == Approx(0.05).epsilon(0.03));
  const auto power = [levels = levels_dB(noise)](double from_Hz, double to_Hz) {
    double sum = 0;
    const auto first = static_cast<std::size_t>(from_Hz * (1 << 18) / rate);
    const auto last = static_cast<std::size_t>(to_Hz * (1 << 18) / rate);
    for (std::size_t k = first; k < last; ++k) sum += std::pow(10, levels[k] / 10);
    return 10 * std::log10(sum / static_cast<double>(last - first));
  };
  CHECK(power(1000, 2000) - power(20000, 25000) > 18);
  CHECK(power(1000, 2000) - power(20, 50) > 25);
}
