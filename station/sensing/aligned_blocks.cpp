#include "station/sensing/aligned_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace turnpoint::sensing {

AlignedBlocks::AlignedBlocks(int rate_Hz, int channels, std::vector<int> inputs, int block_frames,
                             int high_pass_step)
    : rate_Hz_(rate_Hz),
      channels_(channels),
      block_frames_(block_frames),
      step_(high_pass_step),
      inputs_(std::move(inputs)),
      capacity_(block_frames + 2 * high_pass_step),
      raw_(inputs_.size(), std::vector<double>(static_cast<std::size_t>(capacity_))),
      filtered_(inputs_.size(), std::vector<double>(static_cast<std::size_t>(block_frames))),
      energies_(inputs_.size()) {
  for (const int input : inputs_)
    if (input < 0 || input >= channels) throw std::logic_error("sensing: no such captured channel");
  for (const auto& row : filtered_) rows_.push_back(row.data());
  block_.frames = block_frames;
  block_.row = rows_.data();
  block_.energy = energies_.data();
}

void AlignedBlocks::check(const CaptureBlock& block) const {
  if (block.rate_Hz != rate_Hz_ || block.channels != channels_)
    throw std::logic_error("sensing: captured block has an unexpected rate or number of channels");
}

// The capture may begin in the middle of an aligned block. The first frames of that block then count as lost.
void AlignedBlocks::start_at(std::int64_t frame) noexcept {
  const std::int64_t inside = ((frame + step_) % block_frames_ + block_frames_) % block_frames_;
  next_ = frame - inside;
  block_.first_frame = next_ + step_;
  filled_ = 0;
  started_ = true;
}

void AlignedBlocks::take_lost(std::int64_t frames) noexcept {
  const std::int64_t count = std::min(frames, capacity_ - filled_);
  for (auto& row : raw_) std::fill_n(row.begin() + filled_, count, std::numeric_limits<double>::quiet_NaN());
  filled_ += count;
  next_ += count;
}

void AlignedBlocks::take(const CaptureBlock& block, std::int64_t at) noexcept {
  const std::int64_t count = std::min(block.frames() - at, capacity_ - filled_);
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const std::int32_t* from = block.samples.data() + at * channels_ + inputs_[i];
    loops::scale(from, channels_, count, raw_[i].data() + filled_);
  }
  filled_ += count;
  next_ += count;
}

const AlignedBlock& AlignedBlocks::finish() noexcept {
  block_.first_frame = next_ - step_ - block_frames_;
  block_.lost = false;
  block_.largest = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const double* s = raw_[i].data() + step_;
    double* y = filtered_[i].data();
    if (step_ > 0)
      loops::high_pass(s, block_frames_, step_, y);
    else
      std::copy_n(s, block_frames_, y);
    energies_[i] = loops::energy(y, block_frames_);
    block_.largest = std::max(block_.largest, loops::largest(s, block_frames_));
    block_.lost = block_.lost || std::isnan(energies_[i]);
    std::copy_n(raw_[i].end() - 2 * step_, 2 * step_, raw_[i].begin());
  }
  filled_ = 2 * step_;
  return block_;
}

double high_pass_gain(double frequency_Hz, int rate_Hz, int step) noexcept {
  if (step == 0) return 1;
  const double s = std::sin(M_PI * frequency_Hz * step / rate_Hz);
  return s * s;
}

int high_pass_step(int rate_Hz) noexcept { return std::max(1, rate_Hz / 96000); }

}  // namespace turnpoint::sensing
