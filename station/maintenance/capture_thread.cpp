#include "station/maintenance/capture_thread.hpp"

#include <chrono>
#include <utility>

#include "station/texts/refusal.hpp"

namespace turnpoint::maintenance {

CaptureThread::CaptureThread(const drive::OutputConfig& device, OnBlock on_block)
    : device_(device),
      on_block_(std::move(on_block)),
      capture_(drive::open_capture(device)),
      thread_([this](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          take();
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
      }) {}

drive::CaptureCounters CaptureThread::end() {
  thread_.request_stop();
  thread_.join();
  take();
  const auto counters = capture_->counters();
  if (!counters.present)
    throw texts::Failure(texts::phrase("played.disconnected", {texts::plain(device_.uri)}));
  return counters;
}

void CaptureThread::take() {
  while (const auto* block = capture_->take()) on_block_(*block);
}

}  // namespace turnpoint::maintenance
