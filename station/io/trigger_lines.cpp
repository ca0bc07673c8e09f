#include "station/io/trigger_lines.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "station/core/usage_error.hpp"
#include "station/io/uri.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::io {

namespace {

constexpr std::int64_t kLow_ns = 1'000'000;  // time for which all lines are low between two codes
// The thread waits on the condition variable until this long before a code is due. Then it sleeps until the
// exact time, because such a sleep is more precise.
constexpr std::int64_t kAhead_ns = 300'000;

std::chrono::steady_clock::time_point point(std::int64_t time_ns) {
  return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time_ns));
}

/// Output lines for `sim:`, which do nothing.
class NoOutputs final : public Outputs {
 public:
  void drive(std::uint32_t) override {}
};

}  // namespace

TriggerPlan trigger_plan(const std::string& text) {
  Uri uri = parse_uri(text);
  TriggerPlan plan;
  if (uri.scheme == "sim") return plan;
  const auto refuse = [&](const std::string& why) {
    throw core::UsageError("trigger lines '" + text + "': " + why);
  };
  if (uri.scheme != "gpio") refuse("allowed are sim: and gpio:bit0=LINE,bit1=LINE,strobe=LINE,pulse_ms=5");
  for (plan.bits = 0; plan.bits < 8; ++plan.bits) {
    const auto line = uri.take("bit" + std::to_string(plan.bits), "");
    if (line.empty()) break;
    plan.names.push_back(line);
  }
  if (plan.bits == 0) refuse("there is no bit0");
  const auto strobe = uri.take("strobe", "");
  plan.strobe = !strobe.empty();
  if (plan.strobe) plan.names.push_back(strobe);
  plan.pulse_ns = take_ms(uri, "pulse_ms", plan.pulse_ns, 100);
  uri.check_empty("bit0 to bit7 without a gap, strobe, pulse_ms");
  return plan;
}

TriggerLines::TriggerLines(std::unique_ptr<Outputs> outputs, const TriggerPlan& plan)
    : outputs_(std::move(outputs)),
      plan_(plan),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void TriggerLines::give(int code, std::int64_t due_ns) {
  const std::lock_guard lock(mutex_);
  const auto later = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Given& other) { return other.due_ns > due_ns; });
  waiting_.insert(later, {code, due_ns, 0});
  changed_.notify_all();
}

void TriggerLines::cancel(std::int64_t from_ns) {
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [&](const Given& code) { return code.due_ns >= from_ns; });
}

std::vector<TriggerLines::Given> TriggerLines::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(given_, {});
}

std::string TriggerLines::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void TriggerLines::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return !waiting_.empty(); })) {
    const auto next = waiting_.front();
    // While waiting, a code that is due earlier may be added, and this one may be cancelled.
    if (next.due_ns - kAhead_ns > system::monotonic_ns()) {
      changed_.wait_until(lock, stop, point(next.due_ns - kAhead_ns),
                          [&] { return waiting_.empty() || waiting_.front().due_ns != next.due_ns; });
      continue;
    }
    waiting_.pop_front();
    lock.unlock();
    try {
      const auto given = give_out(next);
      lock.lock();
      given_.push_back(given);
      lock.unlock();
      system::sleep_until_ns(given.time_ns + plan_.pulse_ns);
      if (plan_.strobe) outputs_->drive(levels(given.code));
      outputs_->drive(0);
      system::sleep_until_ns(given.time_ns + plan_.pulse_ns + kLow_ns);
      lock.lock();
    } catch (const std::exception& error) {
      if (!lock.owns_lock()) lock.lock();
      failure_ = error.what();
      return;
    }
  }
}

std::uint32_t TriggerLines::levels(int code) const {
  return static_cast<std::uint32_t>(code) & ((1u << plan_.bits) - 1);
}

TriggerLines::Given TriggerLines::give_out(const Given& next) {
  system::sleep_until_ns(next.due_ns);
  outputs_->drive(levels(next.code));
  if (plan_.strobe) outputs_->drive(levels(next.code) | 1u << plan_.bits);
  return {next.code, next.due_ns, system::monotonic_ns()};
}

std::unique_ptr<TriggerLines> open_trigger_lines(const std::string& uri) {
  const auto plan = trigger_plan(uri);
  if (plan.names.empty()) return std::make_unique<TriggerLines>(std::make_unique<NoOutputs>(), plan);
  return std::make_unique<TriggerLines>(open_gpio_outputs(plan.names, "turnpoint-trigger"), plan);
}

}  // namespace turnpoint::io
