#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace turnpoint {

/// A simulated sound card behind the real alsa-lib: the plug-in in library_card_plugin.cpp passes played
/// samples on to it, and captured samples from it. It plays and captures in real time, and captures what it
/// has played `delay_frames` before, as `wires` say. alsa-lib does everything else: opening, parameters,
/// buffers, pointers and waiting.
struct LibraryCard {
  static constexpr int kRate_Hz = 192000;

  std::function<void(std::span<const std::int32_t> played, std::span<std::int32_t> captured,
                     std::int64_t frame)>
      wires;
  int played_channels = 0, captured_channels = 0;
  std::int64_t delay_frames = 40'000;  ///< longer than the buffer of the playback

  /// A control of the card's mixer.
  struct Control {
    enum class Kind { level, toggle, choice } kind = Kind::level;
    std::string name;
    std::array<long, 2> values{};  ///< of both channels; a choice is 0 (Line) or 1 (Phones)
    bool changes_itself = false;   ///< such as a level meter
    unsigned index = 0;
  };
  std::vector<Control> controls = {};

  static std::int64_t frame_now();

  // The plug-in calls these functions on the threads that use the devices. Frames count from the start of
  // the device.
  void start(bool capture);
  std::int64_t position(bool capture) const;
  void play(std::int64_t first, std::span<const std::int32_t> samples);
  void capture(std::int64_t first, std::span<std::int32_t> samples);

 private:
  mutable std::mutex mutex_;
  std::int64_t started_[2] = {0, 0};  ///< frame of the clock at which playback and capture have started
  std::vector<std::int32_t> played_;
};

}  // namespace turnpoint

/// The card that the plug-in uses. The plug-in finds this function in the test program.
extern "C" turnpoint::LibraryCard* turnpoint_library_card();
