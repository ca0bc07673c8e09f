#pragma once
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "station/audio/engine.hpp"
#include "station/core/records.hpp"
#include "station/io/trigger_lines.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/trigger_decoder.hpp"

namespace turnpoint::session {

/// How a rig sends trigger codes and receives the pulses of other devices.
struct TriggerSetup {
  std::optional<rig::Marker> marker;                ///< the rig's marker, if it carries codes
  std::int64_t bit_frames = 0;                      ///< length of one bit on the marker channel
  bool lines = false;                               ///< true if codes are also set on GPIO lines
  std::optional<int> marker_channel, sync_channel;  ///< captured channels of the marker and of the pulses
  /// true if a simulated session receives a pulse each second
  bool simulated_sync = false;

  bool active() const { return marker.has_value() || lines; }
};
TriggerSetup trigger_setup_of(const rig::Rig& rig);

/// A trigger code that the session sends, and what became of it.
struct Trigger {
  protocol::TriggerEvent event = protocol::TriggerEvent::trial;
  int code = 0;
  int trial_index = 0;
  std::int64_t frame = 0;                ///< first frame of the code on the marker channel
  std::int64_t time_ns = 0;              ///< time at which that frame leaves the converter
  bool cut = false;                      ///< the code was cut off before its end on the marker channel
  std::string refused;                   ///< why the code was not sent; "" if it was
  std::optional<std::int64_t> lines_ns;  ///< time at which the code was set on the lines
  enum class ReadBack { none, pending, right, missed, lost };
  ReadBack read_back = ReadBack::none;  ///< `lost` means that the capture around the code is incomplete
  double error_frames = 0;              ///< captured frame of the code minus the frame at which it was sent
};

/// Finds codes and pulses in the captured marker and sync channels. One thread pushes blocks, another takes
/// the results.
class TriggerCapture {
 public:
  /// `delay_frames`: from a played frame to the same frame in the capture.
  TriggerCapture(const TriggerSetup& setup, double delay_frames);
  void push(const sensing::CaptureBlock& block);

  struct News {
    std::vector<sensing::DecodedTrigger> heard;  ///< codes that were found, with their playback frames
    std::vector<std::int64_t> edges;             ///< playback frames at which pulses of other devices began
    /// captured ranges of playback frames, in order
    std::vector<std::pair<std::int64_t, std::int64_t>> captured;
  };
  News take();

 private:
  std::mutex mutex_;
  const double delay_frames_;
  std::optional<sensing::TriggerDecoder> decoder_;
  std::optional<sensing::EdgeFinder> edges_;
  News news_;
};

/// Sends the trigger codes of a session, and compares them with the codes found in the capture. Belongs to
/// the session thread.
class Triggers {
 public:
  /// `lines` may be null. Then, with `setup.lines`, each code counts as set on the lines exactly when it was
  /// due (virtual clock). `stream` and `lines` must outlive this object.
  Triggers(const TriggerSetup& setup, audio::Stream& stream, io::TriggerLines* lines);

  bool active() const { return setup_.active(); }
  /// Registers a code that is part of a scheduled burst. `frame` and `time_ns` must be set.
  void scheduled(Trigger trigger);
  /// Sends a code as soon as the marker channel is free, after all codes sent so far.
  void send(Trigger trigger, std::int64_t now_ns);
  /// The first frame at which the marker channel is free for another code.
  std::int64_t free_from() const { return free_from_; }
  /// Records that bursts beginning at `from_frame` or later are cancelled, and that the others are silent
  /// from `silent_frame` on. The codes in them are cut or not sent.
  void cut(std::int64_t from_frame, std::int64_t silent_frame, std::int64_t now_ns);
  bool owns(std::uint32_t burst) const;
  /// Records that the burst of a code came too late and was not played.
  void missed(std::uint32_t burst);

  /// True if captured frames of this range may contain a code that was sent.
  bool needs(std::int64_t first_frame, std::int64_t end_frame) const;
  void captured(const TriggerCapture::News& news);

  struct Done {
    std::vector<Trigger> triggers;
    std::vector<sensing::DecodedTrigger> extra;  ///< codes that were captured although they were not sent
    std::string failure;                         ///< why codes cannot be set on the lines; reported only once
  };
  /// Removes and returns all codes about which everything is known by now.
  Done take(std::int64_t now_ns);
  bool pending() const { return !open_.empty(); }

 private:
  struct Open {
    Trigger trigger;
    std::uint32_t burst = 0;
  };
  std::int64_t code_frames() const;
  void add(Open open);
  void conclude(std::int64_t first_frame, std::int64_t end_frame);

  const TriggerSetup setup_;
  audio::Stream& stream_;
  io::TriggerLines* lines_;
  std::vector<Open> open_;
  std::vector<sensing::DecodedTrigger> extra_;
  std::int64_t free_from_ = 0;
  std::pair<std::int64_t, std::int64_t> covered_{0, 0};  ///< newest unbroken range of captured frames
  bool failure_told_ = false;
};

/// Returns the rows of events for a code: one that it was sent, and, if it was not read back, one that says
/// so.
std::vector<core::EventRow> rows_of(const Trigger& trigger);
core::EventRow row_of_extra(const sensing::DecodedTrigger& extra, std::int64_t time_ns, int trial_index);

}  // namespace turnpoint::session
