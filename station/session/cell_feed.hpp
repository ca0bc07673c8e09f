#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "station/audio/frame_clock.hpp"
#include "station/core/texts.hpp"
#include "station/io/converter.hpp"
#include "station/rig/rig.hpp"
#include "station/sensing/own_clock.hpp"
#include "station/session/vibration_watch.hpp"

namespace turnpoint::session {

/// Force cells on a converter with a clock of its own.
struct CellPlan {
  io::Config device;
  sensing::OwnClock::Options clock;
};

/// How the converter of a rig's force cells is opened.
io::Config converter_of(const rig::CellConverter& converter);

/// The converter of the rig's force cells; empty if the card captures them, or if they are not calibrated.
std::optional<CellPlan> cell_plan_of(const rig::Rig& rig);

/// Says so if a converter does not send as many samples a second as the rig says.
std::optional<core::Phrase> wrong_rate(const std::string& device, double measured_Hz, double stated_Hz);

/// Reads the converter on a thread of its own, and passes its samples to a VibrationWatch as points in
/// playback frames. If the device fails, the thread opens it again as soon as it is back.
class CellFeed {
 public:
  using Open = std::function<std::unique_ptr<io::Converter>(const io::Config&)>;
  /// Opens the device. Throws the errors of `open`.
  CellFeed(const CellPlan& plan, Open open);

  /// Passes on what has been read. `playback` gives the times at which frames leave the converter of the
  /// output, its delay included. Call this and the functions below from one thread.
  void follow(const audio::ClockFit& playback, VibrationWatch& watch);
  /// All points before this playback frame have been passed on.
  std::int64_t end_frame() const { return end_frame_; }
  /// Why the device does not send what it should; "" if it does.
  std::string problem() const;
  /// Messages for the log: lost samples, and problems that have begun or ended since the last call.
  std::vector<std::string> news();

 private:
  void run(const std::stop_token& stop);

  const CellPlan plan_;
  const Open open_;
  std::unique_ptr<io::Converter> converter_;  ///< used only by the thread
  sensing::OwnClock clock_;
  std::int64_t end_frame_ = 0;
  std::string told_problem_;    ///< the problem of the newest message
  std::int64_t told_gaps_ = 0;  ///< number of gaps at the newest message
  mutable std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::vector<io::Sample> read_;  ///< samples that follow() has not taken yet
  std::string problem_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

}  // namespace turnpoint::session
