#pragma once
extern "C" {  // alsa-lib's header declares its per-thread error handler outside its own extern "C" block.
#include <alsa/asoundlib.h>
}

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "station/audio/output.hpp"

namespace turnpoint::audio {

/// The sample format of a device, little-endian: all 32 bits of a sample, or its upper 24 bits in three
/// bytes.
enum class SampleFormat { s32_le, s24_3le };

/// How a device arranges a frame in memory. A device may have more channels than the stream.
struct FrameLayout {
  SampleFormat format = SampleFormat::s32_le;
  int channels = 2;

  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(channels) * (format == SampleFormat::s32_le ? 4 : 3);
  }
  /// The number of bits that the format can carry.
  int bits() const noexcept { return format == SampleFormat::s32_le ? 32 : 24; }
};

/// Packs whole frames of `channels` interleaved samples into the device's layout. The samples are
/// left-aligned in 32 bits. Additional channels of the device carry zeros. `out` must be large enough, and
/// `channels` must not exceed the layout's.
void pack(std::span<const std::int32_t> samples, int channels, const FrameLayout& layout,
          std::span<unsigned char> out) noexcept;

struct PcmCloser {
  void operator()(snd_pcm_t* pcm) const noexcept { snd_pcm_close(pcm); }
};
using Pcm = std::unique_ptr<snd_pcm_t, PcmCloser>;

/// An open sound device. open_alsa_device() has checked that it does not alter the samples.
struct AlsaDevice {
  Pcm pcm;
  FrameLayout layout;  ///< how the device expects a frame in memory
  snd_pcm_uframes_t period_frames = 0;
  snd_pcm_uframes_t buffer_frames = 0;
  std::string chain;  ///< alsa-lib's own description of the plug-in chain that the samples pass through
};

enum class Direction { playback, capture };

/// Opens a device and checks it: conversions are off, its type is hw or an allowed plug-in, the rate is
/// exact, the format is S32_LE or else S24_3LE, the channels match the rig file, nothing in the chain
/// converts rates, and the kernel reports the same rate. Throws OutputRefused (with what was asked and what
/// is offered), or std::system_error with ENOENT, ENODEV, EBUSY or EACCES for a device that is currently not
/// available. A capture device must offer S32_LE; the depth of its converter is not checked.
AlsaDevice open_alsa_device(const OutputConfig& config, const std::string& name,
                            Direction direction = Direction::playback);

/// Reads a switch of the sound card behind an output `alsa:hw:...`, such as "Auto Mute Switch" of a PCM512x.
/// Returns true if it is on in any channel. Returns nothing if the output is not ALSA hardware, the card has
/// no such switch, or it cannot be read. Changes nothing.
std::optional<bool> card_switch(const std::string& output_uri, const std::string& name);

/// Returns alsa-lib's name for the card of a device: hw:CARD=NAME for alsa:hw:CARD=NAME,DEV=0 and for
/// alsa:plughw:CARD=NAME,DEV=0; "" if the device is not `alsa:`.
std::string card_of(const std::string& device_uri);

/// Reads the mixer of the sound card behind a device `alsa:...`: each level, switch and choice that somebody
/// can set, by its name (with its index if there are several of that name), as the values of its channels:
/// "207, 207", "on", "Line 1". Leaves out what the card changes by itself. Returns nothing if the device is
/// not on a card, or the card cannot be read. Changes nothing.
std::optional<std::map<std::string, std::string>> mixer_levels(const std::string& device_uri);

}  // namespace turnpoint::audio
