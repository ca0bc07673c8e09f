#include <chrono>
#include <future>
#include <span>
#include <string>
#include <utility>

#include "station/session/session_run.hpp"
#include "station/store/signal_code.hpp"

namespace turnpoint::session {

namespace {

/// Returns the captured frames as a signal, without the time of its first point. Takes up to seconds.
records::SignalRow raw_signal(const sensing::RawCapture& raw) {
  records::SignalRow signal;
  signal.stream = records::kRawStream;
  signal.start_frame = raw.first_frame;
  signal.rate_Hz = raw.rate_Hz;
  for (int c = 0; c < raw.channels; ++c) signal.channels.push_back({"channel_" + std::to_string(c), "", 1});
  store::encode(signal, std::span(raw.samples));
  return signal;
}

}  // namespace

/// Adds what was captured last, on all channels, to the row of a void trial. Compressing and storing it takes
/// a while. Until it is compressed and the amplifier is off, the stage attends to its devices.
void SessionRun::keep_raw(Running& trial) {
  if (!trial.is_void() || trial.onsets.empty()) return;
  auto raw = stage_->raw_capture();
  if (!raw || raw->samples.empty()) return;
  auto packed = std::async(std::launch::async, [raw = *std::move(raw)] { return raw_signal(raw); });
  stage_->wait_for([&] {
    return packed.wait_for(std::chrono::seconds(0)) == std::future_status::ready &&
           stage_->amplifier() != drive::AmplifierState::enabled;
  });
  auto signal = packed.get();
  const auto& onset = trial.onsets.front();
  signal.start_s = 1e-9 * static_cast<double>(onset.time_ns - started_ns_) +
                   static_cast<double>(signal.start_frame - onset.frame) / setup_.rig.output.rate_Hz;
  trial.row.signal_rows.push_back(std::move(signal));
}

}  // namespace turnpoint::session
