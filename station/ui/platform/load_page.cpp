#include "station/ui/platform/load_page.hpp"

#include <stdexcept>

namespace turnpoint::ui {

QQuickWindow& load_page(QQmlApplicationEngine& engine, const QString& page, const QVariantMap& properties) {
  engine.addImportPath("qrc:/qt/qml");
  engine.setInitialProperties(properties);
  engine.load(QUrl("qrc:/qt/qml/Turnpoint/" + page));
  auto* window =
      engine.rootObjects().isEmpty() ? nullptr : qobject_cast<QQuickWindow*>(engine.rootObjects().first());
  if (window == nullptr)
    throw std::runtime_error("the pages of the touchscreen could not be loaded: " + page.toStdString());
  return *window;
}

}  // namespace turnpoint::ui
