#include "station/audio/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <exception>
#include <optional>
#include <system_error>

#include "station/audio/alsa_device.hpp"
#include "station/audio/recovery.hpp"
#include "station/core/usage_error.hpp"
#include "station/system/clocks.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::audio {
namespace {

class NullOutput final : public Output {
 public:
  explicit NullOutput(OutputConfig config) : config_(std::move(config)) {}
  const OutputConfig& config() const noexcept override { return config_; }
  WriteResult write(std::span<const std::int32_t>) noexcept override { return {}; }
  std::optional<Position> position() noexcept override { return std::nullopt; }
  void finish() override {}
  bool paced() const noexcept override { return false; }

 private:
  OutputConfig config_;
};

}  // namespace

Format format_of(const OutputConfig& config) noexcept {
  return {config.rate_Hz, config.channels, config.bits};
}

std::unique_ptr<Output> open_output(const OutputConfig& config) {
  if (config.period_frames < 16 || config.period_frames > 65536 || config.periods < 2 || config.periods > 64)
    throw core::UsageError(
        fmt::format("output with {} periods of {} frames; allowed are 2 to 64 periods of 16 to 65536 frames",
                    config.periods, config.period_frames));
  const auto colon = config.uri.find(':');
  const std::string scheme = config.uri.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : config.uri.substr(colon + 1);
  if (scheme == "null" && colon != std::string::npos && rest.empty())
    return std::make_unique<NullOutput>(config);
  if (scheme == "wav" && !rest.empty()) return open_wav(config, rest);
  if (scheme == "alsa" && !rest.empty()) return open_alsa(config, rest);
  throw core::UsageError(fmt::format("output '{}'; allowed are null:, wav:FILE and alsa:NAME", config.uri));
}

namespace {

class AlsaOutput final : public Output {
 public:
  AlsaOutput(OutputConfig config, const std::string& name)
      : config_(std::move(config)),
        name_(name),
        device_(open_alsa_device(config_, name)),
        packed_(device_.layout.bytes() * device_.buffer_frames) {}

  const OutputConfig& config() const noexcept override { return config_; }
  bool paced() const noexcept override { return true; }

  WriteResult write(std::span<const std::int32_t> interleaved) noexcept override {
    const auto frames = static_cast<std::int64_t>(interleaved.size()) / config_.channels;
    if (recovery_.lost()) return absent(frames);
    WriteResult result;
    // Start the device only when the first block has been written. Starting it when it is opened would cause
    // an underrun.
    if (!running_) {
      running_ = true;
      if (const int error = start(); error < 0) follow(recovery_.transferred({error}), error, frames, result);
    }
    while (result.status == WriteStatus::ok && result.taken < frames) {
      const snd_pcm_sframes_t done = transfer(interleaved.data() + result.taken * config_.channels,
                                              static_cast<std::size_t>(frames - result.taken), result);
      if (done > 0) {
        result.taken += done;
        frames_ += done;
      } else if (result.status == WriteStatus::ok) {
        const bool gone = snd_pcm_state(pcm()) == SND_PCM_STATE_DISCONNECTED;
        follow(recovery_.transferred({static_cast<int>(done), gone}), static_cast<int>(done), frames, result);
      }
    }
    return result;
  }

