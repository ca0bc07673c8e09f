#include "station/audio/alsa_capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <latch>
#include <system_error>
#include <thread>

#include "station/audio/alsa_device.hpp"
#include "station/audio/recovery.hpp"
#include "station/core/usage_error.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::audio {
namespace {

constexpr int kFifoPriority = 69;  // below the priority of the playback thread, whose deadline is stricter

std::string device_name(const std::string& uri) {
  if (!uri.starts_with("alsa:") || uri.size() == 5)
    throw core::UsageError(fmt::format("capture '{}' is not supported; allowed: alsa:NAME", uri));
  return uri.substr(5);
}

}  // namespace

struct DeviceCapture::Device {
  AlsaDevice alsa;
  Recovery recovery;
  std::int64_t lost_at_ns = 0;
  int stalls = 0;
  bool running = false;

  snd_pcm_t* pcm() const noexcept { return alsa.pcm.get(); }
  int start() noexcept {
    snd_pcm_drop(pcm());
    if (const int error = snd_pcm_prepare(pcm()); error < 0) return error;
    return snd_pcm_start(pcm());
  }
};

DeviceCapture::DeviceCapture(const OutputConfig& config)
    : config_(config),
      device_(std::make_unique<Device>()),
      period_(static_cast<std::size_t>(config.channels) * static_cast<std::size_t>(config.period_frames)) {
  if (config.channels < 1 || config.channels > CapturedBlock::kSamples)
    throw core::UsageError(fmt::format("capture with {} channels", config.channels));
  device_->alsa = open_alsa_device(config, device_name(config.uri), Direction::capture);
}

DeviceCapture::~DeviceCapture() = default;

CaptureCounters DeviceCapture::counters() const noexcept {
  return {frames_.load(),       overruns_.load(),  lost_frames_.load(),
          unknown_gaps_.load(), numbering_.load(), present_.load()};
}

std::vector<system::MemoryRange> DeviceCapture::memory() const {
  return {system::range_of(*device_), system::range_of(period_), system::range_of(*blocks_)};
}

void DeviceCapture::step() noexcept {
  if (device_->recovery.lost()) return absent();
  if (!device_->running) {
    device_->running = true;
    if (const int error = device_->start(); error < 0) return recover(error);
  }
  const std::int64_t frames = available();
  if (frames < 0) return recover(static_cast<int>(frames));
  read(frames);
}

// Waits until a period has been captured. Returns the number of captured frames, or a negative errno.
std::int64_t DeviceCapture::available() noexcept {
  snd_pcm_t* pcm = device_->pcm();
  const snd_pcm_sframes_t frames = snd_pcm_avail(pcm);
  if (frames < 0 || frames >= config_.period_frames) return frames;
  const int periods_ms = static_cast<int>(4000LL * config_.period_frames / config_.rate_Hz) + 100;
  const int ready = snd_pcm_wait(pcm, periods_ms);
  if (ready < 0) return ready;
  if (ready == 0) return ++device_->stalls > 5 ? -ENODEV : 0;
  device_->stalls = 0;
  return snd_pcm_avail(pcm);
}

void DeviceCapture::read(std::int64_t available) noexcept {
  snd_pcm_t* pcm = device_->pcm();
  const auto buffer = static_cast<std::int64_t>(device_->alsa.buffer_frames);
  if (available > buffer) {  // the device has overwritten frames that were not read
    const snd_pcm_sframes_t skipped = snd_pcm_forward(pcm, static_cast<snd_pcm_uframes_t>(available));
    return skipped < 0 ? recover(static_cast<int>(skipped)) : lose(skipped);
  }
  const auto wanted = std::min<std::int64_t>(available, config_.period_frames);
  if (wanted == 0) return;
  const snd_pcm_sframes_t done = snd_pcm_readi(pcm, period_.data(), static_cast<snd_pcm_uframes_t>(wanted));
  if (done == -EAGAIN) return;
  if (done < 0) return recover(static_cast<int>(done));
  const snd_pcm_sframes_t left = snd_pcm_avail(pcm);
  left + done > buffer ? lose(done) : push(done);  // the device may have overwritten what was being read
}

