// Renders every page in every size and language into PNG files, for people to look at:
//   screenshots --out DIR [--languages en,ja] [--sizes 800x480,1280x800] [--only NAME]
#include <QCommandLineParser>
#include <QDir>
#include <QFile>
#include <QGuiApplication>
#include <QQmlApplicationEngine>
#include <QQmlComponent>
#include <QQmlExtensionPlugin>
#include <QQuickItem>
#include <QQuickWindow>
#include <QTemporaryDir>
#include <QTest>
#include <cstdio>
#include <functional>
#include <utility>
#include <vector>

#include "station/ui/operator/design_controller.hpp"
#include "station/ui/operator/latency_controller.hpp"
#include "station/ui/operator/live_model.hpp"
#include "station/ui/operator/operator_controller.hpp"
#include "station/ui/operator/operator_lock.hpp"
#include "station/ui/operator/preview_controller.hpp"
#include "station/ui/operator/report_model.hpp"
#include "station/ui/operator/rig_controller.hpp"
#include "station/ui/operator/sessions_controller.hpp"
#include "station/ui/operator/studies_controller.hpp"
#include "station/ui/participant/session_bridge.hpp"
#include "station/ui/participant/start_controller.hpp"
#include "station/ui/platform/screen.hpp"
#include "station/ui/shared/operator_screen.hpp"
#include "tests/ui/gallery.hpp"
#include "tests/ui/operator_gallery.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

namespace {

using turnpoint::ui::SessionBridge;
using turnpoint::ui::StartController;

const QStringList kLanguages{"en", "de", "ja", "es", "zh", "ar"};

/// A panel for which pages are rendered: its size in pixels, and the pixel density of a common panel of this
/// size.
struct Panel {
  QSize size;
  double pixels_per_mm;
};

Panel panel_of(const QString& text) {
  const auto parts = text.split('x');
  if (parts.size() != 2) qFatal("--sizes: %s; allowed: WIDTHxHEIGHT", qPrintable(text));
  const QSize size(parts[0].toInt(), parts[1].toInt());
  return {size, size.width() <= 800    ? 5.2
                : size.width() <= 1280 ? 5.9
                                       : 5.6};  // px per mm for diagonals of 7", 10.1" and 15.6"
}

/// Renders the station's window for one panel in one language.
class Camera {
 public:
  Camera(const QString& out, const Panel& panel, const QString& prefix, const QString& only)
      : out_(out),
        prefix_(prefix),
        only_(only),
        bridge_([] { return 0; }, [](const auto&) {}),
        live_(bridge_),
        start_([](const QString&) { return true; }) {
    engine_.addImportPath("qrc:/qt/qml");
    engine_.setInitialProperties({{"bridge", QVariant::fromValue(&bridge_)},
                                  {"start", QVariant::fromValue(&start_)},
                                  {"live", QVariant::fromValue(&live_)},
                                  {"operatorLock", QVariant::fromValue(&lock_)},
                                  {"report", QVariant::fromValue(&report_)},
                                  {"pixelsPerMm", panel.pixels_per_mm}});
    engine_.load(QUrl("qrc:/qt/qml/Turnpoint/Main.qml"));
    window_ = engine_.rootObjects().isEmpty() ? nullptr
                                              : qobject_cast<QQuickWindow*>(engine_.rootObjects().first());
    if (window_ == nullptr) qFatal("Main.qml does not load");
    window_->resize(panel.size);
  }

  StartController& start() { return start_; }

  void shoot(const QString& name) {
    if (!only_.isEmpty() && only_ != name) return;
    QGuiApplication::processEvents();
    const QString file = out_ + "/" + prefix_ + name + ".png";
    if (!window_->grabWindow().save(file)) qFatal("cannot write %s", qPrintable(file));
    ++count_;
  }

  void shoot(const turnpoint::session::Page& page, const QString& name) {
    bridge_.show(page);
    QGuiApplication::processEvents();
    // Only the operator can open the end page with numbers.
    window_->findChild<QQuickItem*>("participantView")->setProperty("counting", name == "end-operator");
    shoot(name);
  }

  /// Renders the keypad for the operator's code: once at the start of a locked station, and once over a
  /// participant's page.
  void shoot_gate() {
    auto* gate = window_->findChild<QQuickItem*>("gate");
    gate->setVisible(true);
    window_->setProperty("locked", true);
    shoot("gate-locked");
    window_->setProperty("locked", false);
    shoot("gate");
    gate->setVisible(false);
  }

