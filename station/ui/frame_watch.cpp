#include "station/ui/frame_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace turnpoint::ui {

FrameWatch::FrameWatch(Clock clock, QObject* parent) : QObject(parent), clock_(std::move(clock)) {}

void FrameWatch::follow(QQuickWindow* window, double refresh_Hz) {
  window_ = window;
  refresh_Hz_ = refresh_Hz > 0 ? refresh_Hz : 60;
  // On the rendering thread, whichever that is: the time is what counts.
  connect(
      window, &QQuickWindow::frameSwapped, this, [this] { swapped(); }, Qt::DirectConnection);
}

void FrameWatch::asked() {
  asked_ns_ = clock_();
  if (window_ != nullptr) window_->update();
}

void FrameWatch::swapped() {
  const auto asked = asked_ns_.exchange(0);
  if (asked != 0) lost_ += lost(clock_() - asked, refresh_Hz_);
}

int FrameWatch::lost(std::int64_t waited_ns, double refresh_Hz) {
  const double refreshes = static_cast<double>(waited_ns) * 1e-9 * refresh_Hz;
  return std::max(0, static_cast<int>(std::floor(refreshes)) - 1);
}

}  // namespace turnpoint::ui
