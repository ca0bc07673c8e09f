#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "station/audio/alsa_capture.hpp"
#include "station/audio/burst.hpp"
#include "station/rig/rig.hpp"
#include "station/simulation/setup.hpp"

namespace turnpoint::maintenance {

/// Passes everything that a sound device captures to a function, on an ordinary thread of its own.
class CaptureThread {
 public:
  using OnBlock = std::function<void(const audio::CapturedBlock&)>;

  /// Throws the errors of audio::open_capture().
  CaptureThread(const audio::OutputConfig& device, OnBlock on_block);

  /// Ends the thread, after everything that was captured until now has been passed on. Throws
  /// std::runtime_error if the device was disconnected.
  audio::CaptureCounters end();

 private:
  void take();

  const audio::OutputConfig device_;
  OnBlock on_block_;
  std::unique_ptr<audio::Capture> capture_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

/// What was captured while bursts were played. Captured frame k belongs to playback frame first_frame + k -
/// delay_frames, in the numbering of the bursts.
struct Captured {
  std::vector<std::vector<double>> channels;  ///< samples of all captured channels; 1 is full scale
  std::int64_t first_frame = 0;
  double delay_frames = 0;
};

/// Returns the samples that a burst plays on one channel, beginning with its first frame; 1 is full scale.
std::vector<double> rendered(const rig::Rig& rig, const audio::Burst& burst, int channel);

/// Plays the bursts in the simulated laboratory, and captures them there, while `load` rests on the surface.
Captured capture_simulated(const rig::Rig& rig, const std::vector<audio::Burst>& bursts,
                           const std::function<void(simulation::Setup&)>& laboratory,
                           const simulation::Load& load = {});

/// Plays a pilot (a chirp that shows the delay from playback to capture) and then the bursts on the rig's
/// sound card, and captures all of it with the same card (see play_armed()). The first burst must not start
/// before frame 2 * rate. Throws std::runtime_error if frames were lost, or if the pilot was not heard.
Captured capture_armed(const rig::Rig& rig, const std::vector<audio::Burst>& bursts);

}  // namespace turnpoint::maintenance
