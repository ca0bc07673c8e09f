#include "station/session/trial_capture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "station/sensing/trial_finger.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::session {

namespace {

constexpr std::int64_t kPilot_ns = 1'000'000'000;               // longest wait for the captured pilot
constexpr double kTare_s = sensing::TrialFinger::tare_s + 0.1;  // 0.1 s longer than the tare, for the filter
constexpr std::int64_t kMeasured_ns = 1'000'000'000;  // longest wait for the captured frames of an interval
// longest wait for a converter of force cells that was connected again
constexpr std::int64_t kConverter_ns = 1'500'000'000;

}  // namespace

TrialCapture::TrialCapture(const CardCapture& plan, const Devices& devices, audio::Stream& stream,
                           Inputs& inputs, Wait wait)
    : stream_(stream),
      inputs_(inputs),
      wait_(std::move(wait)),
      pilot_(plan.pilot),
      reference_(plan.reference),
      has_cells_(plan.setup.finger.has_value()),
      feed_(devices.open_capture(plan.device), plan) {
  if (plan.cells) cells_ = std::make_unique<CellFeed>(*plan.cells, devices.open_cells);
}

Stage::Refusal TrialCapture::align() {
  feed_.listen(stream_.schedule_soon(sensing::pilot_burst(pilot_, 0)).start_frame);
  const auto until_ns =
      system::monotonic_ns() + static_cast<std::int64_t>(1e9 * feed_.longest_wait_s()) + kPilot_ns;
  wait_([&] { return feed_.pilot() != CaptureFeed::Pilot::awaited || system::monotonic_ns() > until_ns; });
  if (feed_.aligned()) {
    if (has_cells_) await_tare();
    return std::nullopt;
  }
  if (!feed_.counters().present) return Fault{FaultKind::capture, "the capture device is disconnected"};
  return Fault{FaultKind::capture,
               fmt::format("the pilot on output channel {} was not heard on captured channel {}",
                           pilot_.channel, reference_)};
}

Stage::Refusal TrialCapture::await_cells() {
  const auto until_ns = system::monotonic_ns() + kConverter_ns;
  wait_([&] { return cells_->problem().empty() || system::monotonic_ns() > until_ns; });
  if (auto problem = cells_->problem(); !problem.empty())
    return Fault{FaultKind::capture, std::move(problem)};
  await_tare();
  return std::nullopt;
}

// The playback frame before which everything has been measured that is measured at all.
std::int64_t TrialCapture::measured_until() const {
  const auto captured = feed_.end_frame();
  return cells_ && cells_->problem().empty() ? std::min(captured, cells_->end_frame()) : captured;
}

// The force cells are read before each trial, which needs captured frames since the pilot.
void TrialCapture::await_tare() {
  const auto rate_Hz = stream_.config().output.rate_Hz;
  const auto until_ns = system::monotonic_ns() + static_cast<std::int64_t>(1e9 * feed_.longest_wait_s());
  const auto wanted = stream_.frame_at(system::monotonic_ns()).value_or(0) +
                      static_cast<std::int64_t>(kTare_s * static_cast<double>(rate_Hz));
  wait_([&] { return measured_until() >= wanted || !feed_.aligned() || system::monotonic_ns() > until_ns; });
}

void TrialCapture::played(int interval, std::int64_t now_ns) {
  unmeasured_.push_back({interval, now_ns + kMeasured_ns});
}

void TrialCapture::attend(std::int64_t now_ns) {
  if (cells_) follow_cells(now_ns);
  report_measured(now_ns);
  report_losses(now_ns);
}

// Passes on what the converter of the force cells has sent. Samples that it has lost make the forces of a
// trial unknown only if the trial needs them.
void TrialCapture::follow_cells(std::int64_t now_ns) {
  auto playback = stream_.clock();
  playback.time_ns += std::llround(1e9 * stream_.config().converter_delay_s);
  cells_->follow(playback, feed_.watch());
  for (auto& news : cells_->news()) inputs_.push({now_ns, input::Notice{std::move(news)}});
}

// Reports the intervals whose samples have been captured: first the measurements of an interval, then that
// the interval was heard.
void TrialCapture::report_measured(std::int64_t now_ns) {
  while (!unmeasured_.empty()) {
    const auto [interval, limit_ns] = unmeasured_.front();
    auto& watch = feed_.watch();
    const auto index = static_cast<std::size_t>(interval);
    if (feed_.aligned() && measured_until() < watch.known_at(index) && now_ns < limit_ns) return;
    unmeasured_.pop_front();
    const auto forces = watch.forces(index);
    if (const auto result = watch.result(index))
      inputs_.push({now_ns, input::Measured{interval, result, forces}});
    inputs_.push({now_ns, input::Heard{interval}});
  }
}

// Reports gaps of the capture, which are logged. A gap makes the trial void only if it hits one of the
// trial's intervals.
void TrialCapture::report_losses(std::int64_t now_ns) {
  const auto counters = feed_.counters();
  if (counters.numbering == std::exchange(numbering_, counters.numbering)) return;
  inputs_.push(
      {now_ns, input::Notice{fmt::format(
                   "the capture has lost {} frames in {} overruns, and has had {} gaps of unknown length",
                   counters.lost_frames, counters.overruns, counters.unknown_gaps)}});
}

}  // namespace turnpoint::session
