#include "station/session/plan_ahead.hpp"

#include <fmt/format.h>

#include <utility>

#include "station/protocol/resolve.hpp"
#include "station/text/number.hpp"

namespace turnpoint::session {

namespace {

/// Equal for trials that present the same.
std::string key_of(const TrialSpec& trial) {
  std::string key = fmt::format("{}/{}/{}", trial.block_index, trial.attempt, trial.trial_in_block);
  for (const auto& [name, value] : trial.factors) {
    key += "|" + name + "=";
    if (const auto* number = std::get_if<double>(&value))
      key += text::exact(*number);
    else
      key += std::get<std::string>(value);
  }
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    key += "|" + text::exact(trial.rove_dB[i]);
    for (const auto& scene : trial.intervals[i]) key += ":" + scene;
  }
  return key;
}

}  // namespace

PlanAhead::PlanAhead(const rig::Rig& rig, const protocol::Protocol& protocol)
    : protocol_(protocol), planner_(rig) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

PlanAhead::~PlanAhead() = default;

void PlanAhead::begin(const TrialSpec& trial) {
  auto key = key_of(trial);
  const std::lock_guard lock(mutex_);
  if (key == wanted_key_) return;
  wanted_key_ = std::move(key);
  wanted_ = trial;
  changed_.notify_all();
}

bool PlanAhead::ready(const TrialSpec& trial) {
  const auto key = key_of(trial);
  const std::lock_guard lock(mutex_);
  return done_key_ == key;
}

const PlanAhead::Plans& PlanAhead::take(const TrialSpec& trial) {
  begin(trial);
  const auto key = key_of(trial);
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return done_key_ == key; });
  if (failed_) std::rethrow_exception(failed_);
  return done_;
}

void PlanAhead::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [this] { return wanted_.has_value(); })) {
    const TrialSpec trial = *std::exchange(wanted_, std::nullopt);
    lock.unlock();
    Plans plans;
    std::exception_ptr failed;
    try {
      plans = plan(trial);
    } catch (...) {
      failed = std::current_exception();
    }
    lock.lock();
    done_ = std::move(plans);
    failed_ = failed;
    done_key_ = key_of(trial);
    changed_.notify_all();
  }
}

PlanAhead::Plans PlanAhead::plan(const TrialSpec& trial) {
  Plans plans;
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    plans.emplace_back();
    for (const auto& name : trial.intervals[i])
      plans.back().push_back(
          planner_.plan(protocol::resolve(protocol_, name, trial.factors, trial.rove_dB[i])));
  }
  return plans;
}

}  // namespace turnpoint::session
