#include "tests/drive/fake_pcm.hpp"

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>

#include "station/drive/alsa_device.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::drive {
namespace {

FakePcm card;

int failure() {
  switch (card.state) {
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

void called() {
  if (card.state == FakePcm::State::running && card.before_call) card.before_call();
  card.just_wrote = false;
}

}  // namespace

FakePcm& fake_pcm() { return card; }
void reset_fake_pcm() { card = {}; }

// Overwrites samples with silence once they are played. The station asks alsa-lib to do the same.
void FakePcm::pass(std::int64_t frames) {
  for (std::int64_t n = 0; n < frames; ++n, ++now) {
    std::int32_t sample = 0;
    if (state == State::running) {
      const auto at = static_cast<std::size_t>(played % buffer * channels);
      sample = ring[at + static_cast<std::size_t>(recorded_channel)];
      std::fill_n(ring.begin() + static_cast<std::ptrdiff_t>(at), channels, 0);
      ++played;
    }
    heard.push_back(sample);
  }
}

AlsaDevice open_alsa_device(const OutputConfig& config, const std::string& name) {
  if (!card.present) throw std::system_error(ENODEV, std::generic_category(), name);
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

}  // namespace turnpoint::drive

using turnpoint::drive::card;
using turnpoint::drive::FakePcm;

extern "C" {

int snd_pcm_close(snd_pcm_t*) { return 0; }
int snd_pcm_drop(snd_pcm_t*) { return 0; }
int snd_pcm_nonblock(snd_pcm_t*, int) { return 0; }
int snd_config_update_free_global() { return 0; }
int snd_pcm_resume(snd_pcm_t*) { return -ENOSYS; }
snd_pcm_type_t snd_pcm_type(snd_pcm_t*) { return SND_PCM_TYPE_HW; }

int snd_pcm_prepare(snd_pcm_t*) {
  if (card.state == FakePcm::State::gone) return -ENODEV;
  card.state = FakePcm::State::prepared;
  card.written = card.played = 0;
  card.ring.assign(static_cast<std::size_t>(card.buffer * card.channels), 0);
  return 0;
}

int snd_pcm_start(snd_pcm_t*) {
  card.state = FakePcm::State::running;
  return 0;
}

snd_pcm_state_t snd_pcm_state(snd_pcm_t*) {
  return card.state == FakePcm::State::gone ? SND_PCM_STATE_DISCONNECTED : SND_PCM_STATE_RUNNING;
}

snd_pcm_sframes_t snd_pcm_avail(snd_pcm_t*) {
  turnpoint::drive::called();
  if (const int failed = turnpoint::drive::failure()) return failed;
  return card.buffer - card.queued();
}

int snd_pcm_wait(snd_pcm_t*, int) {
  turnpoint::drive::called();
  if (card.state == FakePcm::State::running)
    card.pass(std::max<std::int64_t>(0, card.queued() - (card.buffer - card.period)));
  const int failed = turnpoint::drive::failure();
  return failed ? failed : 1;
}

snd_pcm_sframes_t snd_pcm_writei(snd_pcm_t*, const void* frames, snd_pcm_uframes_t size) {
  if (card.state == FakePcm::State::running && card.before_write) card.before_write();
  if (const int failed = turnpoint::drive::failure()) return failed;
  const auto taken =
      std::clamp<std::int64_t>(card.buffer - card.queued(), 0, static_cast<std::int64_t>(size));
  card.just_wrote = true;
  const auto* samples = static_cast<const std::int32_t*>(frames);
  for (std::int64_t n = 0; n < taken; ++n, ++card.written)
    std::copy_n(samples + n * card.channels, card.channels,
                card.ring.begin() + static_cast<std::ptrdiff_t>(card.written % card.buffer * card.channels));
  return taken > 0 ? taken : -EAGAIN;
}

snd_pcm_sframes_t snd_pcm_forward(snd_pcm_t*, snd_pcm_uframes_t frames) {
  if (const int failed = turnpoint::drive::failure()) return failed;
  card.written += static_cast<std::int64_t>(frames);
  return static_cast<snd_pcm_sframes_t>(frames);
}

int snd_pcm_htimestamp(snd_pcm_t*, snd_pcm_uframes_t* avail, snd_htimestamp_t* stamp) {
  turnpoint::drive::called();
  if (const int failed = turnpoint::drive::failure()) return failed;
  *avail = static_cast<snd_pcm_uframes_t>(std::max<std::int64_t>(0, card.buffer - card.queued()));
  stamp->tv_sec = card.stamps ? card.now_ns() / 1'000'000'000 : 0;
  stamp->tv_nsec = card.stamps ? card.now_ns() % 1'000'000'000 : 0;
  return 0;
}

}  // extern "C"

namespace turnpoint::system {

std::int64_t monotonic_ns() noexcept { return drive::card.now_ns(); }
std::int64_t raw_minus_monotonic_ns() noexcept { return 0; }
void sleep_until_ns(std::int64_t time_ns) noexcept {
  while (drive::card.now_ns() < time_ns) drive::card.pass(1);
}

}  // namespace turnpoint::system
