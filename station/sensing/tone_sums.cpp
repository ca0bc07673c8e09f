#include "station/sensing/tone_sums.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "station/drive/sine.hpp"

namespace turnpoint::sensing {

namespace {

constexpr std::size_t kWidth = 8;
constexpr std::size_t kParts = 3;

std::complex<double> unit(std::uint64_t phase) noexcept {
  return {drive::sine_of_phase(phase + drive::quarter_cycle), drive::sine_of_phase(phase)};
}

// Adds the products of `Inputs` rows with kWidth columns of the table. Each sum runs over the frames in
// order, so its bits do not depend on the processor.
template <int Inputs>
void multiply(const double* const* row, std::size_t frames, const double* table, std::size_t columns,
              double* const* sums) noexcept {
  double sum[Inputs][kWidth] = {};
  for (std::size_t n = 0; n < frames; ++n) {
    const double* t = table + n * columns;
    for (int i = 0; i < Inputs; ++i) {
      const double s = row[i][n];
      for (std::size_t k = 0; k < kWidth; ++k) sum[i][k] += s * t[k];
    }
  }
  for (int i = 0; i < Inputs; ++i) std::copy_n(sum[i], kWidth, sums[i]);
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
      part_columns_((2 * tones_.size() + kWidth - 1) / kWidth * kWidth),
      table_(kParts * static_cast<std::size_t>(block_frames) * part_columns_),
      sums_(kParts * inputs * part_columns_),
      turn_(tones_.size()) {
  if (window_frames % block_frames != 0) throw std::logic_error("sensing: the window is not whole blocks");
  for (std::size_t t = 0; t < tones_.size(); ++t) fill(t, tones_[t].partial);
}

drive::Partial ToneSums::at(std::size_t tone, std::int64_t captured_frame) const noexcept {
  const FollowedTone& followed = tones_[tone];
  drive::Partial partial = drive::advanced(
      followed.partial, static_cast<std::uint64_t>(captured_frame - delay_ - followed.origin_frame));
  partial.phase -=
      static_cast<std::uint64_t>(std::llround(static_cast<double>(partial.increment) * delay_fraction_));
  return partial;
}

std::uint64_t ToneSums::phase_at(std::size_t tone, std::int64_t captured_frame) const noexcept {
  return at(tone, captured_frame).phase;
}

void ToneSums::fill(std::size_t tone, const drive::Partial& partial) noexcept {
  const auto frames = static_cast<std::size_t>(block_frames_);
  for (std::size_t n = 0; n < frames; ++n) {
    drive::Partial from_zero = partial;
    from_zero.phase = 0;
    const auto e = unit(drive::advanced(from_zero, n).phase);
    const double angle = 2 * M_PI * static_cast<double>(n) / window_frames_;
    const double factors[kParts] = {1, std::cos(angle), std::sin(angle)};
    for (std::size_t part = 0; part < kParts; ++part) {
      double* column = table_.data() + (part * frames + n) * part_columns_ + 2 * tone;
      column[0] = factors[part] * e.real();
      column[1] = factors[part] * e.imag();
    }
  }
}

void ToneSums::compute(const AlignedBlock& block, Parts parts) noexcept {
  for (std::size_t t = 0; t < tones_.size(); ++t) {
    const drive::Partial partial = at(t, block.first_frame);
    if (partial.curvature != 0) fill(t, partial);
    turn_[t] = unit(partial.phase);
  }
  const auto frames = static_cast<std::size_t>(block_frames_);
  const std::size_t used = parts == Parts::plain ? 1 : kParts;
  for (std::size_t part = 0; part < used; ++part)
    for (std::size_t column = 0; column < part_columns_; column += kWidth) {
      const double* table = table_.data() + part * frames * part_columns_ + column;
      for (std::size_t input = 0; input < inputs_; input += 2) {
        double* first = sums_.data() + (part * inputs_ + input) * part_columns_ + column;
        double* const sums[2] = {first, first + part_columns_};
        if (input + 1 < inputs_)
          multiply<2>(block.row + input, frames, table, part_columns_, sums);
        else
          multiply<1>(block.row + input, frames, table, part_columns_, sums);
      }
    }
}

// i e^(-i phase) = i conj(e^(i phase of the first frame) e^(i phase since)).
std::complex<double> ToneSums::rotated(std::size_t input, std::size_t tone, std::size_t part) const noexcept {
  const double* sum = sums_.data() + (part * inputs_ + input) * part_columns_ + 2 * tone;
  const auto e = turn_[tone] * std::complex<double>(sum[0], sum[1]);
  return {e.imag(), e.real()};
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
