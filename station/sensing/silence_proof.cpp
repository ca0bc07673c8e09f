#include "station/sensing/silence_proof.hpp"

#include <algorithm>
#include <stdexcept>

#include "station/sensing/lock_in.hpp"
#include "station/sensing/planned_lines.hpp"

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
  const auto stretches = planned_stretches(plan.burst, plan.rate_Hz);
  if (stretches.empty()) return {plan.pick_ups.front().channel, 0};
  const auto lines = planned_lines(stretches.front(), plan.pick_ups, plan.rate_Hz);
  const std::size_t main = main_pick_up(lines, plan.pick_ups.size());
  return {plan.pick_ups[main].channel, planned_power(lines, main)};
}

}  // namespace

SilenceProof::SilenceProof(const IntervalPlan& plan)
    : limits_(plan.limits.silence_dB),
      planned_(compared_with(plan).power),
      blocks_(plan.rate_Hz, plan.capture_channels, {compared_with(plan).channel},
              LockInShape::of_rate(plan.rate_Hz).block_frames, high_pass_step(plan.rate_Hz)),
      window_blocks_(static_cast<int>(kSilence_s * plan.rate_Hz / blocks_.block_frames())) {}

void SilenceProof::push(const CaptureBlock& block) {
  blocks_.push(block, [this](const AlignedBlock& aligned) { take(aligned); });
}

void SilenceProof::take(const AlignedBlock& block) noexcept {
  if (block.lost) {
    blocks_taken_ = 0;
    energy_ = 0;
    return;
  }
  energy_ += block.energy[0];
  if (++blocks_taken_ < window_blocks_) return;
  largest_ = std::max(largest_, energy_ / static_cast<double>(window_blocks_ * block.frames));
  measured_ = true;
  blocks_taken_ = 0;
  energy_ = 0;
}

SilenceResult SilenceProof::result() const noexcept {
  SilenceResult result;
  if (!measured_ || !(planned_ > 0)) return result;
  result.level_dB = in_dB(std::sqrt(largest_ / planned_));
  result.verdict = judged(result.level_dB, limits_);
  if (result.verdict != terms::Proof::ok) result.cause = terms::ProofCause::noisy;
  return result;
}

}  // namespace turnpoint::sensing
