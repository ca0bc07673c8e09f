#include "station/sensing/trigger_decoder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "station/audio/trigger_code.hpp"

namespace turnpoint::sensing {

namespace {

constexpr double kLikeness = 0.9;  // least accepted correlation with a code's ideal wave
constexpr double kQuiet = 0.15;    // largest accepted power of the silent bits, relative to that of the code
constexpr int kScale_bits = 12;    // samples lose this many bits, so that sums of their squares are exact
constexpr double kFull = 0x1p31 / (1 << kScale_bits);

}  // namespace

TriggerDecoder::TriggerDecoder(int channel, std::int64_t bit_frames, double least_amplitude)
    : channel_(channel),
      half_(bit_frames / 2),
      least_sum_(static_cast<std::int64_t>(least_amplitude * kFull * static_cast<double>(half_) / 2)),
      sums_(std::bit_ceil(static_cast<std::size_t>((audio::trigger_half_bits + 8) * half_))),
      squares_(sums_.size()) {}

void TriggerDecoder::push(const CaptureBlock& block) {
  if (block.first_frame != next_) {
    conclude();
    next_ = origin_ = block.first_frame;
    sum_ = 0, square_ = 0;
  }
  const auto channels = static_cast<std::size_t>(block.channels);
  for (auto k = static_cast<std::size_t>(channel_); k < block.samples.size(); k += channels)
    push(block.samples[k] >> kScale_bits);
}

void TriggerDecoder::push(std::int64_t value) {
  const auto mask = sums_.size() - 1;
  const auto at = static_cast<std::size_t>(next_) & mask;
  sums_[at] = sum_, squares_[at] = square_;
  sum_ += value, square_ += static_cast<std::uint64_t>(value * value);
  // The running sums are known up to frame next_, so this call can find a code whose final silent bit ends at
  // that frame.
  const auto frame = next_ - (audio::trigger_half_bits + 2 * audio::trigger_quiet_bits) * half_;
  ++next_;
  if (frame - 2 * audio::trigger_quiet_bits * half_ - 1 < origin_) return;
  if (best_ && frame > best_->frame + 2 * half_) conclude();
  if (!starts_at(frame)) return;
  if (auto found = candidate(frame); found && (!best_ || found->likeness > best_->likeness))
    best_ = std::move(found);
}

std::int64_t TriggerDecoder::sum(std::int64_t from, std::int64_t to) const {
  const auto mask = sums_.size() - 1;
  return sums_[static_cast<std::size_t>(to) & mask] - sums_[static_cast<std::size_t>(from) & mask];
}

std::int64_t TriggerDecoder::energy(std::int64_t from, std::int64_t to) const {
  const auto mask = squares_.size() - 1;
  return static_cast<std::int64_t>(squares_[static_cast<std::size_t>(to) & mask] -
                                   squares_[static_cast<std::size_t>(from) & mask]);
}

bool TriggerDecoder::starts_at(std::int64_t frame) const {
  const auto high = sum(frame, frame + 2 * half_), low = sum(frame + 2 * half_, frame + 4 * half_);
  return high - low >= 8 * least_sum_;
}

std::int64_t TriggerDecoder::correlation(std::int64_t frame, std::uint32_t pattern) const {
  std::int64_t total = 0;
  for (int h = 0; h < audio::trigger_half_bits; ++h)
    total += audio::trigger_wave(pattern, h) * sum(frame + h * half_, frame + (h + 1) * half_);
  return total;
}

std::optional<TriggerDecoder::Candidate> TriggerDecoder::candidate(std::int64_t frame) const {
  std::uint32_t code = 0;
  for (int bit = 2; bit < 10; ++bit) {
    const auto begin = frame + 2 * bit * half_;
    code = code << 1 | (sum(begin, begin + half_) > sum(begin + half_, begin + 2 * half_) ? 1u : 0u);
  }
  if (code == 0) return std::nullopt;
  const auto end = frame + audio::trigger_half_bits * half_;
  const auto frames = static_cast<double>(end - frame);
  const double mean = static_cast<double>(sum(frame, end)) / frames;
  const double power = static_cast<double>(energy(frame, end)) / frames - mean * mean;
  const auto pattern = audio::trigger_pattern(static_cast<std::uint8_t>(code));
  const auto at = static_cast<double>(correlation(frame, pattern));
  Candidate found;
  found.likeness = at / (frames * std::sqrt(power));
  if (!(found.likeness >= kLikeness)) return std::nullopt;
  const auto quiet_frames = 2 * audio::trigger_quiet_bits * half_;
  for (const auto from : {frame - quiet_frames, end}) {
    const auto n = static_cast<double>(quiet_frames);
    const double rest = static_cast<double>(energy(from, from + quiet_frames)) / n -
                        2 * mean * static_cast<double>(sum(from, from + quiet_frames)) / n + mean * mean;
    if (rest > kQuiet * power) return std::nullopt;
  }
  // The correlation falls linearly on both sides of its peak, so its neighbours give the peak between frames.
  const auto before = static_cast<double>(correlation(frame - 1, pattern));
  const auto after = static_cast<double>(correlation(frame + 1, pattern));
  const double fall = at - std::min(before, after);
  const double off = fall > 0 ? std::clamp(0.5 * (after - before) / fall, -0.5, 0.5) : 0;
  found.frame = frame;
  found.trigger = {static_cast<double>(frame) + off, static_cast<int>(code), at / frames / kFull};
  return found;
}

void TriggerDecoder::conclude() {
  if (best_) found_.push_back(best_->trigger);
  best_.reset();
}

std::vector<DecodedTrigger> TriggerDecoder::take() { return std::exchange(found_, {}); }

std::vector<std::int64_t> EdgeFinder::push(const CaptureBlock& block) {
  std::vector<std::int64_t> edges;
  for (std::int64_t n = 0; n < block.frames(); ++n) {
    const double level = 0x1p-31 * block.samples[static_cast<std::size_t>(n * block.channels + channel_)];
    if (!up_ && level > high_) edges.push_back(block.first_frame + n);
    up_ = up_ ? level > 0.5 * high_ : level > high_;
  }
  return edges;
}

}  // namespace turnpoint::sensing
