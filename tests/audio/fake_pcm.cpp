#include "tests/audio/fake_pcm.hpp"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>

#include "station/audio/alsa_device.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::audio {
namespace {

FakePcm card;

int failure(FakePcm::State state) {
  switch (state) {
    case FakePcm::State::xrun:
      return -EPIPE;
    case FakePcm::State::suspended:
      return -ESTRPIPE;
    case FakePcm::State::gone:
      return -ENODEV;
    default:
      return 0;
  }
}

int failure() { return failure(card.state); }

constexpr std::int64_t kHistory = 1 << 16;  // longest loop delay in frames

/// Returns the handle of the simulated capture device. It differs from the handle of the playback device.
snd_pcm_t* capture() { return reinterpret_cast<snd_pcm_t*>(&card.captured); }

/// Remembers what is played now, and captures what was played one loop delay ago.
void loop(std::span<const std::int32_t> playing) {
  const auto channels = static_cast<std::size_t>(card.channels);
  if (card.history.empty()) card.history.resize(static_cast<std::size_t>(kHistory) * channels);
  const auto at = [&](std::int64_t frame) {
    return std::span(card.history).subspan(static_cast<std::size_t>(frame % kHistory) * channels, channels);
  };
  std::copy(playing.begin(), playing.end(), at(card.now).begin());
  if (card.capture_state != FakePcm::State::running) return;
  const auto inputs = static_cast<std::size_t>(card.capture_channels);
  const auto captured =
      std::span(card.capture_ring)
          .subspan(static_cast<std::size_t>(card.captured++ % card.buffer) * inputs, inputs);
  std::fill(captured.begin(), captured.end(), 0);
  if (card.wires) card.wires(at(card.now - card.loop_delay + kHistory), captured);
}

void called() {
  if (card.state == FakePcm::State::running && card.before_call) card.before_call();
  card.just_wrote = false;
}

AlsaDevice open_capture_device(const OutputConfig& config) {
  card.rate_Hz = config.rate_Hz;
  card.period = config.period_frames;
  card.buffer = std::int64_t{config.period_frames} * config.periods;
  card.capture_channels = config.channels;
  card.capture_state = FakePcm::State::prepared;
  AlsaDevice device;
  device.pcm.reset(capture());
  device.layout.channels = config.channels;
  device.period_frames = static_cast<snd_pcm_uframes_t>(card.period);
  device.buffer_frames = static_cast<snd_pcm_uframes_t>(card.buffer);
  return device;
}

}  // namespace

FakePcm& fake_pcm() { return card; }
void reset_fake_pcm() { card = {}; }

// Lets time pass. Overwrites samples with silence once they are played, as the station asks alsa-lib to do.
void FakePcm::pass(std::int64_t frames) {
  std::vector<std::int32_t> playing;
  for (std::int64_t n = 0; n < frames; ++n, ++now) {
    std::int32_t sample = 0;
    playing.assign(static_cast<std::size_t>(channels), 0);
    if (state == State::running) {
      const auto at = static_cast<std::size_t>(played % buffer * channels);
      sample = ring[at + static_cast<std::size_t>(recorded_channel)];
      std::copy_n(ring.begin() + static_cast<std::ptrdiff_t>(at), channels, playing.begin());
      std::fill_n(ring.begin() + static_cast<std::ptrdiff_t>(at), channels, 0);
      ++played;
    }
    heard.push_back(sample);
    loop(playing);
  }
}

AlsaDevice open_alsa_device(const OutputConfig& config, const std::string& name, Direction direction) {
  if (!card.present) throw std::system_error(ENODEV, std::generic_category(), name);
  if (direction == Direction::capture) return open_capture_device(config);
  card.rate_Hz = config.rate_Hz;
  card.period = config.period_frames;
  card.buffer = std::int64_t{config.period_frames} * config.periods;
  card.channels = config.channels;
  card.state = FakePcm::State::prepared;
  AlsaDevice device;
  device.pcm.reset(reinterpret_cast<snd_pcm_t*>(&card));
  device.layout.channels = config.channels;
  device.period_frames = static_cast<snd_pcm_uframes_t>(card.period);
  device.buffer_frames = static_cast<snd_pcm_uframes_t>(card.buffer);
  return device;
}

}  // namespace turnpoint::audio

using turnpoint::audio::capture;
using turnpoint::audio::card;
using turnpoint::audio::FakePcm;