  int count() const { return count_; }

 private:
  QString out_, prefix_, only_;
  SessionBridge bridge_;
  turnpoint::ui::LiveModel live_;
  turnpoint::ui::ReportModel report_;
  StartController start_;
  turnpoint::ui::OperatorLock lock_{turnpoint::desk::OperatorCode()};
  QQmlApplicationEngine engine_;
  QQuickWindow* window_ = nullptr;
  int count_ = 0;
};

/// Runs the event loop until `ready` returns true, for at most a minute.
template <typename Ready>
void wait_for(Ready ready) {
  for (int i = 0; i < 6000 && !ready(); ++i) QTest::qWait(10);
}

/// How the operator's pages look.
struct Look {
  QString language = "en";
  bool dark = false;
  int text_percent = 100;
};

/// Renders a single operator's page in a window of its own.
class OperatorCamera {
 public:
  OperatorCamera(const QString& out, const Panel& panel, const QString& prefix, Look look = {})
      : out_(out),
        look_(std::move(look)),
        panel_(panel),
        prefix_(prefix),
        bridge_([] { return 0; }, [](const auto&) {}),
        live_(bridge_) {}

  /// Waits until `ready` returns true before it takes the picture.
  void shoot(
      const QString& page, const QString& name, QVariantMap properties,
      const std::function<bool()>& ready = [] { return true; }) {
    properties["pixelsPerMm"] = panel_.pixels_per_mm;
    QQmlEngine engine;
    engine.addImportPath("qrc:/qt/qml");
    using turnpoint::ui::OperatorScreen;
    auto* screen = engine.singletonInstance<OperatorScreen*>(qmlTypeId("Turnpoint", 1, 0, "OperatorScreen"));
    screen->set_language(look_.language);
    screen->set_dark(look_.dark);
    screen->set_text_percent(look_.text_percent);
    QQmlComponent component(&engine, QUrl("qrc:/qt/qml/Turnpoint/" + page));
    QQuickWindow window;
    auto* item = qobject_cast<QQuickItem*>(component.createWithInitialProperties(properties));
    if (item == nullptr) qFatal("%s: %s", qPrintable(page), qPrintable(component.errorString()));
    item->setParentItem(window.contentItem());
    item->setSize(panel_.size);
    window.resize(panel_.size);
    window.show();
    wait_for(ready);
    QGuiApplication::processEvents();
    const QString file = out_ + "/" + prefix_ + name + ".png";
    if (!window.grabWindow().save(file)) qFatal("cannot write %s", qPrintable(file));
    ++count_;
    delete item;
  }

  void shoot_live(const turnpoint::desk::LiveState& state, const QString& name) {
    turnpoint::session::Page page;
    page.kind = turnpoint::session::PageKind::interval;
    page.run_mode = "pilot";
    bridge_.show(page);
    live_.take(state);
    QGuiApplication::processEvents();
    shoot("LiveView.qml", name,
          {{"live", QVariant::fromValue(&live_)}, {"bridge", QVariant::fromValue(&bridge_)}});
  }

  /// `picture` is the number of the figure to show.
  void shoot_report(const turnpoint::desk::ReportPages& pages, const QString& name, int picture = 0) {
    report_.take(pages);
    QGuiApplication::processEvents();
    shoot("ReportPage.qml", name,
          {{"report", QVariant::fromValue(&report_)}, {"runMode", "pilot"}, {"shown", picture}});
  }

  int count() const { return count_; }

