#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "station/audio/synth.hpp"
#include "station/audio/trigger_code.hpp"
#include "station/sensing/trigger_decoder.hpp"
#include "tests/sensing/room.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;

namespace {

constexpr int rate = 192000;
constexpr std::int64_t bit = 192;  // number of frames in a bit of 1 ms
constexpr double pi = 3.14159265358979323846;

/// The distortions of a line through which a code passes before it is captured.
struct Line {
  double gain = 1;
  double high_pass_Hz = 0;  // cut-off of a first-order high-pass filter; 0: no filter
  double low_pass_Hz = 0;   // cut-off of a first-order low-pass filter; 0: no filter
  double ripple_dB = 0;     // gain above 2 kHz relative to the gain below 2 kHz
  double noise = 0;         // rms of the added noise
  double offset = 0;        // fraction of a frame (0 to 1) by which sampling is late
  std::uint64_t seed = 1;
};

/// A first-order high-pass filter: the signal minus its low-passed part.
class HighPass {
 public:
  explicit HighPass(double corner_Hz) : decay_(std::exp(-2 * pi * corner_Hz / rate)) {}
  double operator()(double value) {
    low_ = decay_ * low_ + (1 - decay_) * value;
    return value - low_;
  }

 private:
  double decay_, low_ = 0;
};

void through(std::vector<double>& wave, const Line& line) {
  HighPass high(line.high_pass_Hz), low(line.low_pass_Hz), shelf(2000);
  const double ripple = std::pow(10, line.ripple_dB / 20);
  std::mt19937_64 random(line.seed);
  std::normal_distribution<double> normal(0, 1);
  for (auto& value : wave) {
    if (line.high_pass_Hz > 0) value = high(value);
    if (line.low_pass_Hz > 0) value -= low(value);
    const double above = shelf(value);
    value = line.gain * (value - above + ripple * above) + line.noise * normal(random);
  }
}

/// Returns the wave of a code at a time in frames since its start, which need not be a whole number. It is
/// computed from the documentation and not from the program's pattern.
double ideal(std::uint8_t code, double frame) {
  if (frame < 0 || frame >= 14.0 * bit) return 0;
  const int check = [&] {
    int value = code * 16;
    for (int k = 7; k >= 0; --k)
      if (value & (16 << k)) value ^= 19 << k;
    return value;
  }();
  const auto slot = static_cast<int>(frame / bit);
  if (slot < 2) return slot == 0 ? 1 : -1;
  const bool one = (code * 16 + check) >> (13 - slot) & 1;
  return (frame - slot * static_cast<double>(bit) < bit / 2.0) == one ? 1 : -1;
}

std::vector<DecodedTrigger> decoded(const std::vector<double>& wave, std::int64_t bit_frames = bit) {
  std::vector<std::int32_t> samples;
  for (const double value : wave) samples.push_back(converted(value));
  TriggerDecoder decoder(0, bit_frames);
  for (std::size_t k = 0; k < samples.size(); k += 1000)
    decoder.push({std::span(samples).subspan(k, std::min<std::size_t>(1000, samples.size() - k)), 1,
                  static_cast<std::int64_t>(k), rate});
  return decoder.take();
}

constexpr std::int64_t begins = 1000, apart = 20 * bit;

std::vector<double> all_codes(double offset) {
  std::vector<double> wave(static_cast<std::size_t>(2 * begins + 255 * apart));
  for (int code = 1; code <= 255; ++code)
    for (std::int64_t n = 0; n <= 14 * bit; ++n)
      wave[static_cast<std::size_t>(begins + (code - 1) * apart + n)] +=
          0.5 * ideal(static_cast<std::uint8_t>(code), static_cast<double>(n) - offset);
  return wave;
}

/// Sends all codes through the line, one after the other. Returns how many were found at most `tolerance`
/// frames from where they were sent, or -1 if other codes were found.
int found_of_255(const Line& line, double tolerance) {
  auto wave = all_codes(line.offset);
  through(wave, line);
  int right = 0;
  for (const auto& trigger : decoded(wave)) {
    const double place = begins + static_cast<double>((trigger.code - 1) * apart) + line.offset;
    if (std::abs(trigger.frame - place) > tolerance) return -1;
    ++right;
  }
  return right;
}

}  // namespace

TEST_CASE("every code is found on a clean line, at its frame", "[sensing][trigger]") {
  CHECK(found_of_255({}, 0.01) == 255);
}

TEST_CASE("a code is found at any sampling offset", "[sensing][trigger]") {
  for (const double offset : {0.1, 0.25, 0.5, 0.75, 0.9}) {
    Line line;
    line.offset = offset;
    CHECK(found_of_255(line, 1) == 255);
  }
}

TEST_CASE("a code is found behind a line output: high-passed, with a ripple of 1 dB", "[sensing][trigger]") {
  for (const double high_pass_Hz : {2.0, 20.0, 60.0})
    for (const double ripple_dB : {-1.0, 1.0}) {
      Line line;
      line.high_pass_Hz = high_pass_Hz;
      line.low_pass_Hz = 20e3;
      line.ripple_dB = ripple_dB;
      CHECK(found_of_255(line, 3) == 255);
    }
}

TEST_CASE("a code is found in noise 10 dB below it, and at 0.05 of full scale", "[sensing][trigger]") {
  Line line;
  line.noise = 0.158 * 0.5;
  CHECK(found_of_255(line, 8) == 255);
  line.noise = 0.316 * 0.5;
  line.high_pass_Hz = 20;
  CHECK(found_of_255(line, 16) == 255);
  Line quiet;
  quiet.gain = 0.1;
  CHECK(found_of_255(quiet, 0.01) == 255);
}

