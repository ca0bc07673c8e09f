#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>

#include "station/session/capture_feed.hpp"
#include "station/session/cell_feed.hpp"
#include "station/session/devices.hpp"
#include "station/session/inputs.hpp"
#include "station/session/stage.hpp"

namespace turnpoint::session {

/// Everything that a real stage measures: what the sound card captures, and force cells on a converter of
/// their own. Reports to `inputs` what was measured in the intervals of a trial, and what was lost. Used by
/// the session thread only.
class TrialCapture {
 public:
  /// Waits until `ready` returns true; meanwhile, the stage goes on attending to its devices.
  using Wait = std::function<void(const std::function<bool()>& ready)>;

  /// Opens the devices. Throws the errors of their drivers.
  TrialCapture(const CardCapture& plan, const Devices& devices, audio::Stream& stream, Inputs& inputs,
               Wait wait);

  CaptureFeed& feed() { return feed_; }
  const CaptureFeed& feed() const { return feed_; }
  bool aligned() const { return feed_.aligned(); }
  /// True if the force cells have a converter of their own that does not send.
  bool misses_cells() const { return cells_ && !cells_->problem().empty(); }

  /// Measures the delay from playback to capture with a pilot. The amplifier must be off.
  Stage::Refusal align();
  /// Waits until the converter of the force cells is back. A device that is connected again is found within a
  /// second.
  Stage::Refusal await_cells();

  /// An interval was played: reports that it was heard as soon as its samples are there.
  void played(int interval, std::int64_t now_ns);
  /// Forgets the intervals of the previous trial.
  void forget() { unmeasured_.clear(); }
  /// Passes on what has arrived. Call this often.
  void attend(std::int64_t now_ns);

 private:
  std::int64_t measured_until() const;
  void await_tare();
  void follow_cells(std::int64_t now_ns);
  void report_measured(std::int64_t now_ns);
  void report_losses(std::int64_t now_ns);

  audio::Stream& stream_;
  Inputs& inputs_;
  const Wait wait_;
  const sensing::Pilot pilot_;
  const int reference_;   ///< captured channel on which the pilot is recorded
  const bool has_cells_;  ///< true if force cells are measured, whatever captures them
  CaptureFeed feed_;
  std::unique_ptr<CellFeed> cells_;  ///< null unless the force cells have a converter of their own
  /// An interval that was played, and the time until which to wait for its captured samples.
  struct Unmeasured {
    int interval = 0;
    std::int64_t limit_ns = 0;
  };
  std::deque<Unmeasured> unmeasured_;
  std::uint32_t numbering_ = 0;  ///< the capture's `numbering` at the last reported loss of frames
};

}  // namespace turnpoint::session
