#include "station/sensing/tone_sums.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "station/drive/sine.hpp"

namespace turnpoint::sensing {

namespace {

constexpr std::size_t kWidth = 8;
constexpr std::size_t kParts = 3;

inline std::complex<double> unit(std::uint64_t phase) noexcept {
  return {drive::sine_of_phase(phase + drive::quarter_cycle), drive::sine_of_phase(phase)};
}

/// Two numbers in one vector register. Every 64-bit processor has such registers.
using Lanes [[gnu::vector_size(2 * sizeof(double))]] = double;
constexpr std::size_t kLanes = kWidth / 2;

// Multiplies `Inputs` rows with kWidth columns of the table, and sums over the frames. Each sum adds the
// frames in order, so its bits do not depend on the processor.
template <std::size_t Inputs>
void multiply(const double* x, std::size_t frames, const double* table, std::size_t columns,
              double* sums) noexcept {
  Lanes sum[Inputs][kLanes] = {};
  for (std::size_t n = 0; n < frames; ++n, table += columns)
    for (std::size_t k = 0; k < kLanes; ++k) {
      const Lanes t{table[2 * k], table[2 * k + 1]};
      for (std::size_t i = 0; i < Inputs; ++i) sum[i][k] += x[i * frames + n] * t;
    }
  for (std::size_t i = 0; i < Inputs; ++i)
    for (std::size_t k = 0; k < kWidth; ++k) sums[i * columns + k] = sum[i][k / 2][k % 2];
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
      columns_((tones_.size() + kWidth - 1) / kWidth * kWidth),
      table_(kParts * static_cast<std::size_t>(block_frames) * columns_),
      folded_(inputs * static_cast<std::size_t>(block_frames)),
      sums_(kParts * 2 * inputs * columns_),
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

drive::Partial ToneSums::at(std::size_t tone, std::int64_t captured_frame) const noexcept {
  const FollowedTone& followed = tones_[tone];
  drive::Partial partial = drive::advanced(
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
    for (std::size_t part = 0; part < kParts; ++part) {
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
  for (std::size_t i = 0; i < inputs_; ++i) {
    const double* x = block.row[i];
    double* even = folded_.data() + i * half;
    double* odd = folded_.data() + (inputs_ + i) * half;
    for (std::size_t n = 0; n < half; ++n) {
      const double after = x[half + n], before = x[half - 1 - n];
      even[n] = after + before;
      odd[n] = after - before;
    }
  }
}

void ToneSums::compute(const AlignedBlock& block, Parts parts) noexcept {
  fold(block);
  const auto half = static_cast<std::size_t>(block_frames_ / 2);
  const std::size_t used = parts == Parts::plain ? 1 : kParts;
  for (std::size_t part = 0; part < used; ++part)
    for (std::size_t parity = 0; parity < 2; ++parity)
      for (std::size_t column = 0; column < columns_; column += kWidth) {
        const double* table = table_.data() + (part * 2 + parity) * half * columns_ + column;
        for (std::size_t input = 0; input < inputs_; input += 2) {
          const double* x = folded_.data() + (parity * inputs_ + input) * half;
          double* sums = row(part, parity, input) + column;
          if (input + 1 < inputs_)
            multiply<2>(x, half, table, columns_, sums);
          else
            multiply<1>(x, half, table, columns_, sums);
        }
      }
  const auto to_middle = static_cast<std::uint64_t>(block_frames_ - 1);
  for (std::size_t t = 0; t < tones_.size(); ++t) {
    const drive::Partial partial = at(t, block.first_frame);
    phase_[t] = partial.phase + partial.increment / 2 * to_middle;
    if (partial.curvature == 0) continue;
    glide(block, t, partial);
    phase_[t] = 0;
  }
  for (std::size_t t = 0; t < tones_.size(); ++t) turn_[t] = unit(phase_[t]);
}

// A gliding tone has no symmetry, so its sums are computed frame by frame.
void ToneSums::glide(const AlignedBlock& block, std::size_t tone, const drive::Partial& partial) noexcept {
  for (std::size_t part = 0; part < kParts; ++part)
    for (std::size_t i = 0; i < inputs_; ++i) row(part, 0, i)[tone] = row(part, 1, i)[tone] = 0;
  for (int n = 0; n < block_frames_; ++n) {
    const auto e = unit(drive::advanced(partial, static_cast<std::uint64_t>(n)).phase);
    for (std::size_t part = 0; part < kParts; ++part) {
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

}  // namespace turnpoint::sensing
