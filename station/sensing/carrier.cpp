#include "station/sensing/carrier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "station/audio/sine.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::sensing {
namespace {

// number of outputs after which the kept frames are moved to the front of their buffer
constexpr std::size_t kSpareOutputs = 16;

}  // namespace

CarrierFilter::CarrierFilter(const std::vector<double>& taps, int factor, std::uint64_t increment,
                             const std::array<int, inputs>& channels, int stride)
    : half_(static_cast<std::int64_t>(taps.size() / 2)),
      factor_(factor),
      increment_(increment),
      channels_(channels),
      stride_(stride),
      kept_(taps.size() + kSpareOutputs * static_cast<std::size_t>(factor)),
      filled_(taps.size()) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::fill(kept_.begin(), kept_.end(), Quad{{nan, nan, nan, nan}});
  const double scale = 0x1p-30;  // 2 / 2^31: the factor 2 of the filter, and the full scale of a sample
  for (std::int64_t n = 0; n <= half_; ++n) {
    const double tap = scale * taps[static_cast<std::size_t>(half_ + n)] * (n == 0 ? 0.5 : 1);
    const std::uint64_t phase = increment * static_cast<std::uint64_t>(n);
    const auto even = static_cast<float>(tap * audio::sine_of_phase(phase + audio::quarter_cycle));
    const auto odd = static_cast<float>(tap * audio::sine_of_phase(phase));
    even_.push_back({{even, even, even, even}});
    odd_.push_back({{odd, odd, odd, odd}});
  }
}

std::int64_t CarrierFilter::take(std::int64_t first, const std::int32_t* frames,
                                 std::int64_t count) noexcept {
  // Output m is complete once it has the frame m * factor + half.
  const std::int64_t since = ((first - half_) % factor_ + factor_) % factor_;
  const std::int64_t needed = since == 0 ? 1 : factor_ - since + 1;
  const std::int64_t taken = std::min(count, needed);
  append(frames, taken);
  ready_ = taken == needed;
  if (ready_) finish(first + taken - 1 - half_);
  return taken;
}

void CarrierFilter::append(const std::int32_t* frames, std::int64_t count) noexcept {
  if (filled_ + static_cast<std::size_t>(count) > kept_.size()) {
    const auto kept = static_cast<std::size_t>(2 * half_);
    std::copy_n(kept_.data() + filled_ - kept, kept, kept_.data());
    filled_ = kept;
  }
  Quad* to = kept_.data() + filled_;
  filled_ += static_cast<std::size_t>(count);
  if (frames == nullptr) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::fill_n(to, count, Quad{{nan, nan, nan, nan}});
    return;
  }
  loops::pick_four(frames, count, channels_.data(), stride_, to->value);
}

void CarrierFilter::finish(std::int64_t centre) noexcept {
  // The processor works on the sines, each a long chain of operations, while it begins with the filter.
  const std::uint64_t phase = increment_ * static_cast<std::uint64_t>(centre);
  const double c = audio::sine_of_phase(phase + audio::quarter_cycle), s = audio::sine_of_phase(phase);
  const Quad* middle = kept_.data() + filled_ - 1 - half_;
  Quad re, im;
  loops::carrier(middle->value, half_, even_.front().value, odd_.front().value, re.value, im.value);
  for (std::size_t i = 0; i < inputs; ++i) {
    const double real = re.value[i], imaginary = -im.value[i];
    output_[i] = {real * c + imaginary * s, imaginary * c - real * s};
  }
  output_index_ = centre / factor_;
}

namespace {
// number of samples after which the kept ones are moved to the front of their buffer
constexpr std::size_t kSpareSamples = 128;
}  // namespace

std::vector<double> low_pass(double pass_Hz, double stop_Hz, double rate_Hz, double attenuation_dB) {
  const double transition = 2 * std::numbers::pi * (stop_Hz - pass_Hz) / rate_Hz;
  const double beta = 0.1102 * (attenuation_dB - 8.7);
  const int half = static_cast<int>(std::ceil((attenuation_dB - 7.95) / (2.285 * transition) / 2));
  const double cut_off = (pass_Hz + stop_Hz) / rate_Hz;  // as a fraction of half the sampling rate
  std::vector<double> taps;
  for (int k = -half; k <= half; ++k) {
    const double x = std::numbers::pi * cut_off * k, place = static_cast<double>(k) / (half + 1);
    taps.push_back((k == 0 ? 1 : std::sin(x) / x) *
                   std::cyl_bessel_i(0.0, beta * std::sqrt(1 - place * place)));
  }
  const double sum = std::accumulate(taps.begin(), taps.end(), 0.0);
  for (double& tap : taps) tap /= sum;
  return taps;
}

