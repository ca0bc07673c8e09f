#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace turnpoint::drive {

/// A sound card in memory, below the station's own ALSA output. In a program that links fake_pcm.cpp, its
/// functions replace those of alsa-lib, and its clock replaces CLOCK_MONOTONIC. Time passes only when the
/// test says so or the program waits. In each frame of time it plays one frame of the buffer, or silence if
/// the buffer is empty.
struct FakePcm {
  enum class State { prepared, running, xrun, suspended, gone };

  std::int64_t rate_Hz = 192000;
  std::int64_t period = 0, buffer = 0;
  int channels = 2;
  State state = State::prepared;
  std::int64_t now = 0;                  ///< frames of time since the beginning, whether played or not
  std::int64_t written = 0, played = 0;  ///< counted since the device was started
  int recorded_channel = 0;
  std::vector<std::int32_t> ring;
  std::vector<std::int32_t> heard;  ///< one channel, one sample per frame of time
  bool stamps = true;               ///< true if it reports its position
  bool present = true;              ///< true if it can be opened
  bool just_wrote = false;          ///< true if the program's last call was a write
  /// `before_call` is called before each call that the program makes while the device runs, to let time pass
  /// or to make the device fail. `before_write` is called only before writes, which come after the program
  /// has looked for room.
  std::function<void()> before_call, before_write;

  void pass(std::int64_t frames);
  /// The device stops by itself: underrun (xrun), suspend of the machine (suspended), or unplugged (gone).
  void fail(State how) { state = how; }
  std::int64_t queued() const { return written - played; }
  std::int64_t now_ns() const { return 1'000'000'000 + now * 1'000'000'000 / rate_Hz; }
};

/// The only card. reset_fake_pcm() replaces it by a fresh one.
FakePcm& fake_pcm();
void reset_fake_pcm();

}  // namespace turnpoint::drive
