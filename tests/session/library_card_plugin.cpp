// A plug-in for alsa-lib: the device type `looped`, which is a LibraryCard.
#define PIC
#include <alsa/asoundlib.h>
#include <alsa/control_external.h>
#include <alsa/pcm_external.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>
#include <cstdio>

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

// The mixer. A key is the index of a control.
LibraryCard::Control& control(snd_ctl_ext_key_t key) { return card().controls.at(key); }

int control_count(snd_ctl_ext_t*) { return static_cast<int>(card().controls.size()); }

int list_control(snd_ctl_ext_t*, unsigned offset, snd_ctl_elem_id_t* id) {
  snd_ctl_elem_id_set_interface(id, SND_CTL_ELEM_IFACE_MIXER);
  snd_ctl_elem_id_set_name(id, control(offset).name.c_str());
  snd_ctl_elem_id_set_index(id, control(offset).index);
  return 0;
}

snd_ctl_ext_key_t find_control(snd_ctl_ext_t*, const snd_ctl_elem_id_t* id) {
  for (std::size_t k = 0; k < card().controls.size(); ++k)
    if (control(k).name == snd_ctl_elem_id_get_name(id) && control(k).index == snd_ctl_elem_id_get_index(id))
      return k;
  return SND_CTL_EXT_KEY_NOT_FOUND;
}

int describe_control(snd_ctl_ext_t*, snd_ctl_ext_key_t key, int* type, unsigned* access, unsigned* count) {
  using Kind = LibraryCard::Control::Kind;
  const auto kind = control(key).kind;
  *type = kind == Kind::level    ? SND_CTL_ELEM_TYPE_INTEGER
          : kind == Kind::toggle ? SND_CTL_ELEM_TYPE_BOOLEAN
                                 : SND_CTL_ELEM_TYPE_ENUMERATED;
  *access = SND_CTL_EXT_ACCESS_READWRITE;
  if (control(key).changes_itself) *access |= SND_CTL_EXT_ACCESS_VOLATILE;
  *count = kind == Kind::level ? 2 : 1;
  return 0;
}

int describe_level(snd_ctl_ext_t*, snd_ctl_ext_key_t, long* low, long* high, long* step) {
  *low = 0, *high = 207, *step = 1;
  return 0;
}

int describe_choice(snd_ctl_ext_t*, snd_ctl_ext_key_t, unsigned* items) {
  *items = 2;
  return 0;
}

int name_choice(snd_ctl_ext_t*, snd_ctl_ext_key_t, unsigned item, char* name, std::size_t size) {
  std::snprintf(name, size, "%s", item == 0 ? "Line" : "Phones");
  return 0;
}

int read_level(snd_ctl_ext_t*, snd_ctl_ext_key_t key, long* values) {
  values[0] = control(key).values[0];
  if (control(key).kind == LibraryCard::Control::Kind::level) values[1] = control(key).values[1];
  return 0;
}

int read_choice(snd_ctl_ext_t*, snd_ctl_ext_key_t key, unsigned* items) {
  *items = static_cast<unsigned>(control(key).values[0]);
  return 0;
}

void close_mixer(snd_ctl_ext_t* mixer) { delete mixer; }

const snd_ctl_ext_callback_t mixer_callbacks = [] {
  snd_ctl_ext_callback_t made{};
  made.close = close_mixer;
  made.elem_count = control_count;
  made.elem_list = list_control;
  made.find_elem = find_control;
  made.get_attribute = describe_control;
  made.get_integer_info = describe_level;
  made.get_enumerated_info = describe_choice;
  made.get_enumerated_name = name_choice;
  made.read_integer = read_level;
  made.read_enumerated = read_choice;
  return made;
}();

}  // namespace

extern "C" {

SND_CTL_PLUGIN_DEFINE_FUNC(looped) {
  static_cast<void>(root), static_cast<void>(conf);
  auto* mixer = new snd_ctl_ext_t{};
  mixer->version = SND_CTL_EXT_VERSION;
  mixer->callback = &mixer_callbacks;
  mixer->poll_fd = -1;
  std::snprintf(mixer->name, sizeof mixer->name, "a simulated sound card");
  if (const int error = snd_ctl_ext_create(mixer, name, mode); error < 0) {
    delete mixer;
    return error;
  }
  *handlep = mixer->handle;
  return 0;
}
SND_CTL_PLUGIN_SYMBOL(looped);

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
