// held_start: simulates a start that takes very long. Makes the application object on the panel's own frame
// buffer (if there is none, Qt continues without a screen), prints "held", and never reaches its event loop.
#include <unistd.h>

#include <cstdio>

#include "station/ui/platform/platform.hpp"

int main() {
  qputenv("QT_QPA_PLATFORM", "linuxfb:fb=/dev/null");
  const turnpoint::ui::Application application;
  std::puts("held");
  std::fflush(stdout);
  for (;;) ::pause();
}
