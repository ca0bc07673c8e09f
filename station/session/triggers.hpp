#pragma once
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "station/drive/engine.hpp"
#include "station/lines/trigger_lines.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/trigger_decoder.hpp"

namespace turnpoint::session {

/// How a rig gives out trigger codes and takes the pulses of other devices.
struct TriggerSetup {
  std::optional<rig::Marker> marker;                ///< set if the marker carries codes
  std::int64_t bit_frames = 0;                      ///< length of one bit on the marker channel
  bool lines = false;                               ///< codes go to lines as well
  std::optional<int> marker_channel, sync_channel;  ///< captured channels
  bool simulated_sync = false;                      ///< a simulated session gets a pulse each second

  bool active() const { return marker.has_value() || lines; }
};
TriggerSetup trigger_setup_of(const rig::Rig& rig);

/// A code that is given out, and what became of it.
struct Trigger {
  protocol::TriggerEvent event = protocol::TriggerEvent::trial;
  int code = 0;
  int trial_index = 0;
  std::int64_t frame = 0;                ///< first frame of the code on the marker channel
  std::int64_t time_ns = 0;              ///< time at which that frame leaves the converter
  bool cut = false;                      ///< true if the code broke off before its end on the marker channel
  std::string refused;                   ///< why the code was not sent; "" if it was
  std::optional<std::int64_t> lines_ns;  ///< time at which it was on the lines
  enum class ReadBack { none, pending, right, missed, lost };
  ReadBack read_back = ReadBack::none;  ///< lost: what was captured then is incomplete
  double error_frames = 0;              ///< read-back minus sent frame
};

/// What the captured channels of markers and pulses contain. One thread pushes blocks, another takes.
class TriggerCapture {
 public:
  /// `delay_frames`: from a played to a captured frame.
  TriggerCapture(const TriggerSetup& setup, double delay_frames);
  void push(const sensing::CaptureBlock& block);

  struct News {
    std::vector<sensing::DecodedTrigger> heard;                   ///< by playback frames
    std::vector<std::int64_t> edges;                              ///< playback frames of pulses
    std::vector<std::pair<std::int64_t, std::int64_t>> captured;  ///< ranges of playback frames, in order
  };
  News take();

 private:
  std::mutex mutex_;
  const double delay_frames_;
  std::optional<sensing::TriggerDecoder> decoder_;
  std::optional<sensing::EdgeFinder> edges_;
  News news_;
};

/// Gives out the codes of a run, and compares what was captured with what was sent. Belongs to the session
/// thread.
class Triggers {
 public:
  /// `lines` may be null: with `setup.lines`, codes are then on lines exactly when they are due (virtual
  /// clock). `stream` and `lines` must outlive this object.
  Triggers(const TriggerSetup& setup, drive::Stream& stream, lines::TriggerLines* lines);

  bool active() const { return setup_.active(); }
  /// A code that is part of a scheduled burst; `frame` and `time_ns` are set.
  void scheduled(Trigger trigger);
  /// Gives out a code as soon as possible, but after all codes so far.
  void send(Trigger trigger, std::int64_t now_ns);
  /// The frame from which on the marker channel is free for the next code.
  std::int64_t free_from() const { return free_from_; }
  /// Bursts that begin at `from_frame` or later are cancelled, and the others are silent from `silent_frame`.
  void cut(std::int64_t from_frame, std::int64_t silent_frame, std::int64_t now_ns);
  bool owns(std::uint32_t burst) const;
  /// The burst of a code came too late and is not played.
  void missed(std::uint32_t burst);

  /// True if captured frames of this range may contain a code that was sent.
  bool needs(std::int64_t first_frame, std::int64_t end_frame) const;
  void captured(const TriggerCapture::News& news);

  struct Done {
    std::vector<Trigger> triggers;
    std::vector<sensing::DecodedTrigger> extra;  ///< codes that were captured and not sent
    std::string failure;                         ///< why the lines cannot be set, once
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
  drive::Stream& stream_;
  lines::TriggerLines* lines_;
  std::vector<Open> open_;
  std::vector<sensing::DecodedTrigger> extra_;
  std::int64_t free_from_ = 0;
  std::pair<std::int64_t, std::int64_t> covered_{0, 0};  ///< newest unbroken range of captured frames
  bool failure_told_ = false;
};

/// The rows of a code: that it was sent, and, if so, that it was not read back.
std::vector<records::EventRow> rows_of(const Trigger& trigger);
records::EventRow row_of_extra(const sensing::DecodedTrigger& extra, std::int64_t time_ns, int trial_index);

}  // namespace turnpoint::session
