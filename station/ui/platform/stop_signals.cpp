#include "station/ui/platform/stop_signals.hpp"

#include <QCoreApplication>

namespace turnpoint::ui {

StopSignals::StopSignals() : woken_(signals_.descriptor(), QSocketNotifier::Read) {
  // Do not use quit(), because any window could refuse it.
  connect(&woken_, &QSocketNotifier::activated, this, [this] {
    woken_.setEnabled(false);
    QCoreApplication::exit(0);
  });
}

StopSignals::~StopSignals() { woken_.setEnabled(false); }

void StopSignals::take_over() { signals_.take_over(); }

}  // namespace turnpoint::ui
