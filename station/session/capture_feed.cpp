#include "station/session/capture_feed.hpp"
#include "station/core/limits.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <utility>

namespace turnpoint::session {

namespace {

constexpr std::int64_t kBefore_frames = 80;
constexpr double kOff_s = 0.15;  // from switching the amplifier off until the surface must be still

sensing::Pilot pilot_of(const rig::Rig& rig) {
  sensing::Pilot pilot;
  pilot.rate_Hz = rig.output.rate_Hz;
  pilot.low_Hz = std::min(pilot.low_Hz, 0.115 * pilot.rate_Hz);
  pilot.high_Hz = std::min(pilot.high_Hz, 0.24 * pilot.rate_Hz);
  pilot.frames = pilot.rate_Hz / 200 * 2;
  pilot.channel = *rig.capture->excitation_channel;
  return pilot;
}

}  // namespace

std::optional<CardCapture> card_capture_of(const rig::Rig& rig) {
  if (!rig.capture || !rig.capture->uri.starts_with("alsa:")) return std::nullopt;
  CardCapture plan;
  plan.device.uri = rig.capture->uri;
  plan.device.rate_Hz = rig.output.rate_Hz;
  plan.device.channels = rig.capture->channels;
  plan.device.period_frames = rig.output.period_frames;
  plan.device.periods = rig.output.periods;
  plan.device.allow_plugin = rig.output.allow_plugin;
  plan.setup.rate_Hz = rig.output.rate_Hz;
  plan.setup.channels = rig.capture->channels;
  plan.setup.pick_ups = calibrated_pick_ups(*rig.capture);
  plan.pilot = pilot_of(rig);
  if (!rig.capture->bridges.empty()) plan.pilot.carrier_Hz = core::kForceCarrier_Hz;
  plan.setup.finger = calibrated_finger(rig);
  plan.cells = cell_plan_of(rig);
  plan.reference = rig.capture->reference;
  plan.triggers = trigger_setup_of(rig);
  return plan;
}

CaptureFeed::CaptureFeed(std::unique_ptr<audio::Capture> capture, const CardCapture& plan)
    : capture_(std::move(capture)),
      plan_(plan),
      // The pilot is played up to one buffer length after it was scheduled. It is captured up to one more
      // buffer length later.
      longest_wait_s_(0.5 + 2.0 * plan.device.periods * plan.device.period_frames / plan.device.rate_Hz),
      watch_(plan.setup),
      triggers_(plan.triggers, 0),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

bool CaptureFeed::aligned() const {
  const std::lock_guard lock(mutex_);
  return aligned_;
}

std::optional<Alignment> CaptureFeed::alignment() const {
  const std::lock_guard lock(mutex_);
  return aligned_ ? std::optional(Alignment{shift_, numbering_}) : std::nullopt;
}

void CaptureFeed::misalign() {
  const std::lock_guard lock(mutex_);
  aligned_ = false;
  listener_.reset();
  if (pilot_ == Pilot::awaited) pilot_ = Pilot::missing;
}

std::int64_t CaptureFeed::end_frame() const {
  const std::lock_guard lock(mutex_);
  return end_frame_;
}

void CaptureFeed::amplifier_is_off() {
  const std::lock_guard lock(mutex_);
  stillness_.emplace(plan_.setup.rate_Hz, plan_.setup.channels, plan_.setup.pick_ups);
  still_from_ = capture_->counters().frames + static_cast<std::int64_t>(kOff_s * plan_.setup.rate_Hz);
}

void CaptureFeed::amplifier_goes_on() {
  const std::lock_guard lock(mutex_);
  stillness_.reset();
}

std::optional<sensing::Disturbance> CaptureFeed::disturbance() {
  const std::lock_guard lock(mutex_);
  return stillness_ ? stillness_->take() : std::nullopt;
}

CaptureFeed::Pilot CaptureFeed::pilot() const {
  const std::lock_guard lock(mutex_);
  return pilot_;
}

void CaptureFeed::listen(std::int64_t start_frame) {
  auto listener = std::make_unique<sensing::PilotListener>(plan_.pilot, start_frame, plan_.device.channels,
                                                           plan_.reference, longest_wait_s_);
  const std::lock_guard lock(mutex_);
  const auto counters = capture_->counters();
  // A first guess at the delay: the newest captured frame gets the number kBefore_frames before the pilot,
  // although the pilot will be played later. The listener needs frames from before the pilot, and the next
  // block may begin with the next frame.
  shift_ = start_frame - counters.frames - kBefore_frames;
  numbering_ = counters.numbering;
  aligned_ = false;
  pilot_ = Pilot::awaited;
  listener_ = std::move(listener);
}

void CaptureFeed::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const auto numbering = capture_->counters().numbering;
    while (const auto* block = capture_->take())
      if (take(*block)) conclude();
    {
      const std::lock_guard lock(mutex_);
      if (numbering != numbering_) aligned_ = false;  // frames were lost after the block that was taken last
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

// Passes a captured block to the pilot's listener or, once the delay from playback to capture is known, to
// the vibration watch. Returns true once enough has been captured to contain the whole pilot.
bool CaptureFeed::take(const audio::CapturedBlock& captured) {
  const std::lock_guard lock(mutex_);
  sensing::CaptureBlock block{captured.used(), plan_.device.channels, captured.first_frame,
                              plan_.device.rate_Hz};
  if (stillness_ && block.first_frame >= still_from_) stillness_->push(block);
  block.first_frame += shift_;
  if (captured.numbering != numbering_) aligned_ = false;
  if (listener_) {
    // The listener notices by itself if frames of the pilot are missing.
    listener_->push(block);
    return listener_->complete();
  }
  if (!aligned_) return false;
  watch_.push(block);
  triggers_.push(block);
  end_frame_ = block.first_frame + block.frames();
  return false;
}

// Searches for the pilot without holding the lock. The session thread also takes the lock, and must not wait,
// because it reports to the amplifier guard.
void CaptureFeed::conclude() {
  std::unique_lock lock(mutex_);
  const auto listener = std::exchange(listener_, nullptr);
  if (!listener) return;  // listening was cancelled after the pilot was complete
  lock.unlock();
  const auto echo = listener->find();
  lock.lock();
  if (pilot_ != Pilot::awaited || listener_) return;  // listening was cancelled during the search
  pilot_ = echo ? Pilot::heard : Pilot::missing;
  if (!echo) return;
  const auto whole = std::llround(echo->delay_frames);
  shift_ -= whole;
  watch_.set_delay(echo->delay_frames - static_cast<double>(whole));
  aligned_ = true;
  end_frame_ = 0;
}

}  // namespace turnpoint::session
