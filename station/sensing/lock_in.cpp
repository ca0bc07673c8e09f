#include "station/sensing/lock_in.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace turnpoint::sensing {

HannWindow::HannWindow(std::size_t tones, std::size_t inputs, int block_frames, int window_frames)
    : count_(tones * inputs),
      blocks_(static_cast<std::size_t>(window_frames / block_frames)),
      block_frames_(block_frames),
      window_frames_(window_frames),
      kept_(blocks_ * ToneSums::part_count * count_),
      angle_(blocks_),
      values_(count_) {
  for (std::size_t k = 0; k < blocks_; ++k)
    angle_[k] = std::polar(
        1.0, 2 * M_PI * (static_cast<double>(k) + 0.5 - 0.5 / block_frames) / static_cast<double>(blocks_));
}

bool HannWindow::take(const AlignedBlock& block, const ToneSums& sums) noexcept {
  if (block.first_frame != expected_) taken_ = 0;
  expected_ = block.first_frame + block_frames_;
  newest_ = (newest_ + 1) % blocks_;
  auto* kept = kept_.data() + newest_ * ToneSums::part_count * count_;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < count_; ++k) {
    const std::size_t input = k / sums.tones(), tone = k % sums.tones();
    kept[k] = block.lost ? nan : sums.plain(input, tone);
    kept[count_ + k] = block.lost ? nan : sums.cosine(input, tone);
    kept[2 * count_ + k] = block.lost ? nan : sums.sine(input, tone);
  }
  if (++taken_ < blocks_) return false;
  // The Hann weight n frames after the middle of block k is (1 - cos(a + 2 pi n / window)) / 2, where a is
  // the angle of the block's middle (angle_).
  std::fill(values_.begin(), values_.end(), std::complex<double>{});
  for (std::size_t b = 0; b < blocks_; ++b) {
    const auto* one = kept_.data() + (newest_ + 1 + b) % blocks_ * ToneSums::part_count * count_;
    const double c = angle_[b].real(), s = angle_[b].imag();
    for (std::size_t k = 0; k < count_; ++k)
      values_[k] += one[k] - c * one[count_ + k] + s * one[2 * count_ + k];
  }
  // the factor 1/2 of the Hann weight is left out, so the weights add up to the window's length
  const double scale = 2.0 / window_frames_;
  for (auto& value : values_) value *= scale;
  centre_ = expected_ - window_frames_ / 2;
  return true;
}

LockInShape LockInShape::of_rate(int rate_Hz) noexcept {
  const int block = 2 * ((rate_Hz + 1000) / 2000);
  return {block, 10 * block};
}

LockIn::LockIn(int rate_Hz, int channels, std::vector<int> inputs, std::vector<FollowedTone> tones,
               double delay_frames)
    : LockIn(rate_Hz, channels, std::move(inputs), std::move(tones), delay_frames,
             LockInShape::of_rate(rate_Hz)) {}

LockIn::LockIn(int rate_Hz, int channels, std::vector<int> inputs, std::vector<FollowedTone> tones,
               double delay_frames, const LockInShape& shape)
    : blocks_(rate_Hz, channels, inputs, shape.block_frames, 0),
      sums_(tones, inputs.size(), shape.block_frames, shape.window_frames, delay_frames),
      window_(tones.size(), inputs.size(), shape.block_frames, shape.window_frames),
      delay_(delay_frames) {}

}  // namespace turnpoint::sensing
