#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace turnpoint::audio {

/// A simulated sound card, which the station's own ALSA output uses. In a program that links fake_pcm.cpp,
/// the card's functions replace those of alsa-lib, and its clock replaces CLOCK_MONOTONIC. Time passes only
/// when the test says so or when the program waits. For each frame of time the card plays one frame of its
/// buffer, or silence if the buffer is empty.
struct FakePcm {
  enum class State { prepared, running, xrun, suspended, gone };

  std::int64_t rate_Hz = 192000;
  std::int64_t period = 0, buffer = 0;
  int channels = 2;
  State state = State::prepared;
  /// Time in frames since the beginning, including frames in which nothing played.
  std::int64_t now = 0;
  /// numbers of frames written to the card and played by it since its last start
  std::int64_t written = 0, played = 0;
  int recorded_channel = 0;
  std::vector<std::int32_t> ring;
  std::vector<std::int32_t> heard;  ///< what channel 0 played, one sample per frame of time
  bool stamps = true;               ///< whether the card reports its position
  bool present = true;              ///< whether the card can be opened
  bool just_wrote = false;          ///< whether the program's last call was a write
  /// `before_call` is called before each call that the program makes while the device runs, to let time pass
  /// or to make the device fail. `before_write` is called only before writes, after the program has asked how
  /// much room the buffer has.
  std::function<void()> before_call, before_write;

  /// The card's capture has its own state. In each frame of time while it runs, it captures one frame:
  /// `wires` makes that frame from the one played `loop_delay` frames ago. Without `wires` it is silent.
  State capture_state = State::prepared;
  int capture_channels = 1;
  std::int64_t loop_delay = 0;
  std::function<void(std::span<const std::int32_t> played, std::span<std::int32_t> captured)> wires;
  /// numbers of frames that the card has captured and the program has read since the last start
  std::int64_t captured = 0, taken = 0;
  std::vector<std::int32_t> capture_ring, history;
  std::function<void()>
      before_read;  ///< called before each read, after the program has asked how many frames it can read

  void pass(std::int64_t frames);
  /// Makes the device stop by itself: by an underrun (xrun), because the machine is suspended (suspended), or
  /// because it is unplugged (gone).
  void fail(State how) { state = how; }
  std::int64_t queued() const { return written - played; }
  std::int64_t now_ns() const { return 1'000'000'000 + now * 1'000'000'000 / rate_Hz; }
};

/// The only card. reset_fake_pcm() replaces it with a new one.
FakePcm& fake_pcm();
void reset_fake_pcm();

}  // namespace turnpoint::audio
