#include "station/sensing/carrier_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "station/drive/sine.hpp"

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
      filled_(taps.size()),
      loops_(&best_loops()) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::fill(kept_.begin(), kept_.end(), Quad{{nan, nan, nan, nan}});
  const double scale = 0x1p-30;  // 2 / 2^31: the factor 2 of the filter, and the full scale of a sample
  for (std::int64_t n = 0; n <= half_; ++n) {
    const double tap = scale * taps[static_cast<std::size_t>(half_ + n)] * (n == 0 ? 0.5 : 1);
    const std::uint64_t phase = increment * static_cast<std::uint64_t>(n);
    const auto even = static_cast<float>(tap * drive::sine_of_phase(phase + drive::quarter_cycle));
    const auto odd = static_cast<float>(tap * drive::sine_of_phase(phase));
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
  loops_->pick_four(frames, count, channels_.data(), stride_, to->value);
}

void CarrierFilter::finish(std::int64_t centre) noexcept {
  // The processor works on the sines, each a long chain of operations, while it begins with the filter.
  const std::uint64_t phase = increment_ * static_cast<std::uint64_t>(centre);
  const double c = drive::sine_of_phase(phase + drive::quarter_cycle), s = drive::sine_of_phase(phase);
  const Quad* middle = kept_.data() + filled_ - 1 - half_;
  Quad re, im;
  loops_->carrier(middle->value, half_, even_.front().value, odd_.front().value, re.value, im.value);
  for (std::size_t i = 0; i < inputs; ++i) {
    const double real = re.value[i], imaginary = -im.value[i];
    output_[i] = {real * c + imaginary * s, imaginary * c - real * s};
  }
  output_index_ = centre / factor_;
}

}  // namespace turnpoint::sensing
