#pragma once
#include <QQmlApplicationEngine>
#include <QQuickWindow>
#include <QString>
#include <QVariantMap>

namespace turnpoint::ui {

/// Opens a window of the module's QML file `page` ("Main.qml") with these properties. The engine owns the
/// window. Throws std::runtime_error if it does not load.
QQuickWindow& load_page(QQmlApplicationEngine& engine, const QString& page, const QVariantMap& properties);

}  // namespace turnpoint::ui