 private:
  QString out_;
  Look look_;
  Panel panel_;
  QString prefix_;
  SessionBridge bridge_;
  turnpoint::ui::LiveModel live_;
  turnpoint::ui::ReportModel report_;
  int count_ = 0;
};

/// The designer with a study that has a mistake, so that a problem is at its field.
void begin_study(turnpoint::ui::DesignController& design) {
  design.make("contrast", "my-study");
  auto text = design.text();
  design.setText(text.replace("deadline_s = 3.0", "deadline_s = -3.0"));
}

/// Renders the operator's pages with their bar in several languages, in the dark theme, and with large text.
int shoot_places(const QString& out, const QStringList& sizes, const QStringList& languages,
                 turnpoint::ui::OperatorController& operating) {
  using namespace turnpoint;
  const auto& request = operating.request();
  ui::StudiesController studies(request);
  studies.open();
  studies.select(3);
  wait_for([&] { return !studies.checking(); });
  ui::SessionsController sessions(request);
  ui::RigController rig(request);
  rig.selfTest();
  wait_for([&] { return rig.busy().isEmpty(); });
  rig.examine();
  wait_for([&] { return rig.busy().isEmpty(); });
  const QTemporaryDir studies_folder;
  ui::DesignController design(
      {studies_folder.path().toStdString(), request.rig, TURNPOINT_SOURCE_DIR "/protocols"});
  const auto design_ready = [&] {
    return design.verdict() != "checking" &&
           (design.stage() != "form" || design.verdict() == "bad" || !design.profiles().isEmpty()) &&
           !design.precision()->busy();
  };
  auto with_cells = request;
  with_cells.rig = "plate-with-cells.toml";
  QFile::copy(TURNPOINT_SOURCE_DIR "/deploy/rigs/simulated-forces.toml", "plate-with-cells.toml");
  ui::RigController weighing(with_cells), weighed(with_cells);
  weighed.weigh();
  while (!weighed.busy().isEmpty()) {
    wait_for([&] { return weighed.busy().isEmpty() || weighed.asked() == "weight"; });
    weighed.answer("read");
  }
  weighing.weigh();
  wait_for([&] { return weighing.asked() == "weight"; });
  std::vector<std::pair<QString, Look>> looks{{"dark", {"en", true}}, {"large", {"en", false, 200}}};
  for (const auto& language : languages) looks.push_back({language, {language}});
  int count = 0;
  for (const auto& size : sizes)
    for (const auto& [name, look] : looks) {
      OperatorCamera camera(out, panel_of(size), size + "-operator-" + name + "-", look);
      design.close();
      for (const char* place : {"run", "studies", "sessions", "rig"})
        camera.shoot("StationPages.qml", place,
                     {{"operating", QVariant::fromValue(&operating)},
                      {"studies", QVariant::fromValue(&studies)},
                      {"sessions", QVariant::fromValue(&sessions)},
                      {"rig", QVariant::fromValue(&rig)},
                      {"design", QVariant::fromValue(&design)},
                      {"shown", place}},
                     [&] { return !studies.checking() && !operating.checking(); });
      camera.shoot("RigPage.qml", "weights", {{"rig", QVariant::fromValue(&weighing)}, {"tab", "weights"}});
      for (const char* series : {"", "boundaries", "response", "friction", "sound"}) {
        weighed.guide()->begin(series);
        camera.shoot("RigPage.qml", QString("guide-") + series,
                     {{"rig", QVariant::fromValue(&weighed)}, {"tab", "guide"}});
        weighed.guide()->leave();
      }
      camera.shoot("RigPage.qml", "residuals", {{"rig", QVariant::fromValue(&weighed)}, {"tab", "weights"}});
      const auto shoot_design = [&](const QString& picture, const QString& beside = "") {
        camera.shoot("DesignPage.qml", picture,
                     {{"design", QVariant::fromValue(&design)}, {"beside", beside}}, design_ready);
        design.precision()->set_watched(false);
      };
      design.startNew();
      shoot_design("design-goals");
      design.make("contrast", "my-study");
      for (int section = 0; section < 7; ++section) {
        design.show(section);
        shoot_design("design-" + QString::number(section));
      }
      for (const char* beside : {"text", "pages", "precision"})
        shoot_design(QString("design-") + beside, beside);
      design.pages()->show(2);
      design.pages()->choose("de");
      shoot_design("design-pages-trial", "pages");
      shoot_design("design-check", "check");
      begin_study(design);
      design.show(5);
      shoot_design("design-problem");
      count += camera.count();
    }
  return count;
}

int shoot_operator(const QString& out, const QStringList& sizes, const QStringList& languages) {
  using namespace turnpoint;
  const std::string source = TURNPOINT_SOURCE_DIR;
  // Short relative names, so that a picture in a manual shows no folder of the machine on which it was made.
  const QTemporaryDir folder;
  QDir::setCurrent(folder.path());
  QFile::copy(QString::fromStdString(source + "/tests/support/thin_plate.toml"), "plate.toml");
  ui::interrupted_exhibit(".");
  ui::OperatorController operating({source + "/protocols", "plate.toml", "lab.sqlite"});
  operating.select(9);
  wait_for([&] { return !operating.checking(); });
  ui::OperatorController early({source + "/protocols", "plate.toml", ui::today_exhibit(".")});
  for (int i = 0; i < early.protocols().size(); ++i)
    if (early.protocols()[i].toMap()["id"] == "friction-training") early.select(i);
  wait_for([&] { return !early.checking(); });
  early.enterParticipant("P01");
  early.begin();
  wait_for([&] { return !early.preparing(); });
  const int places = shoot_places(out, sizes, languages, operating);
  ui::PreviewController preview(
      {source + "/protocols/demo.toml", source + "/tests/support/thin_plate.toml", "", {}});
  ui::PreviewController zones(
      {source + "/protocols/friction-2ifc.toml", source + "/tests/support/thin_plate.toml", "", {}});
  wait_for([&] { return !preview.busy() && !zones.busy(); });
  const auto live = ui::live_exhibit("boundary-adaptive", 40), live2 = ui::live_exhibit("friction-2ifc", 12);
  const auto live3 = ui::live_exhibit("two-spots-oddity", 12);
  const auto report = ui::report_exhibit("speed-accuracy"), report2 = ui::report_exhibit("boundary-constant"),
             report3 = ui::forces_exhibit("speed-accuracy");
  ui::LatencyController latency(calibration::LatencyReference::photodiode);
  int count = places;
  for (const auto& size : sizes) {
    OperatorCamera camera(out, panel_of(size), size + "-operator-");
    camera.shoot("OperatorPage.qml", "start", {{"operating", QVariant::fromValue(&operating)}});
    camera.shoot("OperatorPage.qml", "early", {{"operating", QVariant::fromValue(&early)}});
    camera.shoot("OperatorPage.qml", "participant",
                 {{"operating", QVariant::fromValue(&operating)}, {"typing", true}});
    camera.shoot_live(live, "live");
    camera.shoot_live(live2, "live-2ifc");
    camera.shoot_live(live3, "live-oddity");
    camera.shoot_report(report, "report-trade");
    camera.shoot_report(report2, "report-boundary");
    camera.shoot_report(report3, "report-forces", 3);
    camera.shoot_report(report3, "report-friction", 4);
    camera.shoot("PreviewPage.qml", "preview", {{"controller", QVariant::fromValue(&preview)}});
    camera.shoot("PreviewPage.qml", "preview-zone", {{"controller", QVariant::fromValue(&zones)}});
    camera.shoot("LatencyPage.qml", "panel-latency", {{"controller", QVariant::fromValue(&latency)}});
    count += camera.count();
  }
  return count;
}

int shoot_all(Camera& camera, const QString& language) {
  camera.shoot_gate();
  camera.start().ask({kLanguages, "", "", "2026-03", "pilot"});
  camera.shoot("language");
  camera.start().chooseLanguage(static_cast<int>(kLanguages.indexOf(language)));
  camera.shoot("consent");
  camera.start().consent();
  camera.shoot("code");
  camera.start().enterCode("P07");
  for (const auto& exhibit : turnpoint::ui::gallery(language.toStdString()))
    camera.shoot(exhibit.page, QString::fromStdString(exhibit.name));
  return camera.count();
}

}  // namespace

