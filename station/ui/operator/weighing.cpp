#include "station/ui/operator/weighing.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <utility>

namespace turnpoint::ui {

namespace {

constexpr std::chrono::milliseconds kGlance{250};  // between two live readings

/// Thrown through maintenance::weigh() when the operator ends it.
struct Stopped {};

std::string live(maintenance::BridgeReader& bridges) {
  try {
    const auto now = bridges.glance();
    if (now.reference == 0)
      return fmt::format("a {:.5g}, b {:.5g}, lateral {:.5g} (in the unit of the converter)", now.ratio[0],
                         now.ratio[1], now.ratio[2]);
    const auto shown = [&](std::size_t cell) { return std::round(1e5 * now.ratio[cell]) / 100 + 0.0; };
    return fmt::format("a {:.2f}, b {:.2f}, lateral {:.2f} (thousandths of the excitation)", shown(0),
                       shown(1), shown(2));
  } catch (const std::exception& error) {
    return error.what();
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
    shown.reading = live(bridges);
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
  const auto ready = [&](const maintenance::WeightStep& step) {
    const auto ask = step.remark.empty() ? step.text() : step.remark + " " + step.text();
    return await(*bridges, {ask, "", false}, show, stop) == Answer::read;
  };
  const auto failed = [&](const std::string& why) {
    await(*bridges, {why + ". Repair it, and read again.", "", true}, show, stop);
    return true;
  };
  try {
    return maintenance::weigh(rig, *bridges, ready, failed);
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

}  // namespace turnpoint::ui
