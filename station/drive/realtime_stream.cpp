#include <fmt/format.h>

#include <cstring>
#include <latch>
#include <thread>

#include "station/drive/device_stream.hpp"
#include "station/system/clocks.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::drive {
namespace {

class Realtime final : public DeviceStream {
 public:
  explicit Realtime(const StreamConfig& config) : DeviceStream(config) {
    auto used = memory();
    used.push_back(system::range_of(*this));
    rights_ = system::lock_memory(used, memory_left_out());
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    started_.wait();
    if (const int error = stack_denied_.load(); error != 0 && rights_.memory_locked) {
      rights_.memory_locked = false;
      rights_.note = fmt::format("stack: {} (raise LimitMEMLOCK)", std::strerror(error));
    }
    const int denied = granted_.load();
    rights_.fifo_priority = denied == 0 ? config.fifo_priority : 0;
    if (denied != 0)
      rights_.note += fmt::format("{}SCHED_FIFO {}: {} (raise LimitRTPRIO)", rights_.note.empty() ? "" : "; ",
                                  config.fifo_priority, std::strerror(denied));
  }

  // Ramps down what is sounding, then stops the thread.
  ~Realtime() override {
    const OutputConfig& output = config().output;
    try {
      const Ramp ramp;
      stop(0, ramp, std::nullopt);
      const std::int64_t tail = ramp.frames + std::int64_t{output.period_frames} * (output.periods + 1);
      system::sleep_until_ns(system::monotonic_ns() + tail * 1'000'000'000 / output.rate_Hz);
      // stop() threw because the audio thread takes no commands. Then it plays nothing either.
    } catch (const std::exception&) {
    }
    thread_.request_stop();
  }

  system::Rights rights() const override { return rights_; }

 private:
  void run(const std::stop_token& stop) noexcept {
    granted_.store(system::become_realtime(config().fifo_priority));
    stack_denied_.store(system::lock_stack());
    started_.count_down();
    while (!stop.stop_requested()) step();
  }

  system::Rights rights_;
  std::atomic<int> granted_{0}, stack_denied_{0};
  std::latch started_{1};
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread thread_;
};

}  // namespace

std::unique_ptr<Stream> open_realtime(const StreamConfig& config) {
  return std::make_unique<Realtime>(config);
}

}  // namespace turnpoint::drive