Decimator::Decimator(const std::vector<double>& taps, int factor)
    : half_taps_(taps.begin() + static_cast<std::ptrdiff_t>(taps.size() / 2), taps.end()),
      kept_(taps.size() + kSpareSamples),
      filled_(taps.size()),
      half_(static_cast<std::int64_t>(taps.size() / 2)),
      factor_(factor) {
  half_taps_.front() /= 2;  // the loop adds the sample in the middle twice
  for (Lanes& sample : kept_) sample.fill(std::numeric_limits<double>::quiet_NaN());
}

bool Decimator::push(std::int64_t index, const Lanes& sample) noexcept {
  if (filled_ == kept_.size()) {
    const auto kept = static_cast<std::size_t>(2 * half_);
    std::copy_n(kept_.end() - static_cast<std::ptrdiff_t>(kept), kept, kept_.begin());
    filled_ = kept;
  }
  kept_[filled_++] = sample;
  const std::int64_t centre = index - half_;
  if (centre % factor_ != 0) return false;
  output_index_ = centre / factor_;
  const Lanes& middle = kept_[filled_ - 1 - static_cast<std::size_t>(half_)];
  loops::eight(middle.data(), half_, half_taps_.data(), output_.data());
  return true;
}

namespace {

constexpr int middle_rate_Hz = 8000;
constexpr double attenuation_dB = 100;
constexpr double reference_tolerance = 0.03, quadrature_share = 0.05;
/// A bridge whose samples are equal for this long is silent. Its carrier is never exactly balanced, and even
/// the noise of a converter with 16 bits changes the last digit more often.
constexpr double silent_s = 0.002;
/// The longest block that a stuck driver is expected to repeat.
constexpr std::int64_t longest_block_frames = 4096;

/// The longest block whose repetition is looked for. The carrier alone, without any noise, repeats as well,
/// and must not count. If that leaves no block (0 or less), repetitions are not looked for.
std::int64_t longest_block(double carrier_Hz, std::int64_t rate_Hz) {
  const auto rate_mHz = 1000 * rate_Hz;
  const std::int64_t period = rate_mHz / std::gcd(rate_mHz, std::llround(1000 * carrier_Hz));
  return std::min(longest_block_frames, period - static_cast<std::int64_t>(silent_s * rate_Hz) - 1);
}

double pass_Hz(Band band) { return band == Band::force ? 400 : 1000; }
double stop_Hz(Band band) { return band == Band::force ? 600 : 2000; }

const BridgeOptions& checked(const BridgeOptions& options) {
  const auto fail = [](const std::string& what) { throw core::UsageError("strain-gauge bridges: " + what); };
  if (options.rate_Hz < 2 * middle_rate_Hz || options.rate_Hz % middle_rate_Hz != 0)
    fail(fmt::format("rate {} Hz is not a multiple of {} Hz", options.rate_Hz, middle_rate_Hz));
  if (!(options.carrier_Hz > 2 * stop_Hz(options.band) && options.carrier_Hz < 0.45 * options.rate_Hz))
    fail(fmt::format("carrier {} Hz is outside {} to {} Hz", options.carrier_Hz, 2 * stop_Hz(options.band),
                     0.45 * options.rate_Hz));
  const auto [first, last] = std::ranges::minmax(options.bridges);
  if (std::min(options.reference, first) < 0 || std::max(options.reference, last) >= options.channels)
    fail(fmt::format("a channel is not among the {} captured ones", options.channels));
  if (!(options.reference_amplitude > 0) || !(std::ranges::min(options.full_scale) > 0))
    fail("reference amplitude and full scale must be positive");
  return options;
}

}  // namespace

BridgeDemodulator::BridgeDemodulator(const BridgeOptions& options)
    : options_(checked(options)),
      // The first stage may let signals alias, but only to frequencies that the second stage stops.
      first_(low_pass(pass_Hz(options.band), middle_rate_Hz - stop_Hz(options.band), options.rate_Hz,
                      attenuation_dB),
             options.rate_Hz / middle_rate_Hz, audio::phase_increment(options.carrier_Hz, options.rate_Hz),
             {options.reference, options.bridges[0], options.bridges[1], options.bridges[2]},
             options.channels),
      second_(low_pass(pass_Hz(options.band), stop_Hz(options.band), middle_rate_Hz, attenuation_dB),
              middle_rate_Hz / points_per_second(options.band)) {
  for (std::size_t i = 0; i < bridge_count; ++i) {
    cos_[i] = std::cos(options_.rotation_rad[i]);
    sin_[i] = std::sin(options_.rotation_rad[i]);
  }
  longest_block_ = longest_block(options_.carrier_Hz, options_.rate_Hz);
  silent_until_.fill(std::numeric_limits<std::int64_t>::min());
  repeated_.assign(bridge_count,
                   Repeated(static_cast<std::size_t>(silent_s * options_.rate_Hz), longest_block_));
}

