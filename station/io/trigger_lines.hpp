#pragma once
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "station/io/lines.hpp"

namespace turnpoint::io {

/// The trigger lines that a URI names: `gpio:bit0=LINE,bit1=LINE,strobe=LINE,pulse_ms=5`, or `sim:` for eight
/// simulated bits.
struct TriggerPlan {
  std::vector<std::string> names;  ///< lines of the bits, the lowest first, then the strobe; empty for `sim:`
  int bits = 8;
  bool strobe = false;
  std::int64_t pulse_ns = 5'000'000;  ///< how long a code is held on the lines
};
/// Reads the URI of trigger lines. Throws core::UsageError if it is not understood.
TriggerPlan trigger_plan(const std::string& uri);

/// Sends trigger codes in parallel on GPIO lines, for a device that reads TTL levels. An ordinary thread sets
/// the lines when a code is due: first all bits together, then the strobe, which falls again before the bits
/// do. If a code is due while the previous one is still on the lines, it follows 1 ms after the previous one
/// ends.
class TriggerLines {
 public:
  TriggerLines(std::unique_ptr<Outputs> outputs, const TriggerPlan& plan);

  /// Sends a code at this time (CLOCK_MONOTONIC), or at once if the time is past.
  void give(int code, std::int64_t due_ns);
  /// Drops the codes that are due at this time or later.
  void cancel(std::int64_t from_ns);

  struct Given {
    int code = 0;
    std::int64_t due_ns = 0;
    /// time at which the lines carried the code; with a strobe, the time at which the strobe rose
    std::int64_t time_ns = 0;
  };
  /// Removes and returns the codes sent so far, in order.
  std::vector<Given> take();
  /// Why the lines cannot be set; "" if they can. After a failure nothing more is sent.
  std::string failure() const;

 private:
  void run(const std::stop_token& stop);
  Given give_out(const Given& next);
  std::uint32_t levels(int code) const;

  std::unique_ptr<Outputs> outputs_;
  const TriggerPlan plan_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Given> waiting_;  ///< codes that wait to be sent, in order of due_ns
  std::vector<Given> given_;
  std::string failure_;
  std::jthread thread_;
};

/// Opens the rig's lines for trigger codes. Throws LineError or core::UsageError.
std::unique_ptr<TriggerLines> open_trigger_lines(const std::string& uri);

}  // namespace turnpoint::io
