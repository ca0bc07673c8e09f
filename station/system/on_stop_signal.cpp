#include "station/system/on_stop_signal.hpp"

#include <utility>

namespace turnpoint::system {

OnStopSignal::OnStopSignal(std::function<void(const std::string& signal)> act) {
  signals_.take_over();
  waiter_ = std::jthread([this, act = std::move(act)] {
    if (const auto signal = signals_.wait(); !signal.empty()) act(signal);
  });
}

}  // namespace turnpoint::system