void BridgeDemodulator::check(const CaptureBlock& block) const {
  if (block.rate_Hz != options_.rate_Hz || block.channels != options_.channels)
    throw std::logic_error(fmt::format("captured block of {} channels at {} Hz, expected {} at {} Hz",
                                       block.channels, block.rate_Hz, options_.channels, options_.rate_Hz));
}

bool Repeated::add(std::int32_t value) noexcept {
  if (filled_ < kept_.size()) {
    kept_[filled_++] = value;
    age_ = 0, equal_ = 0;
    return false;
  }
  if (++age_ > longest_ + static_cast<std::int64_t>(kept_.size())) {
    reset();
    return false;
  }
  equal_ = value == kept_[equal_] ? equal_ + 1 : value == kept_[0] ? 1 : 0;
  if (equal_ < kept_.size()) return false;
  age_ = 0, equal_ = 0;
  return true;
}

bool BridgeDemodulator::add(const std::int32_t* frames, std::int64_t count) noexcept {
  const std::int64_t taken = first_.take(next_frame_, frames, count);
  watch(frames, taken);
  next_frame_ += taken;
  if (!first_.ready()) return false;
  Decimator::Lanes lanes;
  for (std::size_t i = 0; i < CarrierFilter::inputs; ++i) {
    lanes[2 * i] = first_.output()[i].real();
    lanes[2 * i + 1] = first_.output()[i].imag();
  }
  if (!second_.push(first_.output_index(), lanes)) return false;
  finish_point();
  return true;
}

/// Notes which bridges are silent in the next `count` frames.
void BridgeDemodulator::watch(const std::int32_t* frames, std::int64_t count) noexcept {
  const auto enough = static_cast<std::int64_t>(silent_s * options_.rate_Hz);
  for (std::size_t i = 0; i < bridge_count; ++i) {
    if (frames == nullptr) unchanged_[i].reset(), repeated_[i].reset();
    for (std::int64_t n = 0; frames != nullptr && n < count; ++n) {
      const auto value = frames[n * options_.channels + options_.bridges[i]];
      if (unchanged_[i].add(value) >= enough) silent_until_[i] = next_frame_ + n;
      // The next row that comes again ends at most one block later.
      if (longest_block_ > 0 && repeated_[i].add(value)) silent_until_[i] = next_frame_ + n + longest_block_;
    }
  }
}

void BridgeDemodulator::finish_point() noexcept {
  const Decimator::Lanes& z = second_.output();
  point_ = {.index = second_.output_index(), .reference = std::hypot(z[0], z[1])};
  const double square = z[0] * z[0] + z[1] * z[1];
  for (std::size_t i = 0; i < bridge_count; ++i) {
    const double real = z[2 * i + 2], imaginary = z[2 * i + 3];
    const double in = (real * z[0] + imaginary * z[1]) / square;
    const double across = (imaginary * z[0] - real * z[1]) / square;
    point_.ratio[i] = in * cos_[i] + across * sin_[i];
    point_.quadrature[i] = across * cos_[i] - in * sin_[i];
  }
  if (std::abs(point_.reference / options_.reference_amplitude - 1) > reference_tolerance) {
    point_.fault = WireFault::reference;
    point_.ratio.fill(std::numeric_limits<double>::quiet_NaN());
    point_.quadrature = point_.ratio;
    return;
  }
  // The point depends on frames as far before it as the newest frame is after it.
  const std::int64_t depends_from = 2 * point_.index * frames_per_point() - next_frame_;
  for (std::size_t i = 0; i < bridge_count && point_.fault == WireFault::none; ++i) {
    point_.bridge = i;
    if (silent_until_[i] >= depends_from)
      point_.fault = WireFault::silent;
    else if (std::abs(point_.quadrature[i]) > quadrature_share * options_.full_scale[i])
      point_.fault = WireFault::quadrature;
    else if (std::abs(point_.ratio[i]) > overload_share * options_.full_scale[i])
      point_.fault = WireFault::overload;
  }
}

}  // namespace turnpoint::sensing