int main(int argc, char** argv) {
  if (!qEnvironmentVariableIsSet("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "offscreen");
  if (!qEnvironmentVariableIsSet("QT_QUICK_BACKEND")) qputenv("QT_QUICK_BACKEND", "software");
  QGuiApplication app(argc, argv);
  QCommandLineParser parser;
  parser.addHelpOption();
  parser.addOptions({{"out", "Folder for the pictures", "dir", "screenshots"},
                     {"languages", "Languages", "list", "en,ja"},
                     {"sizes", "Panel sizes in pixels", "list", "800x480,1280x800,1920x1080"},
                     {"only", "One page", "name", ""}});
  parser.process(app);
  turnpoint::ui::set_fonts();
  const QString out = QDir(parser.value("out")).absolutePath();
  if (!QDir().mkpath(out)) qFatal("cannot make %s", qPrintable(out));
  int count = 0;
  for (const auto& size : parser.value("sizes").split(',')) {
    for (const auto& language : parser.value("languages").split(',')) {
      if (!kLanguages.contains(language))
        qFatal("--languages: %s; allowed: en, de, ja, es, zh, ar", qPrintable(language));
      Camera camera(out, panel_of(size), size + "-" + language + "-", parser.value("only"));
      count += shoot_all(camera, language);
    }
  }
  if (parser.value("only").isEmpty() || parser.value("only") == "operator")
    count += shoot_operator(out, parser.value("sizes").split(','), parser.value("languages").split(','));
  std::printf("%d pictures in %s\n", count, qPrintable(QDir(out).absolutePath()));
  return 0;
}
