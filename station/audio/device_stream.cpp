#include "station/audio/device_stream.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <latch>
#include <thread>

#include "station/system/clocks.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::audio {

DeviceStream::DeviceStream(const StreamConfig& config)
    : config_(config),
      core_(config),
      output_(open_output(config.output)),
      clock_(config.output.rate_Hz, 1024),
      block_(static_cast<std::size_t>(config.output.channels) *
             static_cast<std::size_t>(config.output.period_frames)),
      origin_ns_(system::monotonic_ns()),
      rate_check_(config.output.rate_Hz) {}

std::int64_t DeviceStream::delay_ns() const noexcept { return std::llround(config_.converter_delay_s * 1e9); }

std::vector<system::MemoryRange> DeviceStream::memory() const {
  auto ranges = core_.memory();
  ranges.insert(ranges.end(),
                {system::range_of(block_), system::range_of(*positions_), system::range_of(*rates_)});
  const auto output = output_->memory();
  ranges.insert(ranges.end(), output.begin(), output.end());
  return ranges;
}

std::optional<Event> DeviceStream::poll() {
  gather_positions();
  return core_.poll();
}

// Moves measured positions from the audio thread to the clock. A restart of the device resets the clock,
// which then has no data until the device reports its first position.
void DeviceStream::gather_positions() {
  const std::uint32_t relation = relation_.load();
  if (relation != clock_relation_) clock_.reset();
  clock_relation_ = relation;
  StampedPosition stamped;
  while (positions_->pop(stamped))
    if (stamped.relation == relation) clock_.add(stamped.position.frame, stamped.position.time_ns);
  StampedRate rate;
  while (rates_->pop(rate)) rate_ = rate;
}

ClockFit DeviceStream::clock() {
  gather_positions();
  return clock_.fit();
}

std::optional<std::int64_t> DeviceStream::time_of(std::int64_t frame) {
  const ClockFit fit = clock();
  return fit.pairs > 0 ? std::optional(fit.time_of(frame) + delay_ns()) : std::nullopt;
}

std::optional<std::int64_t> DeviceStream::frame_at(std::int64_t time_ns) {
  const ClockFit fit = clock();
  return fit.pairs > 0 ? std::optional(fit.frame_at(time_ns - delay_ns())) : std::nullopt;
}

std::optional<MeasuredRate> DeviceStream::measured_rate() {
  gather_positions();
  return rate_ && rate_->device == device_.load() ? std::optional(rate_->rate) : std::nullopt;
}

void DeviceStream::step() noexcept {
  core_.process(frame_, block_);
  const WriteResult result = output_->write(block_);
  if (result.status == WriteStatus::ok)
    frame_ += config_.output.period_frames;
  else
    note_loss(result);
  lost_ = result.status == WriteStatus::lost;
  if (config_.amplifier && !lost_) config_.amplifier->audio_alive();
  output_->paced() ? follow_device() : follow_clock();
}

// Reports the loss of a device only once, although every write reports it until the device is back.
void DeviceStream::note_loss(const WriteResult& result) noexcept {
  const std::int64_t first = frame_ + result.taken - result.dropped;
  const std::int64_t next = frame_ + result.taken + result.passed;
  if (result.status != WriteStatus::skipped) {
    relation_.fetch_add(1);
    rate_check_.restart();
  }
  switch (result.status) {
    case WriteStatus::ok:
      break;
    case WriteStatus::skipped:
    case WriteStatus::restarted:
      core_.lose({EventKind::underrun, 0, first, next - first, result.error,
                  result.status == WriteStatus::restarted},
                 next);
      break;
    case WriteStatus::lost:
      if (lost_) break;
      device_.fetch_add(1);
      rate_told_ = false;
      core_.lose({EventKind::device_lost, 0, first, 0, result.error}, next);
      break;
    case WriteStatus::reopened:
      core_.lose({EventKind::device_back, 0, next}, next);
      break;
  }
  frame_ = next;
}

void DeviceStream::follow_device() noexcept {
  const auto position = output_->position();
  if (!position) return;
  core_.heard(position->frame);
  // If the ring is full, nobody reads the clock, and the older positions in the ring are good enough.
  static_cast<void>(positions_->push({relation_.load(), *position}));
  if (!rate_told_) check_rate(*position);
}

void DeviceStream::check_rate(const Position& position) noexcept {
  rate_check_.add(position.frame, position.time_ns + system::raw_minus_monotonic_ns());
  const auto rate = rate_check_.result();
  if (!rate) return;
  rate_told_ = true;
  static_cast<void>(rates_->push({device_.load(), *rate}));
  if (std::abs(rate->deviation_ppm) > RateCheck::tolerance_ppm)
    core_.report({EventKind::rate_wrong, 0, position.frame, std::llround(rate->rate_Hz * 1000)});
}

// Outputs to a file or to null accept frames at once. So wait until the time at which a converter that is one
// period behind would have played them.
void DeviceStream::follow_clock() noexcept {
  const std::int64_t rate = config_.output.rate_Hz, heard = frame_ - config_.output.period_frames;
  const std::int64_t due_ns = origin_ns_ + heard / rate * 1'000'000'000 + heard % rate * 1'000'000'000 / rate;
  system::sleep_until_ns(due_ns);
  core_.heard(heard);
  static_cast<void>(positions_->push({relation_.load(), {heard, due_ns}}));
}

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

}  // namespace turnpoint::audio