extern "C" {

int snd_pcm_close(snd_pcm_t*) { return 0; }
int snd_pcm_drop(snd_pcm_t*) { return 0; }
int snd_pcm_nonblock(snd_pcm_t*, int) { return 0; }
int snd_config_update_free_global() { return 0; }
int snd_pcm_resume(snd_pcm_t*) { return -ENOSYS; }
snd_pcm_type_t snd_pcm_type(snd_pcm_t*) { return SND_PCM_TYPE_HW; }

int snd_pcm_prepare(snd_pcm_t* pcm) {
  if (pcm == capture()) {
    if (card.capture_state == FakePcm::State::gone) return -ENODEV;
    card.capture_state = FakePcm::State::prepared;
    card.captured = card.taken = 0;
    card.capture_ring.assign(static_cast<std::size_t>(card.buffer * card.capture_channels), 0);
    return 0;
  }
  if (card.state == FakePcm::State::gone) return -ENODEV;
  card.state = FakePcm::State::prepared;
  card.written = card.played = 0;
  card.ring.assign(static_cast<std::size_t>(card.buffer * card.channels), 0);
  return 0;
}

int snd_pcm_start(snd_pcm_t* pcm) {
  (pcm == capture() ? card.capture_state : card.state) = FakePcm::State::running;
  return 0;
}

snd_pcm_state_t snd_pcm_state(snd_pcm_t* pcm) {
  return (pcm == capture() ? card.capture_state : card.state) == FakePcm::State::gone
             ? SND_PCM_STATE_DISCONNECTED
             : SND_PCM_STATE_RUNNING;
}

snd_pcm_sframes_t snd_pcm_avail(snd_pcm_t* pcm) {
  if (pcm == capture()) {
    const int failed = turnpoint::audio::failure(card.capture_state);
    return failed ? failed : card.captured - card.taken;
  }
  turnpoint::audio::called();
  if (const int failed = turnpoint::audio::failure()) return failed;
  return card.buffer - card.queued();
}

int snd_pcm_wait(snd_pcm_t* pcm, int) {
  if (pcm == capture()) {
    if (card.capture_state == FakePcm::State::running)
      card.pass(std::max<std::int64_t>(0, card.period - (card.captured - card.taken)));
    const int failed = turnpoint::audio::failure(card.capture_state);
    return failed ? failed : 1;
  }
  turnpoint::audio::called();
  if (card.state == FakePcm::State::running)
    card.pass(std::max<std::int64_t>(0, card.queued() - (card.buffer - card.period)));
  const int failed = turnpoint::audio::failure();
  return failed ? failed : 1;
}

snd_pcm_sframes_t snd_pcm_writei(snd_pcm_t*, const void* frames, snd_pcm_uframes_t size) {
  if (card.state == FakePcm::State::running && card.before_write) card.before_write();
  if (const int failed = turnpoint::audio::failure()) return failed;
  const auto taken =
      std::clamp<std::int64_t>(card.buffer - card.queued(), 0, static_cast<std::int64_t>(size));
  card.just_wrote = true;
  const auto* samples = static_cast<const std::int32_t*>(frames);
  for (std::int64_t n = 0; n < taken; ++n, ++card.written)
    std::copy_n(samples + n * card.channels, card.channels,
                card.ring.begin() + static_cast<std::ptrdiff_t>(card.written % card.buffer * card.channels));
  return taken > 0 ? taken : -EAGAIN;
}

snd_pcm_sframes_t snd_pcm_readi(snd_pcm_t*, void* frames, snd_pcm_uframes_t size) {
  if (const int failed = turnpoint::audio::failure(card.capture_state)) return failed;
  if (card.before_read) card.before_read();
  const auto done = std::min<std::int64_t>(card.captured - card.taken, static_cast<std::int64_t>(size));
  auto* samples = static_cast<std::int32_t*>(frames);
  for (std::int64_t n = 0; n < done; ++n, ++card.taken)
    std::copy_n(card.capture_ring.begin() +
                    static_cast<std::ptrdiff_t>(card.taken % card.buffer * card.capture_channels),
                card.capture_channels, samples + n * card.capture_channels);
  return done > 0 ? done : -EAGAIN;
}

snd_pcm_sframes_t snd_pcm_forward(snd_pcm_t* pcm, snd_pcm_uframes_t frames) {
  if (pcm == capture()) {
    if (const int failed = turnpoint::audio::failure(card.capture_state)) return failed;
    card.taken += static_cast<std::int64_t>(frames);
    return static_cast<snd_pcm_sframes_t>(frames);
  }
  if (const int failed = turnpoint::audio::failure()) return failed;
  card.written += static_cast<std::int64_t>(frames);
  return static_cast<snd_pcm_sframes_t>(frames);
}

int snd_pcm_htimestamp(snd_pcm_t*, snd_pcm_uframes_t* avail, snd_htimestamp_t* stamp) {
  turnpoint::audio::called();
  if (const int failed = turnpoint::audio::failure()) return failed;
  *avail = static_cast<snd_pcm_uframes_t>(std::max<std::int64_t>(0, card.buffer - card.queued()));
  stamp->tv_sec = card.stamps ? card.now_ns() / 1'000'000'000 : 0;
  stamp->tv_nsec = card.stamps ? card.now_ns() % 1'000'000'000 : 0;
  return 0;
}

}  // extern "C"

namespace turnpoint::system {

std::int64_t monotonic_ns() noexcept { return audio::card.now_ns(); }
std::int64_t raw_minus_monotonic_ns() noexcept { return 0; }
void sleep_until_ns(std::int64_t time_ns) noexcept {
  while (audio::card.now_ns() < time_ns) audio::card.pass(1);
}

}  // namespace turnpoint::system
