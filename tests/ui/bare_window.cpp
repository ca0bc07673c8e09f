// bare_window: shows a QML window that holds one line of text, and logs when it was there. tests/ui/speed
// compares the start of the station with it.
#include <QGuiApplication>
#include <QQmlApplicationEngine>
#include <QQuickWindow>

#include "station/ui/platform/first_page.hpp"

int main(int argc, char** argv) {
  QGuiApplication application(argc, argv);
  QQmlApplicationEngine engine;
  engine.loadData("import QtQuick\nWindow { width: 1280; height: 800; Text { text: \"bare\" } }");
  auto* window = qobject_cast<QQuickWindow*>(engine.rootObjects().value(0));
  if (window == nullptr) return 1;
  turnpoint::ui::tell_first_page(*window);
  window->show();
  return application.exec();
}