void DeviceCapture::push(std::int64_t frames) noexcept {
  if (auto* listener = listener_.load())
    listener->captured(frames_.load(), numbering_.load(),
                       std::span(period_).first(static_cast<std::size_t>(frames * config_.channels)));
  const std::int64_t most = CapturedBlock::kSamples / config_.channels;
  for (std::int64_t at = 0; at < frames; at += most) {
    const std::int64_t some = std::min(most, frames - at);
    const std::int64_t first = frames_.load();
    const bool pushed = blocks_->fill([&](CapturedBlock& block) {
      block.first_frame = first;
      block.numbering = numbering_.load();
      block.count = static_cast<std::int32_t>(some * config_.channels);
      std::copy_n(period_.begin() + at * config_.channels, block.count, block.samples.begin());
    });
    if (!pushed) return lose(frames - at);  // the ring is full: nobody has taken blocks for too long
    frames_.store(first + some);
  }
}

void DeviceCapture::lose(std::int64_t frames) noexcept {
  frames_.fetch_add(frames);
  lost_frames_.fetch_add(frames);
  overruns_.fetch_add(1);
  numbering_.fetch_add(1);
}

// Carries out the recovery actions, one after another, until the device captures again or is lost.
void DeviceCapture::recover(int error) noexcept {
  const auto report = [this](int outcome) {
    return DeviceReport{outcome, snd_pcm_state(device_->pcm()) == SND_PCM_STATE_DISCONNECTED};
  };
  auto action = device_->recovery.transferred(report(error));
  if (action == RecoveryAction::go_on) return;
  unknown_gaps_.fetch_add(1);
  numbering_.fetch_add(1);
  // how many frames are lost is unknown; count one buffer, which is the least
  frames_.fetch_add(static_cast<std::int64_t>(device_->alsa.buffer_frames));
  while (action != RecoveryAction::go_on) {
    int outcome = 0;
    switch (action) {
      case RecoveryAction::restart:
        outcome = device_->start();
        break;
      case RecoveryAction::wait:
        system::sleep_until_ns(system::monotonic_ns() +
                               1'000'000'000LL * config_.period_frames / config_.rate_Hz);
        [[fallthrough]];
      case RecoveryAction::resume:
        outcome = snd_pcm_resume(device_->pcm());
        break;
      default:
        device_->alsa.pcm.reset();
        device_->lost_at_ns = system::monotonic_ns();
        return present_.store(false);
    }
    action = device_->recovery.acted(report(outcome));
  }
}

void DeviceCapture::absent() noexcept {
  const auto now_ns = system::monotonic_ns();
  system::sleep_until_ns(now_ns + 1'000'000'000LL * config_.period_frames / config_.rate_Hz);
  if (device_->recovery.absent(now_ns - device_->lost_at_ns) != RecoveryAction::reopen) return;
  if (device_->recovery.reopened(reopen()) == RecoveryAction::back) present_.store(true);
}

int DeviceCapture::reopen() noexcept {
  try {
    device_->alsa = open_alsa_device(config_, device_name(config_.uri), Direction::capture);
    device_->stalls = 0;
    const int error = device_->start();
    if (error < 0) device_->alsa.pcm.reset();
    return error;
  } catch (const std::system_error& error) {
    return -error.code().value();
  } catch (const std::exception&) {
    return -EINVAL;  // the device is back, but its properties have changed
  }
}

namespace {

class RealtimeCapture final : public DeviceCapture {
 public:
  explicit RealtimeCapture(const OutputConfig& config) : DeviceCapture(config) {
    auto used = memory();
    used.push_back(system::range_of(*this));
    rights_ = system::lock_memory(used, "alsa-lib's own objects");
    thread_ = std::jthread([this](const std::stop_token& stop) {
      granted_ = system::become_realtime(kFifoPriority);
      stack_denied_ = system::lock_stack();
      started_.count_down();
      while (!stop.stop_requested()) step();
    });
    started_.wait();
    rights_.fifo_priority = granted_ == 0 ? kFifoPriority : 0;
    if (stack_denied_ != 0) rights_.memory_locked = false;
    for (const int denied : {granted_, stack_denied_})
      if (denied != 0)
        rights_.note += fmt::format("{}{}", rights_.note.empty() ? "" : "; ", std::strerror(denied));
  }

  system::Rights rights() const override { return rights_; }

 private:
  system::Rights rights_;
  int granted_ = 0, stack_denied_ = 0;
  std::latch started_{1};
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

}  // namespace

std::unique_ptr<Capture> open_capture(const OutputConfig& config) {
  return std::make_unique<RealtimeCapture>(config);
}

}  // namespace turnpoint::audio
