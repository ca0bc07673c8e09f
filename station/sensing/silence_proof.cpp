#include "station/sensing/silence_proof.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "station/sensing/lock_in.hpp"
#include "station/sensing/planned_lines.hpp"
#include "station/sensing/tone_sums.hpp"

namespace turnpoint::sensing {

namespace {

constexpr double kSilence_s = 0.05;

/// What the silence is compared with: the planned mean square of the burst's first steady tones, at the
/// channel of the pick-up that captures them most strongly.
struct Compared {
  int channel = 0;
  double power = 0;
};

Compared compared_with(const IntervalPlan& plan) {
  if (plan.pick_ups.empty()) throw std::logic_error("sensing: a proof needs a pick-up");
  const auto stretches = planned_stretches(plan.burst);
  if (stretches.empty()) return {plan.pick_ups.front().channel, 0};
  const auto lines = planned_lines(stretches.front(), plan.pick_ups, plan.rate_Hz);
  const std::size_t main = main_pick_up(lines, plan.pick_ups.size());
  return {plan.pick_ups[main].channel, planned_power(lines, main)};
}

}  // namespace

SilenceProof::SilenceProof(const IntervalPlan& plan)
    : rate_Hz_(plan.rate_Hz),
      tone_limits_(plan.limits.silence_dB),
      rms_limits_(plan.limits.residual_dB),
      brief_limits_(brief_limits(plan.limits)),
      planned_(compared_with(plan).power),
      blocks_(plan.rate_Hz, plan.capture_channels, {compared_with(plan).channel},
              LockInShape::of_rate(plan.rate_Hz).block_frames, high_pass_step(plan.rate_Hz)),
      window_blocks_(static_cast<int>(kSilence_s * plan.rate_Hz / blocks_.block_frames())),
      window_(static_cast<std::size_t>(window_blocks_ * blocks_.block_frames())),
      loudest_(window_.size()) {}

void SilenceProof::push(const CaptureBlock& block) {
  blocks_.push(block, [this](const AlignedBlock& aligned) { take(aligned); });
}

void SilenceProof::take(const AlignedBlock& block) noexcept {
  if (block.lost) {
    blocks_taken_ = 0;
    energy_ = 0;
    return;
  }
  std::copy_n(block.row[0], block.frames, window_.begin() + blocks_taken_ * block.frames);
  energy_ += block.energy[0];
  largest_block_ = std::max(largest_block_, block.energy[0] / static_cast<double>(block.frames));
  if (++blocks_taken_ < window_blocks_) return;
  const double power = energy_ / static_cast<double>(window_.size());
  if (!measured_ || power > largest_) {
    largest_ = power;
    window_.swap(loudest_);
  }
  measured_ = true;
  blocks_taken_ = 0;
  energy_ = 0;
}

SilenceResult SilenceProof::result() const {
  SilenceResult result;
  if (!(planned_ > 0)) return result;
  if (!measured_) {
    result.verdict = core::Proof::lost;
    result.cause = core::ProofCause::gap;
    return result;
  }
  result.rms_dB = in_dB(std::sqrt(largest_ / planned_));
  const auto tone = strongest_tone(loudest_, rate_Hz_);
  result.level_dB = in_dB(std::sqrt((tone ? tone->power : 0) / planned_));
  result.brief_dB = in_dB(std::sqrt(largest_block_ / planned_));
  const auto cause = core::ProofCause::noisy;
  const Finding all = concluded({{cause, core::Proof::ok},
                                 {cause, judged(result.level_dB, tone_limits_)},
                                 {cause, judged(result.rms_dB, rms_limits_)},
                                 {cause, judged(result.brief_dB, brief_limits_)}});
  result.verdict = all.verdict;
  result.cause = all.cause;
  return result;
}

}  // namespace turnpoint::sensing
