#include "station/sensing/stillness_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "station/sensing/interval_result.hpp"
#include "station/sensing/lock_in.hpp"
#include "station/sensing/planned_lines.hpp"
#include "station/sensing/tone_sums.hpp"

namespace turnpoint::sensing {

namespace {

constexpr double kLook_s = 0.05, kEvery_s = 0.25;

}  // namespace

StillnessWatch::StillnessWatch(int rate_Hz, int channels, const std::vector<PickUp>& pick_ups)
    : rate_Hz_(rate_Hz) {
  for (const auto& pick_up : pick_ups)
    if (const double best = best_response(pick_up); best > full_scale_)
      pick_up_ = pick_up, full_scale_ = best;
  if (!pick_up_) return;
  low_Hz_ = rate_Hz;
  for (const auto& transfer : pick_up_->transfers)
    if (!transfer.frequency_Hz.empty()) {
      low_Hz_ = std::min(low_Hz_, transfer.frequency_Hz.front());
      high_Hz_ = std::max(high_Hz_, transfer.frequency_Hz.back());
    }
  const int block_frames = LockInShape::of_rate(rate_Hz).block_frames;
  blocks_.emplace(rate_Hz, channels, std::vector<int>{pick_up_->channel}, block_frames, 0);
  window_.resize(static_cast<std::size_t>(kLook_s * rate_Hz / block_frames) *
                 static_cast<std::size_t>(block_frames));
}

void StillnessWatch::push(const CaptureBlock& block) {
  if (blocks_) blocks_->push(block, [this](const AlignedBlock& aligned) { look(aligned); });
}

std::optional<Disturbance> StillnessWatch::take() { return std::exchange(found_, std::nullopt); }

void StillnessWatch::look(const AlignedBlock& block) {
  const auto frames = static_cast<int>(block.frames);
  const auto filled = static_cast<std::size_t>(blocks_taken_ * frames);
  if (block.lost) {
    if (filled < window_.size()) blocks_taken_ = 0;
    return;
  }
  if (filled < window_.size()) std::copy_n(block.row[0], frames, window_.begin() + blocks_taken_ * frames);
  ++blocks_taken_;
  if (filled + static_cast<std::size_t>(frames) == window_.size()) {
    const auto tone = strongest_tone(window_, rate_Hz_, low_Hz_, high_Hz_);
    const double level_dB = tone ? in_dB(std::sqrt(2 * tone->power) / full_scale_) : kNothing_dB;
    const bool loud = level_dB >= loudest_dB;
    if (loud && heard_) found_ = Disturbance{tone->frequency_Hz, level_dB};
    heard_ = loud;
  }
  if (blocks_taken_ * frames >= kEvery_s * rate_Hz_) blocks_taken_ = 0;
}

}  // namespace turnpoint::sensing
