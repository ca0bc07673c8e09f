#include "station/drive/alsa_output.hpp"

#include <cerrno>
#include <cmath>
#include <system_error>

#include "station/drive/alsa_device.hpp"
#include "station/drive/monotonic.hpp"
#include "station/drive/recovery.hpp"

namespace turnpoint::drive {
namespace {

class AlsaOutput final : public Output {
 public:
  AlsaOutput(OutputConfig config, const std::string& name)
      : config_(std::move(config)),
        name_(name),
        device_(open_alsa_device(config_, name)),
        silence_(static_cast<std::size_t>(config_.channels) * device_.buffer_frames) {}

  const OutputConfig& config() const noexcept override { return config_; }
  bool paced() const noexcept override { return true; }

  WriteResult write(std::span<const std::int32_t> interleaved) noexcept override {
    if (recovery_.lost()) return absent();
    const std::int32_t* at = interleaved.data();
    auto left = interleaved.size() / static_cast<std::size_t>(config_.channels);
    WriteResult result;
    // Not before the first block is there: what comes between opening and that would be an underrun.
    if (!running_) {
      running_ = true;
      if (const int error = start(); error < 0 && !follow(recovery_.transferred({error}), error, result))
        return result;
    }
    while (left > 0) {
      const snd_pcm_sframes_t done = transfer(at, left, result);
      if (done > 0) {
        at += done * config_.channels;
        left -= static_cast<std::size_t>(done);
        frames_ += done;
        continue;
      }
      const RecoveryAction action =
          recovery_.transferred({static_cast<int>(done), snd_pcm_state(pcm()) == SND_PCM_STATE_DISCONNECTED});
      if (!follow(action, static_cast<int>(done), result)) return result;
    }
    return result;
  }

  // Frames that have left the converter's buffer, at the time the driver stamped.
  std::optional<Position> position() noexcept override {
    if (recovery_.lost()) return std::nullopt;
    snd_pcm_uframes_t free = 0;
    snd_htimestamp_t stamp{};
    if (snd_pcm_htimestamp(pcm(), &free, &stamp) < 0 || free > device_.buffer_frames) return std::nullopt;
    if (stamp.tv_sec == 0 && stamp.tv_nsec == 0) return std::nullopt;
    const auto queued = static_cast<std::int64_t>(device_.buffer_frames - free);
    return Position{frames_ - queued, std::int64_t{1'000'000'000} * stamp.tv_sec + stamp.tv_nsec};
  }

  void finish() override {
    if (!device_.pcm) return;
    snd_pcm_nonblock(pcm(), 0);
    snd_pcm_drop(pcm());
    device_.pcm.reset();
  }

 private:
  snd_pcm_t* pcm() const noexcept { return device_.pcm.get(); }

  // Prepared, a whole buffer of silence ahead, running. The silence is not counted: frames begin behind it.
  int start() noexcept {
    snd_pcm_drop(pcm());  // a device that has been resumed still runs with what it had
    if (const int error = snd_pcm_prepare(pcm()); error < 0) return error;
    const snd_pcm_uframes_t ahead = device_.buffer_frames - device_.period_frames;
    const snd_pcm_sframes_t written = snd_pcm_writei(pcm(), silence_.data(), ahead);
    if (written < 0) return static_cast<int>(written);
    return snd_pcm_start(pcm());
  }

  // Waits for room and writes some frames; the frames written or a negative errno. Where the device has run
  // past what was written it goes on in silence, and the frames that it played are skipped.
  snd_pcm_sframes_t transfer(const std::int32_t* at, std::size_t frames, WriteResult& result) noexcept {
    const snd_pcm_sframes_t room = snd_pcm_avail_update(pcm());
    if (room < 0) return room;
    if (room > static_cast<snd_pcm_sframes_t>(device_.buffer_frames)) {
      const auto late = static_cast<snd_pcm_uframes_t>(room) - device_.buffer_frames + device_.period_frames;
      const snd_pcm_sframes_t skipped = snd_pcm_forward(pcm(), late);
      if (skipped < 0) return skipped;
      frames_ += skipped;
      result.status = WriteStatus::skipped;
      result.error = -EPIPE;
      result.lost_frames += skipped;
      return -EAGAIN;
    }
    if (room < static_cast<snd_pcm_sframes_t>(device_.period_frames)) {
      const int periods_ms = static_cast<int>(4000LL * config_.period_frames / config_.rate_Hz) + 100;
      const int ready = snd_pcm_wait(pcm(), periods_ms);
      if (ready < 0) return ready;
      if (ready == 0) return stalled();
      stalls_ = 0;
    }
    return snd_pcm_writei(pcm(), at, frames);
  }

  // A device that neither plays nor fails: after five waits it is taken for lost.
  int stalled() noexcept { return ++stalls_ > 5 ? -ENODEV : -EAGAIN; }

  // Carries a recovery out; false where this write is over.
  bool follow(RecoveryAction action, int error, WriteResult& result) noexcept {
    for (;;) {
      int outcome = 0;
      switch (action) {
        case RecoveryAction::go_on:
          return true;
        case RecoveryAction::restart:
          outcome = start();
          note_gap(error, result);
          break;
        case RecoveryAction::resume:
          outcome = snd_pcm_resume(pcm());
          break;
        case RecoveryAction::wait:
          sleep_until_ns(monotonic_ns() + period_ns());
          outcome = snd_pcm_resume(pcm());
          break;
        default:
          device_.pcm.reset();
          lost_at_ns_ = monotonic_ns();
          result = {WriteStatus::lost, error, 0};
          return false;
      }
      action = recovery_.acted({outcome, snd_pcm_state(pcm()) == SND_PCM_STATE_DISCONNECTED});
    }
  }

  void note_gap(int error, WriteResult& result) noexcept {
    const auto gap =
        static_cast<std::int64_t>(device_.buffer_frames - device_.period_frames);  // the silence ahead
    frames_ += gap;
    result.status = WriteStatus::restarted;
    result.error = error;
    result.lost_frames += gap;
  }

  // Lost: time goes on at the stream's own pace, and the device is tried again by its name.
  WriteResult absent() noexcept {
    sleep_until_ns(monotonic_ns() + period_ns());
    frames_ += config_.period_frames;
    if (recovery_.absent(monotonic_ns() - lost_at_ns_) != RecoveryAction::reopen)
      return {WriteStatus::lost, -ENODEV, 0};
    const int error = reopen();
    if (recovery_.reopened(error) != RecoveryAction::back) return {WriteStatus::lost, error, 0};
    stalls_ = 0;
    return {WriteStatus::reopened, 0, 0};
  }

  int reopen() noexcept {
    try {
      snd_config_update_free_global();  // the list of cards has changed
      device_ = open_alsa_device(config_, name_);
      const int error = start();
      if (error < 0) device_.pcm.reset();
      return error;
    } catch (const std::system_error& error) {
      return -error.code().value();
    } catch (const std::exception&) {
      return -EINVAL;  // it is back, but not as it was
    }
  }

  std::int64_t period_ns() const noexcept {
    return std::int64_t{1'000'000'000} * config_.period_frames / config_.rate_Hz;
  }

  OutputConfig config_;
  std::string name_;
  AlsaDevice device_;
  std::vector<std::int32_t> silence_;
  Recovery recovery_;
  std::int64_t frames_ = 0;
  std::int64_t lost_at_ns_ = 0;
  int stalls_ = 0;
  bool running_ = false;
};

}  // namespace

std::unique_ptr<Output> open_alsa(const OutputConfig& config, const std::string& name) {
  return std::make_unique<AlsaOutput>(config, name);
}

}  // namespace turnpoint::drive
