#include "station/sensing/raw_ring.hpp"

#include <algorithm>

namespace turnpoint::sensing {

RawRing::RawRing(int rate_Hz, int channels, double seconds)
    : rate_Hz_(rate_Hz),
      channels_(channels),
      capacity_(std::max<std::int64_t>(1, static_cast<std::int64_t>(seconds * rate_Hz))),
      samples_(static_cast<std::size_t>(capacity_ * channels)) {}

std::int32_t* RawRing::place_of(std::int64_t frame) noexcept {
  // frame numbers are negative at first, if the first pilot is captured before anything is played
  const auto place = (frame % capacity_ + capacity_) % capacity_;
  return samples_.data() + place * channels_;
}

void RawRing::push(const CaptureBlock& block) noexcept {
  const auto first = block.first_frame, end = first + block.frames();
  if (begin_ == end_ || first < end_ || first - end_ >= capacity_) begin_ = end_ = first;
  for (; end_ < first; ++end_) std::fill_n(place_of(end_), channels_, kNotCaptured);
  for (const auto* sample = block.samples.data(); end_ < end; ++end_, sample += channels_)
    std::transform(sample, sample + channels_, place_of(end_),
                   [](std::int32_t value) { return std::max(value, kNotCaptured + 1); });
  begin_ = std::max(begin_, end_ - capacity_);
}

RawCapture RawRing::newest() const {
  RawCapture raw{begin_, channels_, rate_Hz_, {}};
  raw.samples.reserve(static_cast<std::size_t>((end_ - begin_) * channels_));
  // Copies from the oldest frame to the end of the buffer, and then the frames at its beginning.
  const auto at = [&](std::int64_t frame) {
    return samples_.begin() + (frame % capacity_ + capacity_) % capacity_ * channels_;
  };
  if (begin_ == end_) return raw;
  if (const auto oldest = at(begin_), newest = at(end_ - 1) + channels_; oldest < newest) {
    raw.samples.assign(oldest, newest);
  } else {
    raw.samples.assign(oldest, samples_.end());
    raw.samples.insert(raw.samples.end(), samples_.begin(), newest);
  }
  return raw;
}

}  // namespace turnpoint::sensing
