#include "station/session/cell_feed.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

namespace turnpoint::session {

namespace {

constexpr std::chrono::seconds kRetry{1};
constexpr double kRateTolerance = 0.02;
constexpr double kLongestQueue_s = 60;  // while nobody follows, older samples are dropped

}  // namespace

io::Config converter_of(const rig::CellConverter& converter) {
  io::Config config;
  config.device = converter.uri.substr(converter.uri.find(':') + 1);
  config.channels = converter.channels;
  config.rate_Hz = converter.rate_Hz;
  config.trigger = converter.trigger;
  if (converter.sampling_frequency)
    config.sampling_frequency = fmt::format("{}", *converter.sampling_frequency);
  return config;
}

std::optional<CellPlan> cell_plan_of(const rig::Rig& rig) {
  if (!rig.capture || !rig.capture->converter || !rig.capture->forces) return std::nullopt;
  const auto& converter = *rig.capture->converter;
  CellPlan plan;
  plan.device = converter_of(converter);
  plan.clock.rate_Hz = converter.rate_Hz;
  plan.clock.frames_per_point = rig.output.rate_Hz / sensing::points_per_second(sensing::Band::force);
  plan.clock.full_scale = rig.capture->forces->rated_ratio;
  plan.clock.delay_ns = std::llround(1e9 * converter.delay_s);
  return plan;
}

std::optional<core::Phrase> wrong_rate(const std::string& device, double measured_Hz, double stated_Hz) {
  if (std::abs(measured_Hz / stated_Hz - 1) <= kRateTolerance) return std::nullopt;
  return core::phrase("doctor.wrong_rate",
                      {core::plain("iio:" + device), core::plain(fmt::format("{:.1f}", measured_Hz)),
                       core::plain(fmt::format("{}", stated_Hz))});
}

CellFeed::CellFeed(const CellPlan& plan, Open open)
    : plan_(plan),
      open_(std::move(open)),
      converter_(open_(plan_.device)),
      clock_(plan_.clock),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void CellFeed::run(const std::stop_token& stop) {
  const auto most = static_cast<std::size_t>(kLongestQueue_s * plan_.device.rate_Hz);
  while (!stop.stop_requested()) {
    try {
      if (!converter_) converter_ = open_(plan_.device);
      const auto samples = converter_->read();
      const std::lock_guard lock(mutex_);
      if (!samples.empty()) problem_.clear();
      if (read_.size() > most) read_.clear();
      read_.insert(read_.end(), samples.begin(), samples.end());
    } catch (const std::exception& error) {
      converter_.reset();
      std::unique_lock lock(mutex_);
      problem_ = error.what();
      stopped_.wait_for(lock, stop, kRetry, [] { return false; });
    }
  }
}

void CellFeed::follow(const audio::ClockFit& playback, VibrationWatch& watch) {
  std::vector<io::Sample> samples;
  {
    const std::lock_guard lock(mutex_);
    samples.swap(read_);
  }
  for (const auto& sample : samples)
    clock_.push({sample.time_ns, sample.value, sample.at_limit}, playback,
                [&](const sensing::BridgePoint& point) {
                  watch.push(point);
                  end_frame_ = (point.index + 1) * plan_.clock.frames_per_point;
                });
}

std::string CellFeed::problem() const {
  {
    const std::lock_guard lock(mutex_);
    if (!problem_.empty()) return problem_;
  }
  const auto rate_Hz = clock_.rate_Hz();
  const auto wrong = rate_Hz ? wrong_rate(plan_.device.device, *rate_Hz, plan_.device.rate_Hz) : std::nullopt;
  return wrong ? core::say(*wrong, "en") : "";
}

std::vector<std::string> CellFeed::news() {
  std::vector<std::string> news;
  if (auto now = problem(); now != told_problem_) {
    told_problem_ = std::move(now);
    news.push_back(told_problem_.empty() ? "the force cells are read again" : told_problem_);
  }
  const auto& counters = clock_.counters();
  if (const auto gaps = counters.gaps + counters.disorder; gaps != std::exchange(told_gaps_, gaps))
    news.push_back(fmt::format(
        "the converter of the force cells has lost {} samples in {} gaps; {} time stamps were out of order",
        counters.lost, counters.gaps, counters.disorder));
  return news;
}

}  // namespace turnpoint::session
