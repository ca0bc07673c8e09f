#include "station/ui/platform/first_page.hpp"

#include <time.h>
#include <unistd.h>

#include <QLoggingCategory>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace turnpoint::ui {

namespace {

Q_LOGGING_CATEGORY(startup, "turnpoint.startup", QtWarningMsg)

double seconds_of(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds since the kernel started this process, with a resolution of 10 ms.
double process_age_s() {
  std::ifstream stat("/proc/self/stat");
  const std::string line{std::istreambuf_iterator<char>(stat), {}};
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) fields >> field;  // field 22 is the start time in ticks since boot
  return seconds_of(CLOCK_BOOTTIME) -
         static_cast<double>(std::stoll(field)) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

}  // namespace

void tell_first_page(QQuickWindow& window) {
  if (!startup().isInfoEnabled()) return;
  QObject::connect(
      &window, &QQuickWindow::frameSwapped, &window,
      [] {
        qCInfo(startup) << "first page after" << 1e3 * process_age_s() << "ms and"
                        << 1e3 * seconds_of(CLOCK_PROCESS_CPUTIME_ID) << "ms of processor time";
      },
      static_cast<Qt::ConnectionType>(Qt::DirectConnection | Qt::SingleShotConnection));
}

}  // namespace turnpoint::ui