TEST_CASE("the drive plays the codes that its documentation describes, at the frames of the events",
          "[sensing][trigger]") {
  audio::Burst burst;
  burst.start_frame = 1234;
  burst.length_frames = 40000;
  burst.change_count = 2;
  burst.changes[0].at_frame = 8001, burst.changes[1].at_frame = 20003;
  burst.changes[0].frames = burst.changes[1].frames = 10;
  burst.marker = {audio::MarkerKind::code, 1, 0.5, 0, bit, {17, 0, 255}};
  audio::Synth synth({rate, 2, 24});
  REQUIRE(synth.start(audio::prepare(burst, {rate, 2, 24})));
  std::vector<double> marker(50000);
  for (std::size_t k = 0; k + 500 <= marker.size(); k += 500) {
    std::vector<double> block(1000);
    synth.render(static_cast<std::int64_t>(k), std::span<double>(block));
    for (std::size_t n = 0; n < 500; ++n) marker[k + n] = block[2 * n + 1];
  }
  std::vector<double> wanted(marker.size());
  for (std::int64_t n = 0; n < 14 * bit; ++n) {
    wanted[static_cast<std::size_t>(1234 + n)] = 0.5 * ideal(17, static_cast<double>(n));
    wanted[static_cast<std::size_t>(1234 + 20003 + n)] = 0.5 * ideal(255, static_cast<double>(n));
  }
  CHECK(marker == wanted);
  const auto found = decoded(marker);
  REQUIRE(found.size() == 2);
  CHECK(found[0].code == 17);
  CHECK(found[0].frame == Approx(1234).margin(0.01));
  CHECK(found[0].amplitude == Approx(0.5).margin(1e-3));
  CHECK(found[1].code == 255);
  CHECK(found[1].frame == Approx(1234 + 20003).margin(0.01));
}

TEST_CASE("codes that would run into each other or past the burst are refused", "[sensing][trigger]") {
  audio::Burst burst;
  burst.length_frames = 20000;
  burst.change_count = 1;
  burst.changes[0].at_frame = 15 * bit;
  burst.changes[0].frames = 10;
  burst.marker = {audio::MarkerKind::code, 1, 0.5, 0, bit, {1, 2}};
  CHECK_NOTHROW(audio::prepare(burst, {rate, 2, 24}));
  burst.changes[0].at_frame = 15 * bit - 1;
  CHECK_THROWS_AS(audio::prepare(burst, {rate, 2, 24}), audio::BurstRefused);
  burst.marker.codes = {0, 2};
  CHECK_NOTHROW(audio::prepare(burst, {rate, 2, 24}));
  burst.changes[0].at_frame = 20000 - 14 * bit + 1;
  CHECK_THROWS_AS(audio::prepare(burst, {rate, 2, 24}), audio::BurstRefused);
}

TEST_CASE("a code with a wrong bit is not found", "[sensing][trigger]") {
  int wrong = 0;
  for (int slot = 2; slot < 14; ++slot) {
    auto wave = all_codes(0);
    for (int code = 1; code <= 255; ++code)
      for (std::int64_t n = 0; n < bit; ++n)
        wave[static_cast<std::size_t>(begins + (code - 1) * apart + slot * bit + n)] *= -1;
    wrong += static_cast<int>(decoded(wave).size());
  }
  CHECK(wrong == 0);
}

// The waves are white noise, noise that is low-passed at the rate of the half bits, and random telegraph
// waves on the grid of the half bits. Bits of 8 frames make 50 s equivalent to 20 minutes with bits of 1 ms.
// The form of a code alone would find 44 codes in these waves. Because a code must also stand between two
// silent bits, none is found.
TEST_CASE("random waves give no code in an hour", "[sensing][trigger]") {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, 0.3);
  HighPass low(24000);
  std::size_t found = 0;
  for (const int kind : {0, 1, 2}) {
    std::vector<double> wave(50 * rate);
    for (std::size_t n = 0; n < wave.size(); ++n) {
      const double white = normal(random);
      wave[n] = kind == 0 ? white : 2 * (white - low(white));
      if (kind == 2) wave[n] = n % 4 != 0 ? wave[n - 1] : random() & 1 ? 0.4 : -0.4;
    }
    found += decoded(wave, 8).size();
  }
  CHECK(found == 0);
}

TEST_CASE("a gap in the capture costs only the code that it hits", "[sensing][trigger]") {
  auto wave = all_codes(0);
  std::vector<std::int32_t> samples;
  for (const double value : wave) samples.push_back(converted(value));
  TriggerDecoder decoder(0, bit);
  const auto cut = static_cast<std::size_t>(begins + 10 * apart + 5 * bit);
  decoder.push({std::span(samples).first(cut), 1, 0, rate});
  decoder.push({std::span(samples).subspan(cut + 10), 1, static_cast<std::int64_t>(cut) + 10, rate});
  const auto found = decoder.take();
  CHECK(found.size() == 254);
  CHECK(std::none_of(found.begin(), found.end(), [](const auto& trigger) { return trigger.code == 11; }));
}

TEST_CASE("edges of pulses are found once, at their frames", "[sensing][trigger]") {
  std::vector<std::int32_t> samples(20000);
  for (std::size_t n = 0; n < samples.size(); ++n)
    samples[n] = converted(n % 5000 >= 1000 && n % 5000 < 1300 ? (n % 2 ? 0.6 : 0.4) : 0.01);
  EdgeFinder edges(0, 0.5);
  CHECK(edges.push({samples, 1, 100, rate}) == std::vector<std::int64_t>{1101, 6101, 11101, 16101});
}
