// held_start: makes the application object on the panel's own frame buffer (where there is none, Qt goes on
// without a screen), says "held", and never comes to its event loop: a start that takes very long.
#include <unistd.h>

#include <cstdio>

#include "station/ui/platform.hpp"

int main() {
  qputenv("QT_QPA_PLATFORM", "linuxfb:fb=/dev/null");
  const turnpoint::ui::Application application;
  std::puts("held");
  std::fflush(stdout);
  for (;;) ::pause();
}
