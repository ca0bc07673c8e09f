#pragma once
extern "C" {  // alsa-lib's header declares its per-thread error handler outside of its own
#include <alsa/asoundlib.h>
}

#include <memory>
#include <string>

#include "station/drive/frame_layout.hpp"
#include "station/drive/output.hpp"

namespace turnpoint::drive {

struct PcmCloser {
  void operator()(snd_pcm_t* pcm) const noexcept { snd_pcm_close(pcm); }
};
using Pcm = std::unique_ptr<snd_pcm_t, PcmCloser>;

/// A device that is prepared and proven to take the samples as they are.
struct AlsaDevice {
  Pcm pcm;
  FrameLayout layout;  ///< what it is to be written
  snd_pcm_uframes_t period_frames = 0;
  snd_pcm_uframes_t buffer_frames = 0;
  std::string chain;  ///< alsa-lib's own description of what the samples pass through
};

/// Opens and checks: conversions switched off, type hw or allowed, exact rate, S32_LE or
/// else S24_3LE, the channels that the rig says, no rate converter
/// anywhere in the chain, and the kernel's own record of the rate. Throws OutputRefused (what was asked, what
/// is offered), or std::system_error with ENOENT, ENODEV, EBUSY, EACCES for a device that cannot be had now.
AlsaDevice open_alsa_device(const OutputConfig& config, const std::string& name);

}  // namespace turnpoint::drive