  // Returns how many frames have left the device's buffer, with the driver's time stamp of this count.
  std::optional<Position> position() noexcept override {
    if (recovery_.lost()) return std::nullopt;
    snd_pcm_uframes_t free = 0;
    snd_htimestamp_t stamp{};
    if (snd_pcm_htimestamp(pcm(), &free, &stamp) < 0 || free > device_.buffer_frames) return std::nullopt;
    if (stamp.tv_sec == 0 && stamp.tv_nsec == 0) return std::nullopt;
    note_played(free);
    const auto queued = static_cast<std::int64_t>(device_.buffer_frames - free);
    return Position{frames_ - queued, std::int64_t{1'000'000'000} * stamp.tv_sec + stamp.tv_nsec};
  }

  std::vector<system::MemoryRange> memory() const override {
    return {system::range_of(*this), system::range_of(packed_)};
  }
  // alsa-lib's structures are opaque, so the memory that they use is not known here and cannot be locked.
  std::string memory_left_out() const override { return "alsa-lib's own objects"; }

  void finish() override {
    if (!device_.pcm) return;
    snd_pcm_nonblock(pcm(), 0);
    snd_pcm_drop(pcm());
    device_.pcm.reset();
  }

 private:
  snd_pcm_t* pcm() const noexcept { return device_.pcm.get(); }

  // Prepares the device, fills its buffer with silence and starts it. The count of frames starts after this
  // silence.
  int start() noexcept {
    snd_pcm_drop(pcm());  // a resumed device still has its old buffer contents
    if (const int error = snd_pcm_prepare(pcm()); error < 0) return error;
    const snd_pcm_uframes_t ahead = device_.buffer_frames - device_.period_frames;
    std::fill(packed_.begin(), packed_.end(), '\0');
    const snd_pcm_sframes_t written = snd_pcm_writei(pcm(), packed_.data(), ahead);
    if (written < 0) return static_cast<int>(written);
    return snd_pcm_start(pcm());
  }

  // Waits until the device's buffer has room and writes as many frames as fit. Returns the number of frames
  // written, or a negative errno.
  snd_pcm_sframes_t transfer(const std::int32_t* at, std::size_t frames, WriteResult& result) noexcept {
    const auto buffer = static_cast<snd_pcm_sframes_t>(device_.buffer_frames);
    const auto period = static_cast<snd_pcm_sframes_t>(device_.period_frames);
    snd_pcm_sframes_t room = snd_pcm_avail(pcm());
    if (room >= 0 && room < period) {
      const int periods_ms = static_cast<int>(4000LL * config_.period_frames / config_.rate_Hz) + 100;
      const int ready = snd_pcm_wait(pcm(), periods_ms);
      if (ready < 0) return ready;
      if (ready == 0) return stalled();
      stalls_ = 0;
      room = snd_pcm_avail(pcm());  // the device may have played its whole buffer during the wait
    }
    if (room < 0) return room;
    // If less than an eighth of a period is queued, the device could run out of samples during the write.
    // Plug-ins without a device (null, file) never have anything queued.
    const bool hardware = snd_pcm_type(pcm()) == SND_PCM_TYPE_HW;
    const snd_pcm_sframes_t queued = buffer - room;
    if (queued < (hardware ? period / 8 + 1 : 0))
      return skip(std::max(period - queued, static_cast<snd_pcm_sframes_t>(frames)), result);
    note_played(static_cast<snd_pcm_uframes_t>(room));
    const auto size = std::min(frames, static_cast<std::size_t>(device_.buffer_frames));
    pack({at, size * static_cast<std::size_t>(config_.channels)}, config_.channels, device_.layout, packed_);
    const snd_pcm_sframes_t done = snd_pcm_writei(pcm(), packed_.data(), size);
    if (hardware && done > 0 && snd_pcm_avail(pcm()) + done > buffer) return overtaken(done, frames, result);
    return done;
  }

  // Called when the device has run out of samples and plays silence. Moves the write position forward by
  // `late` frames, so that the device plays silence for these frames too.
  snd_pcm_sframes_t skip(snd_pcm_sframes_t late, WriteResult& result) noexcept {
    const snd_pcm_sframes_t skipped = snd_pcm_forward(pcm(), static_cast<snd_pcm_uframes_t>(late));
    if (skipped < 0) return skipped;
    if (skipped < late) return -EPIPE;
    frames_ += skipped;
    result.status = WriteStatus::skipped;
    result.error = -EPIPE;
    result.passed = skipped;
    return 0;
  }

  // Called when the device ran out of samples while a block was written. Counts the frames already written as
  // lost and skips the rest of the block.
  snd_pcm_sframes_t overtaken(snd_pcm_sframes_t done, std::size_t frames, WriteResult& result) noexcept {
    result.taken += done;
    result.dropped = done;
    frames_ += done;
    return skip(static_cast<snd_pcm_sframes_t>(frames) - done, result);
  }

  void note_played(snd_pcm_uframes_t room) noexcept {
    played_ = std::max(played_, frames_ - static_cast<std::int64_t>(device_.buffer_frames - room));
  }

  // Called when a wait for room in the buffer ended without room and without an error. After five such waits
  // the device counts as lost.
  int stalled() noexcept { return ++stalls_ > 5 ? -ENODEV : -EAGAIN; }

  // Carries out the recovery actions, one after another, until the device plays again or is lost.
  void follow(RecoveryAction action, int error, std::int64_t frames, WriteResult& result) noexcept {
    while (action != RecoveryAction::go_on) {
      int outcome = 0;
      switch (action) {
        case RecoveryAction::restart:
          outcome = start();
          if (outcome >= 0) note_gap(error, result);
          break;
        case RecoveryAction::resume:
          outcome = snd_pcm_resume(pcm());
          break;
        case RecoveryAction::wait:
          system::sleep_until_ns(system::monotonic_ns() + period_ns());
          outcome = snd_pcm_resume(pcm());
          break;
        default:
          return lose(error, frames, result);
      }
      action = recovery_.acted({outcome, snd_pcm_state(pcm()) == SND_PCM_STATE_DISCONNECTED});
    }
  }

  // Called after a restart. Counts the silence that start() wrote as frames that passed, and the frames that
  // the device had not played yet as dropped.
  void note_gap(int error, WriteResult& result) noexcept {
    const auto gap = static_cast<std::int64_t>(device_.buffer_frames - device_.period_frames);
    result.status = WriteStatus::restarted;
    result.error = error;
    result.passed = gap;
    result.dropped = frames_ - played_;
    frames_ += gap;
    played_ = frames_ - gap;
  }

  void lose(int error, std::int64_t frames, WriteResult& result) noexcept {
    device_.pcm.reset();
    lost_at_ns_ = system::monotonic_ns();
    if (result.status == WriteStatus::ok) result.dropped = frames_ - played_;
    const auto passed = std::max(result.passed, frames - result.taken);
    frames_ += passed - result.passed;
    played_ = frames_;
    result.status = WriteStatus::lost;
    result.error = error;
    result.passed = passed;
  }

  // The device is lost. Keep the stream's time running at its nominal rate and try to reopen the device by
  // name.
  WriteResult absent(std::int64_t frames) noexcept {
    system::sleep_until_ns(system::monotonic_ns() + period_ns());
    frames_ += frames;
    played_ = frames_;
    WriteResult result{WriteStatus::lost, -ENODEV, 0, frames, 0};
    if (recovery_.absent(system::monotonic_ns() - lost_at_ns_) != RecoveryAction::reopen) return result;
    result.error = reopen();
    if (recovery_.reopened(result.error) != RecoveryAction::back) return result;
    stalls_ = 0;
    result.status = WriteStatus::reopened;
    return result;
  }

  int reopen() noexcept {
    try {
      snd_config_update_free_global();  // make alsa-lib read the list of cards again
      device_ = open_alsa_device(config_, name_);
      packed_.resize(device_.layout.bytes() * device_.buffer_frames);
      const int error = start();
      if (error < 0) device_.pcm.reset();
      return error;
    } catch (const std::system_error& error) {
      return -error.code().value();
    } catch (const std::exception&) {
      return -EINVAL;  // the device is back, but its properties have changed
    }
  }

  std::int64_t period_ns() const noexcept {
    return std::int64_t{1'000'000'000} * config_.period_frames / config_.rate_Hz;
  }

  OutputConfig config_;
  std::string name_;
  AlsaDevice device_;
  std::vector<unsigned char> packed_;  ///< frames in the device's own sample format
  Recovery recovery_;
  std::int64_t frames_ = 0;  ///< number of frames written or skipped so far
  std::int64_t played_ = 0;  ///< number of frames, of those in frames_, that are known to have been played
  std::int64_t lost_at_ns_ = 0;
  int stalls_ = 0;
  bool running_ = false;
};

}  // namespace

std::unique_ptr<Output> open_alsa(const OutputConfig& config, const std::string& name) {
  return std::make_unique<AlsaOutput>(config, name);
}

namespace {

static_assert(std::endian::native == std::endian::little, "RIFF files are little-endian");

constexpr std::size_t header_bytes = 68;
constexpr std::uint64_t most_bytes = 0xffffffffu - header_bytes;

template <typename T>
void put(std::array<char, header_bytes>& header, std::size_t at, T value) {
  std::memcpy(header.data() + at, &value, sizeof value);
}

std::array<char, header_bytes> header_of(const OutputConfig& config, std::uint32_t data_bytes) {
  std::array<char, header_bytes> h{};
  // The GUID KSDATAFORMAT_SUBTYPE_PCM without its first two bytes, which are the format tag.
  constexpr unsigned char pcm_tail[14] = {0, 0, 0, 0, 0x10, 0, 0x80, 0, 0, 0xaa, 0, 0x38, 0x9b, 0x71};
  const auto channels = static_cast<std::uint16_t>(config.channels);
  const auto rate = static_cast<std::uint32_t>(config.rate_Hz);
  std::memcpy(h.data(), "RIFF", 4);
  put(h, 4, static_cast<std::uint32_t>(header_bytes - 8 + data_bytes));
  std::memcpy(h.data() + 8, "WAVEfmt ", 8);
  put(h, 16, std::uint32_t{40});
  put(h, 20, std::uint16_t{0xfffe});
  put(h, 22, channels);
  put(h, 24, rate);
  put(h, 28, rate * channels * 4u);
  put(h, 32, static_cast<std::uint16_t>(channels * 4));
  put(h, 34, std::uint16_t{32});
  put(h, 36, std::uint16_t{22});
  put(h, 38, static_cast<std::uint16_t>(config.bits));
  put(h, 44, std::uint16_t{1});
  std::memcpy(h.data() + 46, pcm_tail, sizeof pcm_tail);
  std::memcpy(h.data() + 60, "data", 4);
  put(h, 64, data_bytes);
  return h;
}

class WavOutput final : public Output {
 public:
  WavOutput(OutputConfig config, const std::string& path)
      : config_(std::move(config)), path_(path), file_(path) {
    const auto header = header_of(config_, 0);
    file_->write({header.data(), header.size()});
  }

  // A session that was interrupted keeps what it has played so far.
  ~WavOutput() override {
    try {
      finish();
    } catch (const std::exception&) {
      // whoever wants to know calls finish()
    }
  }

  const OutputConfig& config() const noexcept override { return config_; }
  bool paced() const noexcept override { return false; }
  std::optional<Position> position() noexcept override { return std::nullopt; }

  WriteResult write(std::span<const std::int32_t> interleaved) noexcept override {
    if (error_ == 0 && data_bytes_ + interleaved.size_bytes() > most_bytes) error_ = EFBIG;
    if (error_ == 0) error_ = written(interleaved);
    if (error_ != 0)
      return {WriteStatus::lost, -error_, 0,
              static_cast<std::int64_t>(interleaved.size()) / config_.channels};
    data_bytes_ += interleaved.size_bytes();
    return {};
  }

  void finish() override {
    if (!file_) return;
    auto file = std::move(*file_);
    file_.reset();
    if (error_ != 0) throw std::system_error(error_, std::generic_category(), "wav:" + path_);
    const auto header = header_of(config_, static_cast<std::uint32_t>(data_bytes_));
    file.write_start({header.data(), header.size()});
    file.commit();
  }

 private:
  /// Returns 0 or the errno.
  int written(std::span<const std::int32_t> interleaved) noexcept try {
    file_->write({reinterpret_cast<const char*>(interleaved.data()), interleaved.size_bytes()});
    return 0;
  } catch (const std::system_error& error) {
    return error.code().value();
  }

  OutputConfig config_;
  std::string path_;
  std::optional<system::FileWriter> file_;  ///< empty after finish()
  int error_ = 0;
  std::uint64_t data_bytes_ = 0;
};

}  // namespace

std::unique_ptr<Output> open_wav(const OutputConfig& config, const std::string& path) {
  return std::make_unique<WavOutput>(config, path);
}

}  // namespace turnpoint::audio
