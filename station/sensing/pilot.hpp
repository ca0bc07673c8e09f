#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "station/audio/burst.hpp"
#include "station/sensing/capture_block.hpp"

namespace turnpoint::sensing {

/// The pilot: a chirp that is played on an output channel and captured on the reference channel. It is used
/// to measure by how many frames the capture lags behind the playback, which is different each time the
/// devices are opened.
struct Pilot {
  int rate_Hz = 192000;
  double low_Hz = 22000;
  double high_Hz = 46000;      ///< highest frequency of the chirp; must be below 0.45 of the sampling rate
  std::int64_t frames = 1920;  ///< length of the chirp: 10 ms at 192 kHz; an even number
  double amplitude = 0.25;     ///< amplitude as a fraction of full scale
  std::int32_t channel = 0;    ///< output channel on which it is played
  double carrier_Hz = 0;       ///< frequency of a tone that is always on this channel; 0: none
};

/// Returns the pilot as a burst that any stream can play.
audio::Burst pilot_burst(const Pilot& pilot, std::int64_t start_frame);

/// A pilot that was found in the captured samples.
struct PilotEcho {
  /// Playback frame n is captured at frame n + delay. The delay's standard deviation is below 0.01 frames
  /// with noise at -40 dB.
  double delay_frames = 0;
  double level_dB = 0;  ///< captured amplitude relative to the played amplitude
  double likeness = 0;  ///< correlation of the capture with the pilot, 0 to 1
};

/// Collects the samples of the reference channel while a pilot is played, and finds the pilot in them.
/// Recognises either polarity. The envelope of the correlation shows in which period of the carrier the delay
/// lies, and the carrier's phase gives the exact delay. The path to the reference may turn the phase by up to
/// 60 degrees; such a turn counts as delay. A carrier on the channel is removed first. For an ordinary
/// thread. Allocates only in its constructor and in find().
class PilotListener {
 public:
  /// `start_frame` is the first playback frame of the pilot's burst. Captured frames are numbered by the same
  /// clock, apart from the delay.
  PilotListener(const Pilot& pilot, std::int64_t start_frame, int capture_channels, int reference_channel,
                double longest_delay_s = 0.5);

  /// Takes captured frames in order. Ignores frames that it does not need. Throws std::logic_error if a
  /// block's rate or number of channels is not as expected.
  void push(const CaptureBlock& block);

  /// True if all frames have been received, or if the capture lost some of them.
  bool complete() const noexcept { return lost_ || samples_.size() == wanted_; }

  /// Returns the delay, level and likeness of the captured pilot. Empty if frames are missing, if nothing
  /// like the pilot was captured (likeness below 0.8), or if it was captured more than once. Takes about 20
  /// ms.
  std::optional<PilotEcho> find() const;

 private:
  Pilot pilot_;
  std::int64_t start_frame_;
  int channels_, reference_;
  std::size_t wanted_;
  std::vector<double> samples_;
  bool lost_ = false;
};

}  // namespace turnpoint::sensing
