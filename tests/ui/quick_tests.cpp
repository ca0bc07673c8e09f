// Runs every tst_*.qml of this folder against the real module, without a screen.
#include <QQmlContext>
#include <QQmlEngine>
#include <QQmlExtensionPlugin>
#include <QtQuickTest>

#include "station/ui/screen.hpp"
#include "tests/ui/real_session.hpp"
#include "tests/ui/scripted_session.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

class Setup : public QObject {
  Q_OBJECT

 public slots:
  void qmlEngineAvailable(QQmlEngine* engine) {
    turnpoint::ui::set_fonts();
    engine->addImportPath("qrc:/qt/qml");
    engine->rootContext()->setContextProperty("script", &script_);
    engine->rootContext()->setContextProperty("sitting", &sitting_);
  }

 private:
  turnpoint::ui::ScriptedSession script_;
  turnpoint::ui::RealSession sitting_;
};

QUICK_TEST_MAIN_WITH_SETUP(pages, Setup)
#include "quick_tests.moc"
