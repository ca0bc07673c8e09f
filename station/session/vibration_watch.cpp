#include "station/session/vibration_watch.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "station/sensing/phase_drift.hpp"

namespace turnpoint::session {

namespace {

// Before each trial, a silence of this length is measured; the page with the cue is shown for longer. If the
// stimulus comes sooner, as in the self-test, at least 50 ms must remain after the ringing: see kExpected_ns.
constexpr double kSilence_s = 0.08;
constexpr double kRaw_s = 4;          // how much of the capture is kept as it came from the converter
constexpr double kRinging_s = 0.005;  // how long the plate goes on moving: 7 time constants at Q 60

/// The part of a captured block from frame `begin` to before frame `end`; without frames if there is none.
sensing::CaptureBlock part_of(const sensing::CaptureBlock& block, std::int64_t begin, std::int64_t end) {
  const auto first = std::clamp(begin, block.first_frame, block.first_frame + block.frames());
  const auto last = std::clamp(end, first, block.first_frame + block.frames());
  const auto sample_at = [&](std::int64_t frame) {
    return static_cast<std::size_t>((frame - block.first_frame) * block.channels);
  };
  auto part = block;
  part.samples = block.samples.subspan(sample_at(first), sample_at(last) - sample_at(first));
  part.first_frame = first;
  return part;
}

/// Adds the silence before an interval to the verdict on the interval.
void add_silence(const sensing::SilenceResult& silence, sensing::IntervalResult& result) {
  result.silence = silence;
  if (silence.verdict == core::Proof::unproven) return;
  // The stimulus itself is still proven if only the silence before it is not known, so the trial counts.
  const auto verdict = silence.verdict == core::Proof::lost ? core::Proof::flagged : silence.verdict;
  auto all = sensing::concluded({{result.cause, result.verdict}, {silence.cause, verdict}});
  // A surface that already moved before the stimulus also explains the residual during the stimulus.
  if (all.cause == core::ProofCause::residual && verdict == all.verdict) all.cause = silence.cause;
  result.verdict = all.verdict;
  result.cause = all.cause;
}

}  // namespace

std::vector<sensing::PickUp> calibrated_pick_ups(const rig::Capture& capture) {
  std::vector<sensing::PickUp> pick_ups;
  for (const int channel : capture.pick_ups) {
    sensing::PickUp pick_up{channel, {}};
    for (const auto& response : capture.responses) {
      if (response.channel != channel) continue;
      sensing::Transfer transfer{response.drive_channel, {}, {}};
      for (const auto& point : response.points) {
        transfer.frequency_Hz.push_back(point.frequency_Hz);
        transfer.response.push_back(std::polar(point.amplitude, point.phase_rad));
      }
      pick_up.transfers.push_back(std::move(transfer));
    }
    pick_ups.push_back(std::move(pick_up));
  }
  return pick_ups;
}

void use(const rig::ForceCells& cells, sensing::FingerSetup& finger) {
  finger.calibration = sensing::ForceCalibration(cells.matrix, cells.changes);
  finger.bridges.carrier_Hz = cells.carrier_Hz;
  finger.bridges.reference_amplitude = cells.reference_amplitude;
  finger.bridges.rotation_rad = cells.rotation_rad;
  finger.bridges.full_scale = cells.rated_ratio;
}

std::optional<sensing::FingerSetup> calibrated_finger(const rig::Rig& rig) {
  const auto& capture = rig.capture.value();
  if (!rig::has_force_cells(rig) || !capture.forces) return std::nullopt;
  sensing::FingerSetup finger;
  finger.bridges.rate_Hz = rig.output.rate_Hz;
  finger.length_mm = 1e3 * rig.surface.length_m;
  finger.own_clock = capture.converter.has_value();
  if (finger.own_clock) {
    finger.calibration = sensing::ForceCalibration(capture.forces->matrix, capture.forces->changes);
    finger.bridges.full_scale = capture.forces->rated_ratio;
    return finger;
  }
  finger.bridges.channels = capture.channels;
  finger.bridges.reference = capture.reference;
  std::copy(capture.bridges.begin(), capture.bridges.end(), finger.bridges.bridges.begin());
  use(*capture.forces, finger);
  return finger;
}

VibrationWatch::VibrationWatch(CaptureSetup setup)
    : setup_(std::move(setup)), calibrated_(setup_.pick_ups), raw_(setup_.rate_Hz, setup_.channels, kRaw_s) {
  if (setup_.finger) finger_.emplace(*setup_.finger);
}

void VibrationWatch::set_delay(double frames) {
  const std::lock_guard lock(mutex_);
  setup_.delay_frames = frames;
}

void VibrationWatch::set_drift(double share) {
  const std::lock_guard lock(mutex_);
  setup_.pick_ups = sensing::scaled(calibrated_, share);
}

void VibrationWatch::expect(std::span<const audio::PreparedBurst> intervals, std::int64_t quiet_until,
                            Commanded commanded) {
  std::vector<std::unique_ptr<sensing::IntervalProof>> proofs;
  std::vector<std::unique_ptr<sensing::FollowProof>> follow_proofs;
  std::vector<sensing::TrialFinger::Range> ranges;
  for (const auto& burst : intervals)
    ranges.push_back({burst.start_frame, burst.start_frame + burst.length_frames});
  const auto plan_of = [&](const audio::PreparedBurst& burst) {
    return sensing::IntervalPlan{burst,           setup_.rate_Hz,      setup_.channels,
                                 setup_.pick_ups, setup_.delay_frames, setup_.limits};
  };
  for (const auto& burst : intervals) {
    proofs.push_back(std::make_unique<sensing::IntervalProof>(plan_of(burst)));
    follow_proofs.push_back(burst.following.follows() ? std::make_unique<sensing::FollowProof>(plan_of(burst))
                                                      : nullptr);
  }
  const std::lock_guard lock(mutex_);
  proofs_ = std::move(proofs);
  follow_proofs_ = std::move(follow_proofs);
  commanded_ = std::move(commanded);
  silence_.reset();
  if (!intervals.empty()) {
    silence_.emplace(plan_of(intervals.front()));
    const auto frames_of = [&](double seconds) {
      return static_cast<std::int64_t>(seconds * setup_.rate_Hz);
    };
    const auto delay = static_cast<std::int64_t>(std::floor(setup_.delay_frames));
    silence_end_ = intervals.front().start_frame + delay;
    // Until `quiet_until`, an aborted trial may still have been ramping down.
    silence_begin_ =
        std::max(silence_end_ - frames_of(kSilence_s), quiet_until + delay + frames_of(kRinging_s));
  }
  if (finger_) finger_->expect(quiet_until, std::move(ranges));
}

void VibrationWatch::cut(std::int64_t from_frame) {
  const std::lock_guard lock(mutex_);
  for (auto& proof : proofs_) proof->stopped(from_frame);
  for (auto& proof : follow_proofs_)
    if (proof) proof->stopped(from_frame);
  if (finger_) finger_->cut(from_frame);
}

void VibrationWatch::changed(std::size_t interval, const audio::Change& change, const audio::Format& format) {
  const std::lock_guard lock(mutex_);
  if (interval < proofs_.size()) proofs_[interval]->changed(change, format);
}

bool VibrationWatch::needs(std::int64_t first_frame, std::int64_t end_frame) const {
  const std::lock_guard lock(mutex_);
  if (silence_ && first_frame < silence_end_ && end_frame > silence_begin_) return true;
  return std::any_of(proofs_.begin(), proofs_.end(), [&](const auto& proof) {
    return !proof->complete() && first_frame < proof->end_frame() && end_frame > proof->first_frame();
  });
}

void VibrationWatch::push(const sensing::CaptureBlock& block) {
  const std::lock_guard lock(mutex_);
  for (auto& proof : proofs_) proof->push(block);
  for (auto& proof : follow_proofs_)
    if (proof) proof->push(block);
  if (silence_)
    if (const auto part = part_of(block, silence_begin_, silence_end_); part.frames() > 0)
      silence_->push(part);
  if (finger_ && !setup_.finger->own_clock) finger_->push(block);
  raw_.push(block);
}

void VibrationWatch::push(const sensing::BridgePoint& point) {
  const std::lock_guard lock(mutex_);
  if (finger_) finger_->push(point);
}

std::int64_t VibrationWatch::known_at(std::size_t interval) const {
  const std::lock_guard lock(mutex_);
  auto frame = std::numeric_limits<std::int64_t>::min();
  if (interval >= proofs_.size()) return frame;
  frame = proofs_[interval]->end_frame();
  if (finger_ && interval + 1 == proofs_.size()) frame = std::max(frame, finger_->known_at());
  return frame;
}

std::shared_ptr<const sensing::IntervalResult> VibrationWatch::result(std::size_t interval) {
  std::unique_lock lock(mutex_);
  if (interval >= proofs_.size()) return nullptr;
  const auto contact = finger_ ? finger_->contact(interval) : setup_.in_contact;
  auto result = std::make_shared<sensing::IntervalResult>(proofs_[interval]->result(contact));
  if (const auto follows = std::move(follow_proofs_[interval]); follows && commanded_) {
    // This takes a while. The thread that pushes samples must not wait for it.
    lock.unlock();
    *result = follows->result(commanded_(interval), contact);
    lock.lock();
  }
  if (interval == 0) add_silence(silence_->result(), *result);
  return result;
}

sensing::RawCapture VibrationWatch::raw() const {
  const std::lock_guard lock(mutex_);
  return raw_.newest();
}

std::optional<sensing::FingerNow> VibrationWatch::finger_now() {
  const std::lock_guard lock(mutex_);
  return finger_ ? finger_->now() : std::nullopt;
}

std::optional<sensing::Readings> VibrationWatch::zero() {
  const std::lock_guard lock(mutex_);
  return finger_ ? finger_->zero() : std::nullopt;
}

std::shared_ptr<const sensing::TrialForces> VibrationWatch::forces(std::size_t interval) {
  const std::lock_guard lock(mutex_);
  if (!finger_ || interval + 1 != proofs_.size()) return nullptr;
  return std::make_shared<sensing::TrialForces>(finger_->result());
}

}  // namespace turnpoint::session
