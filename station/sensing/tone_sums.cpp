#include "station/sensing/tone_sums.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "station/audio/sine.hpp"

namespace turnpoint::sensing {
namespace {

inline std::complex<double> unit(std::uint64_t phase) noexcept {
  return {audio::sine_of_phase(phase + audio::quarter_cycle), audio::sine_of_phase(phase)};
}

}  // namespace

ToneSums::ToneSums(std::vector<FollowedTone> tones, std::size_t inputs, int block_frames, int window_frames,
                   double delay_frames)
    : tones_(std::move(tones)),
      inputs_(inputs),
      block_frames_(block_frames),
      window_frames_(window_frames),
      delay_(static_cast<std::int64_t>(std::floor(delay_frames))),
      delay_fraction_(delay_frames - std::floor(delay_frames)),
      columns_((tones_.size() + loops::kTones - 1) / loops::kTones * loops::kTones),
      table_(part_count * static_cast<std::size_t>(block_frames) * columns_),
      folded_(inputs * static_cast<std::size_t>(block_frames)),
      sums_(part_count * 2 * inputs * columns_),
      phase_(tones_.size()),
      turn_(tones_.size()) {
  if (block_frames % 2 != 0 || window_frames % block_frames != 0)
    throw std::logic_error("sensing: a lock-in needs blocks of even length and a window of whole blocks");
  for (const FollowedTone& tone : tones_) part_of_frame_.push_back(of_fraction(tone.partial.increment));
  for (std::size_t t = 0; t < tones_.size(); ++t) fill(t);
}

std::uint64_t ToneSums::of_fraction(std::uint64_t increment) const noexcept {
  return static_cast<std::uint64_t>(std::llround(static_cast<double>(increment) * delay_fraction_));
}

audio::Partial ToneSums::at(std::size_t tone, std::int64_t captured_frame) const noexcept {
  const FollowedTone& followed = tones_[tone];
  audio::Partial partial = audio::advanced(
      followed.partial, static_cast<std::uint64_t>(captured_frame - delay_ - followed.origin_frame));
  partial.phase -= partial.curvature == 0 ? part_of_frame_[tone] : of_fraction(partial.increment);
  return partial;
}

std::uint64_t ToneSums::phase_at(std::size_t tone, std::int64_t captured_frame) const noexcept {
  return at(tone, captured_frame).phase;
}

double* ToneSums::row(std::size_t part, std::size_t parity, std::size_t input) noexcept {
  return sums_.data() + ((part * 2 + parity) * inputs_ + input) * columns_;
}

double ToneSums::factor(std::size_t part, double from_middle) const noexcept {
  const double angle = 2 * M_PI * from_middle / window_frames_;
  return part == 0 ? 1 : part == 1 ? std::cos(angle) : std::sin(angle);
}

// Fills the table's columns of one tone. Columns of parity 0 are even functions of the distance from the
// block's middle; those of parity 1 are odd functions.
void ToneSums::fill(std::size_t tone) noexcept {
  const auto half = static_cast<std::size_t>(block_frames_ / 2);
  const std::uint64_t increment = tones_[tone].partial.increment;
  for (std::size_t n = 0; n < half; ++n) {
    const auto e = unit(increment / 2 * (2 * n + 1));
    for (std::size_t part = 0; part < part_count; ++part) {
      const double f = factor(part, static_cast<double>(n) + 0.5);
      double* column = table_.data() + (part * 2 * half + n) * columns_ + tone;
      // the factor sin is an odd function: it turns even columns into odd ones, and odd ones into even ones
      const bool swaps = part == 2;
      column[0] = f * (swaps ? e.imag() : e.real());
      column[half * columns_] = f * (swaps ? e.real() : e.imag());
    }
  }
}

void ToneSums::fold(const AlignedBlock& block) noexcept {
  const auto half = static_cast<std::size_t>(block_frames_ / 2);
  for (std::size_t i = 0; i < inputs_; ++i)
    loops::fold(block.row[i], half, folded_.data() + i * half, folded_.data() + (inputs_ + i) * half);
}

void ToneSums::compute(const AlignedBlock& block, Parts parts) noexcept {
  fold(block);
  const auto half = static_cast<std::size_t>(block_frames_ / 2);
  const std::size_t used = parts == Parts::plain ? 1 : part_count;
  for (std::size_t part = 0; part < used; ++part)
    for (std::size_t parity = 0; parity < 2; ++parity)
      for (std::size_t column = 0; column < columns_; column += loops::kTones)
        loops::tones(folded_.data() + parity * inputs_ * half, inputs_, half,
                     table_.data() + (part * 2 + parity) * half * columns_ + column, columns_,
                     row(part, parity, 0) + column);
  const auto to_middle = static_cast<std::uint64_t>(block_frames_ - 1);
  for (std::size_t t = 0; t < tones_.size(); ++t) {
    const audio::Partial partial = at(t, block.first_frame);
    phase_[t] = partial.phase + partial.increment / 2 * to_middle;
    if (partial.curvature == 0) continue;
    glide(block, t, partial);
    phase_[t] = 0;
  }
  for (std::size_t t = 0; t < tones_.size(); ++t) turn_[t] = unit(phase_[t]);
}

// A gliding tone has no symmetry, so its sums are computed frame by frame.
void ToneSums::glide(const AlignedBlock& block, std::size_t tone, const audio::Partial& partial) noexcept {
  for (std::size_t part = 0; part < part_count; ++part)
    for (std::size_t i = 0; i < inputs_; ++i) row(part, 0, i)[tone] = row(part, 1, i)[tone] = 0;
  for (int n = 0; n < block_frames_; ++n) {
    const auto e = unit(audio::advanced(partial, static_cast<std::uint64_t>(n)).phase);
    for (std::size_t part = 0; part < part_count; ++part) {
      const double f = factor(part, n - (block_frames_ - 1) / 2.0);
      const std::size_t real = part == 2 ? 1 : 0;
      for (std::size_t i = 0; i < inputs_; ++i) {
        row(part, real, i)[tone] += block.row[i][n] * f * e.real();
        row(part, 1 - real, i)[tone] += block.row[i][n] * f * e.imag();
      }
    }
  }
}

// Multiplies the sum by i e^(-i phase), where the phase is that of the middle of the block; the table already
// contains the phase relative to the middle.
std::complex<double> ToneSums::rotated(std::size_t input, std::size_t tone, std::size_t part) const noexcept {
  const double* even = sums_.data() + (part * 2 * inputs_ + input) * columns_ + tone;
  const double* odd = even + inputs_ * columns_;
  const auto sum = part == 2 ? std::complex<double>(*odd, *even) : std::complex<double>(*even, *odd);
  const auto& turn = turn_[tone];
  return {turn.real() * sum.imag() + turn.imag() * sum.real(),
          turn.real() * sum.real() - turn.imag() * sum.imag()};
}

std::complex<double> ToneSums::plain(std::size_t input, std::size_t tone) const noexcept {
  return rotated(input, tone, 0);
}
std::complex<double> ToneSums::cosine(std::size_t input, std::size_t tone) const noexcept {
  return rotated(input, tone, 1);
}
std::complex<double> ToneSums::sine(std::size_t input, std::size_t tone) const noexcept {
  return rotated(input, tone, 2);
}

namespace {

// A tone in noise is a line that is this many times stronger than the mean of all lines. The strongest of the
// 5000 lines of white noise is 5 times as strong as their mean, rarely 10 times; the high-pass filter raises
// the noise at 48 kHz to 2.7 times the mean.
constexpr double kStandsOut = 30;

}  // namespace

std::optional<FoundTone> strongest_tone(std::span<const double> samples, int rate_Hz, double low_Hz,
                                        double high_Hz) {
  const std::size_t count = samples.size();
  std::vector<double> windowed(std::bit_ceil(count));
  double weights = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double hann =
        1 - std::cos(2 * std::numbers::pi * (static_cast<double>(n) + 0.5) / static_cast<double>(count));
    windowed[n] = hann * samples[n];
    weights += hann * hann;
  }
  Eigen::FFT<double> fourier;
  std::vector<std::complex<double>> spectrum;
  fourier.fwd(spectrum, windowed);
  // A line is the energy within the main lobe of the window: two bins of the unpadded transform on each side.
  const std::size_t half = spectrum.size() / 2, reach = 2 * spectrum.size() / count;
  const double bin_Hz = rate_Hz / static_cast<double>(spectrum.size());
  const auto bin_of = [&](double frequency_Hz) {
    return static_cast<std::size_t>(
        std::clamp(frequency_Hz / bin_Hz, static_cast<double>(reach), static_cast<double>(half - reach)));
  };
  const std::size_t first = bin_of(low_Hz), end = bin_of(high_Hz);
  const auto energy = [&](std::size_t k) { return std::norm(spectrum[k]); };
  double lobe = 0, total = 0, strongest = 0;
  std::size_t lines = 0, at = first;
  for (std::size_t k = first - reach; k < first + reach; ++k) lobe += energy(k);
  for (std::size_t k = first; k < end; ++k, ++lines) {
    lobe += energy(k + reach);
    if (lobe > strongest) strongest = lobe, at = k;
    total += lobe;
    lobe -= energy(k - reach);
  }
  const double noise = (total - strongest) / static_cast<double>(lines);
  if (lines == 0 || strongest < kStandsOut * noise) return std::nullopt;
  return FoundTone{static_cast<double>(at) * bin_Hz,
                   2 * strongest / (static_cast<double>(spectrum.size()) * weights)};
}

}  // namespace turnpoint::sensing
