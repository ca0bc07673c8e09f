// Runs every tst_*.qml of this folder with the station's real QML module, without a screen.
#include <QQmlContext>
#include <QQmlEngine>
#include <QQmlExtensionPlugin>
#include <QtQuickTest>
#include <clocale>
#include <string>

#include "station/ui/platform/screen.hpp"
#include "tests/ui/operator_desk.hpp"
#include "tests/ui/page_inspector.hpp"
#include "tests/ui/real_session.hpp"
#include "tests/ui/scripted_session.hpp"
#include "tests/ui/station_room.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

class Setup : public QObject {
  Q_OBJECT

 public Q_SLOTS:
  // The application owns these objects, because their timers and pending calls must end before it does.
  void applicationAvailable() {
    if (qEnvironmentVariableIsSet("LC_NUMERIC") && std::string(std::localeconv()->decimal_point) != ",")
      qFatal("these pages should run with a decimal comma, but the locale of LC_NUMERIC was not found");
    script_ = new turnpoint::ui::ScriptedSession(QCoreApplication::instance());
    desk_ = new turnpoint::ui::OperatorDesk(*script_->bridge(), QCoreApplication::instance());
    inspector_ = new turnpoint::ui::PageInspector(QCoreApplication::instance());
    session_ = new turnpoint::ui::RealSession(QCoreApplication::instance());
    room_ = new turnpoint::ui::StationRoom(QCoreApplication::instance());
  }

  void qmlEngineAvailable(QQmlEngine* engine) {
    turnpoint::ui::set_fonts();
    engine->addImportPath("qrc:/qt/qml");
    engine->rootContext()->setContextProperty("script", script_);
    engine->rootContext()->setContextProperty("session", session_);
    engine->rootContext()->setContextProperty("desk", desk_);
    engine->rootContext()->setContextProperty("inspector", inspector_);
    engine->rootContext()->setContextProperty("room", room_);
  }

 private:
  turnpoint::ui::ScriptedSession* script_ = nullptr;
  turnpoint::ui::RealSession* session_ = nullptr;
  turnpoint::ui::OperatorDesk* desk_ = nullptr;
  turnpoint::ui::PageInspector* inspector_ = nullptr;
  turnpoint::ui::StationRoom* room_ = nullptr;
};

QUICK_TEST_MAIN_WITH_SETUP(pages, Setup)
#include "quick_tests.moc"
