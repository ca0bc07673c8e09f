// A plug-in for alsa-lib: the device type `looped`, which is a LibraryCard.
#define PIC
#include <alsa/asoundlib.h>
#include <alsa/pcm_external.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>

#include "tests/session/library_card.hpp"

namespace {

using turnpoint::LibraryCard;

LibraryCard& card() { return *turnpoint_library_card(); }

struct Looped {
  snd_pcm_ioplug_t io{};
  std::int64_t written = 0;  ///< frames that the program has written or read since the start
};

bool captures(const snd_pcm_ioplug_t* io) { return io->stream == SND_PCM_STREAM_CAPTURE; }

int prepare(snd_pcm_ioplug_t* io) {
  static_cast<Looped*>(io->private_data)->written = 0;
  return 0;
}
int start(snd_pcm_ioplug_t* io) {
  card().start(captures(io));
  return 0;
}
int stop(snd_pcm_ioplug_t*) { return 0; }

snd_pcm_sframes_t pointer(snd_pcm_ioplug_t* io) {
  if (io->state != SND_PCM_STATE_RUNNING) return 0;
  return card().position(captures(io)) % static_cast<std::int64_t>(io->buffer_size);
}

snd_pcm_sframes_t transfer(snd_pcm_ioplug_t* io, const snd_pcm_channel_area_t* areas,
                           snd_pcm_uframes_t offset, snd_pcm_uframes_t size) {
  auto& device = *static_cast<Looped*>(io->private_data);
  auto* samples = static_cast<std::int32_t*>(areas->addr) + offset * io->channels;
  const std::span<std::int32_t> block(samples, size * io->channels);
  captures(io) ? card().capture(device.written, block) : card().play(device.written, block);
  device.written += static_cast<std::int64_t>(size);
  return static_cast<snd_pcm_sframes_t>(size);
}

// The timer wakes a waiting program every two milliseconds; alsa-lib then looks at the pointer.
int wake(snd_pcm_ioplug_t* io, pollfd* descriptors, unsigned, unsigned short* events) {
  std::uint64_t ticks = 0;
  const auto got = ::read(descriptors->fd, &ticks, sizeof ticks);
  const auto ready = captures(io) ? POLLIN : POLLOUT;
  *events = static_cast<unsigned short>(got > 0 ? ready : 0);
  return 0;
}

int close_device(snd_pcm_ioplug_t* io) {
  ::close(io->poll_fd);
  delete static_cast<Looped*>(io->private_data);
  return 0;
}

const snd_pcm_ioplug_callback_t callbacks = [] {
  snd_pcm_ioplug_callback_t made{};
  made.start = start;
  made.stop = stop;
  made.pointer = pointer;
  made.transfer = transfer;
  made.prepare = prepare;
  made.poll_revents = wake;
  made.close = close_device;
  return made;
}();

int allow(snd_pcm_ioplug_t* io) {
  const std::array<unsigned, 1> access{SND_PCM_ACCESS_RW_INTERLEAVED}, format{SND_PCM_FORMAT_S32_LE};
  snd_pcm_ioplug_set_param_list(io, SND_PCM_IOPLUG_HW_ACCESS, 1, access.data());
  snd_pcm_ioplug_set_param_list(io, SND_PCM_IOPLUG_HW_FORMAT, 1, format.data());
  const auto channels =
      static_cast<unsigned>(captures(io) ? card().captured_channels : card().played_channels);
  snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_CHANNELS, channels, channels);
  snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_RATE, LibraryCard::kRate_Hz, LibraryCard::kRate_Hz);
  snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_PERIOD_BYTES, 64, 1 << 20);
  snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_BUFFER_BYTES, 128, 1 << 24);
  return snd_pcm_ioplug_set_param_minmax(io, SND_PCM_IOPLUG_HW_PERIODS, 2, 1024);
}

}  // namespace

extern "C" {

SND_PCM_PLUGIN_DEFINE_FUNC(looped) {
  static_cast<void>(root), static_cast<void>(conf);
  auto* device = new Looped;
  auto& io = device->io;
  io.version = SND_PCM_IOPLUG_VERSION;
  io.name = "a simulated sound card";
  io.callback = &callbacks;
  io.private_data = device;
  io.poll_fd = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  io.poll_events = POLLIN;  // of the timer; wake() turns it into the event that the program waits for
  const itimerspec every{{0, 2'000'000}, {0, 2'000'000}};
  ::timerfd_settime(io.poll_fd, 0, &every, nullptr);
  if (const int error = snd_pcm_ioplug_create(&io, name, stream, mode); error < 0) {
    close_device(&io);
    return error;
  }
  *pcmp = io.pcm;
  const int error = allow(&io);
  if (error < 0) snd_pcm_ioplug_delete(&io);
  return error;
}
SND_PCM_PLUGIN_SYMBOL(looped);

}  // extern "C"
