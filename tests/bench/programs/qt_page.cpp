// qt_page: a Qt Quick page with two buttons, to test screen and touch without the station's own pages. Prints
// "shown" once it has been drawn, and "tapped left" or "tapped right"; a tapped button turns green.
#include <QGuiApplication>
#include <QQmlComponent>
#include <QQuickView>
#include <cstdio>

namespace {
constexpr char page[] = R"(
import QtQuick
Rectangle {
  id: page
  color: "#202020"
  signal tapped(string name)
  Repeater {
    model: ["left", "right"]
    Rectangle {
      id: target
      required property string modelData
      required property int index
      x: index * page.width / 2 + 40; y: 120
      width: page.width / 2 - 80; height: page.height - 240
      color: "#ff0000"
      TapHandler { onTapped: { target.color = "#00ff00"; page.tapped(target.modelData) } }
    }
  }
}
)";
}  // namespace

class Printer : public QObject {
  Q_OBJECT
 public Q_SLOTS:
  void tapped(const QString& name) { std::printf("tapped %s\n", qPrintable(name)), std::fflush(stdout); }
};

int main(int argc, char** argv) {
  QGuiApplication app(argc, argv);
  QQuickView view;
  QQmlComponent component(view.engine());
  component.setData(page, QUrl());
  auto* root = component.create();
  if (root == nullptr) return std::fprintf(stderr, "%s\n", qPrintable(component.errorString())), 1;
  Printer printer;
  QObject::connect(root, SIGNAL(tapped(QString)), &printer, SLOT(tapped(QString)));
  view.setResizeMode(QQuickView::SizeRootObjectToView);
  view.setContent(QUrl(), &component, root);
  bool said = false;
  QObject::connect(&view, &QQuickView::frameSwapped, [&said] {
    if (!std::exchange(said, true)) std::puts("shown"), std::fflush(stdout);
  });
  view.showFullScreen();
  return app.exec();
}

#include "qt_page.moc"
