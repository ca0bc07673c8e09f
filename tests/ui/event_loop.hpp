#pragma once
#include <QCoreApplication>

namespace turnpoint {

/// The application object that Qt needs for events; a test has one. `Application` may be QGuiApplication.
template <class Application = QCoreApplication>
struct EventLoop {
  int argc = 1;
  char name[5] = "test";
  char* argv[2] = {name, nullptr};
  Application application{argc, argv};
};

}  // namespace turnpoint
