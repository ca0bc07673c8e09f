// held_start: simulates a program whose start hangs. It creates the application object on the frame buffer of
// the panel, prints "held", and never reaches its event loop. If there is no frame buffer, Qt continues
// without a screen.
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
