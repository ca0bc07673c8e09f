#include "station/ui/operator/weighing.hpp"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <utility>

#include "station/core/texts.hpp"

namespace turnpoint::ui {

namespace {

constexpr std::chrono::milliseconds kGlance{250};  // time between two live readings

/// Thrown out of maintenance::weigh() when the operator ends the calibration.
struct Stopped {};

void read(maintenance::BridgeReader& bridges, Weighing::Shown& shown) {
  shown.unread = {};
  try {
    const auto now = bridges.glance();
    shown.converter = now.reference == 0;
    for (std::size_t cell = 0; cell < 3; ++cell)
      shown.cells[cell] = shown.converter ? now.ratio[cell] : std::round(1e5 * now.ratio[cell]) / 100 + 0.0;
  } catch (const std::exception& error) {
    shown.unread = core::phrase_of(error);
  }
}

}  // namespace

void Weighing::answer(Answer answer) {
  {
    const std::lock_guard lock(mutex_);
    answer_ = answer;
  }
  changed_.notify_all();
}

Weighing::Answer Weighing::await(maintenance::BridgeReader& bridges, Shown shown, const Show& show,
                                 const std::stop_token& stop) {
  {
    const std::lock_guard lock(mutex_);
    answer_.reset();
  }
  while (!stop.stop_requested()) {
    read(bridges, shown);
    show(shown);
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, stop, kGlance, [this] { return answer_.has_value(); })) continue;
    if (*answer_ == Answer::stop) break;
    show({});
    return *std::exchange(answer_, std::nullopt);
  }
  throw Stopped{};
}

std::optional<maintenance::ForceResult> Weighing::run(const rig::Rig& rig, const Show& show,
                                                      const std::stop_token& stop) {
  const auto bridges = maintenance::open_bridges(rig);
  maintenance::WeightStep now;
  core::Phrase silent;  // why a tap was not noticed
  const auto ready = [&](const maintenance::WeightStep& step) {
    now = step;
    if (!silent.empty()) now.remark = std::exchange(silent, {});
    return await(*bridges, {now, {}, {}, false, {}}, show, stop) == Answer::read;
  };
  const auto failed = [&](const core::Phrase& why) {
    // A tap is asked for again, and may be left out.
    if (now.tap != maintenance::Tap::none)
      silent = why;
    else
      await(*bridges, {now, why, {}, false, {}}, show, stop);
    return true;
  };
  try {
    return maintenance::weigh(rig, *bridges, ready, failed);
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

}  // namespace turnpoint::ui
