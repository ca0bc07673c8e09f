#pragma once
#include <QQmlApplicationEngine>
#include <QQuickWindow>
#include <QString>
#include <QVariantMap>

namespace turnpoint::ui {

/// Opens a window of the module's QML file `page` ("Main.qml"), which belongs to the engine, with these
/// properties. Throws std::runtime_error where it does not load.
QQuickWindow& load_page(QQmlApplicationEngine& engine, const QString& page, const QVariantMap& properties);

}  // namespace turnpoint::ui
