// Renders every page in every size and language into PNG files, for people to look at:
//   screenshots --out DIR [--languages en,ja] [--sizes 800x480,1280x800] [--only rest,early]
#include <QCommandLineParser>
#include <QDir>
#include <QFile>
#include <QGuiApplication>
#include <QQmlApplicationEngine>
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
#include "tests/ui/gallery.hpp"
#include "tests/ui/operator_camera.hpp"
#include "tests/ui/operator_gallery.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

namespace {

using turnpoint::ui::Look;
using turnpoint::ui::OperatorCamera;
using turnpoint::ui::Panel;
using turnpoint::ui::panel_of;
using turnpoint::ui::SessionBridge;
using turnpoint::ui::StartController;
using turnpoint::ui::wait_for;

const QStringList kLanguages{"en", "de", "ja", "es", "zh", "ar"};

/// Renders the station's window for one panel in one language.
class Camera {
 public:
  Camera(const QString& out, const Panel& panel, const QString& prefix, const QStringList& only)
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
    if (!only_.isEmpty() && !only_.contains(name)) return;
    QGuiApplication::processEvents();
    const QString file = out_ + "/" + prefix_ + name + ".png";
    if (!window_->grabWindow().save(file)) qFatal("cannot write %s", qPrintable(file));
    ++count_;
  }

  void shoot(const turnpoint::session::Page& page, const QString& name) {
    if (!only_.isEmpty() && !only_.contains(name)) return;
    bridge_.show(page);
    QGuiApplication::processEvents();
    // Only the operator can open the end page with numbers.
    window_->findChild<QQuickItem*>("participantView")->setProperty("counting", name == "end-operator");
    shoot(name);
  }

  /// Renders the keypad for the operator's code: once at the start of a locked station, and once over a
  /// participant's page.
  void shoot_gate() {
    QMetaObject::invokeMethod(window_, "ask", Q_ARG(QString, "view"));
    auto* gate = window_->findChild<QQuickItem*>("gate");
    window_->setProperty("locked", true);
    shoot("gate-locked");
    window_->setProperty("locked", false);
    shoot("gate");
    QMetaObject::invokeMethod(gate, "abandoned");
  }

  int count() const { return count_; }

 private:
  QString out_, prefix_;
  QStringList only_;
  SessionBridge bridge_;
  turnpoint::ui::LiveModel live_;
  turnpoint::ui::ReportModel report_;
  StartController start_;
  turnpoint::ui::OperatorLock lock_{turnpoint::view::OperatorCode()};
  QQmlApplicationEngine engine_;
  QQuickWindow* window_ = nullptr;
  int count_ = 0;
};

/// A name for the pictures, and how the pages look in them.
using Looks = std::vector<std::pair<QString, Look>>;

Looks looks_of(const QStringList& languages) {
  Looks looks{{"dark", {"en", true}}, {"large", {"en", false, 200}}};
  for (const auto& language : languages) looks.push_back({language, {language}});
  return looks;
}

/// Calls `shoot` with a camera for each panel and each look. Returns the number of pictures.
int shoot_each(const QString& out, const QStringList& sizes, const Looks& looks,
               const std::function<void(OperatorCamera&)>& shoot) {
  int count = 0;
  for (const auto& size : sizes)
    for (const auto& [name, look] : looks) {
      OperatorCamera camera(out, panel_of(size), size + "-operator-" + name + "-", look);
      shoot(camera);
      count += camera.count();
    }
  return count;
}

/// The first item below `item` with this name; null if there is none.
QQuickItem* item_named(QQuickItem* item, const QString& name) {
  if (item->objectName() == name) return item;
  for (auto* child : item->childItems())
    if (auto* found = item_named(child, name)) return found;
  return nullptr;
}

/// Opens the dialog that asks why a session begins early.
void ask_reason(QQuickWindow& window) {
  auto* dialog = item_named(window.contentItem(), "early");
  if (dialog == nullptr) qFatal("the start page has no dialog for the reason");
  QMetaObject::invokeMethod(dialog, "open", Q_ARG(QString, "leaves the country tomorrow"));
}

/// Renders the start page after it has refused a session that begins too early, and the dialog that asks why
/// it does so nevertheless.
int shoot_early(const QString& out, const QStringList& sizes, const QStringList& languages) {
  using namespace turnpoint;
  const std::string source = TURNPOINT_SOURCE_DIR;
  const QTemporaryDir folder;
  QDir::setCurrent(folder.path());
  QFile::copy(QString::fromStdString(source + "/tests/support/thin_plate.toml"), "plate.toml");
  const session::StationRequest request{source + "/protocols", "plate.toml", ui::today_exhibit(".")};
  ui::OperatorController early(request);
  ui::StudiesController studies(request);
  ui::SessionsController sessions(request);
  ui::RigController rig(request);
  ui::DesignController design({folder.path().toStdString(), request.rig, request.protocols});
  for (int i = 0; i < early.protocols().size(); ++i)
    if (early.protocols()[i].toMap()["id"] == "friction-training") early.select(i);
  wait_for([&] { return !early.checking(); });
  early.enterParticipant("P01");
  early.begin();
  wait_for([&] { return !early.preparing() && !early.checking(); });
  const QVariantMap pages{{"operating", QVariant::fromValue(&early)},
                          {"studies", QVariant::fromValue(&studies)},
                          {"sessions", QVariant::fromValue(&sessions)},
                          {"rig", QVariant::fromValue(&rig)},
                          {"design", QVariant::fromValue(&design)}};
  const auto ready = [] { return true; };
  return shoot_each(out, sizes, looks_of(languages), [&](OperatorCamera& camera) {
    camera.shoot("StationPages.qml", "early", pages);
    camera.shoot("StationPages.qml", "early-reason", pages, ready, ask_reason);
  });
}

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
  weighed.selfTest();
  wait_for([&] { return weighed.busy().isEmpty(); });
  weighing.weigh();
  wait_for([&] { return weighing.asked() == "weight"; });
  return shoot_each(out, sizes, looks_of(languages), [&](OperatorCamera& camera) {
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
    for (const char* series : {"", "boundaries", "response", "friction", "sound", "panel_button"}) {
      weighed.guide()->begin(series);
      if (series == std::string("response")) {
        weighed.guide()->play();
        const auto percent = [&] {
          const auto readings = weighed.guide()->readings();
          return readings.isEmpty() ? 0 : readings[0].toMap()["percent"].toDouble();
        };
        wait_for([&] { return percent() > 1; });  // the first reading is from the ramp of the tone
      }
      camera.shoot("RigPage.qml", QString("guide-") + series,
                   {{"rig", QVariant::fromValue(&weighed)}, {"tab", "guide"}});
      weighed.guide()->leave();
    }
    camera.shoot("RigPage.qml", "self-test", {{"rig", QVariant::fromValue(&weighed)}, {"tab", "selfTest"}});
    camera.shoot("RigPage.qml", "residuals", {{"rig", QVariant::fromValue(&weighed)}, {"tab", "weights"}});
    const auto shoot_design = [&](const QString& picture, const QString& beside = "") {
      camera.shoot("DesignPage.qml", picture, {{"design", QVariant::fromValue(&design)}, {"beside", beside}},
                   design_ready);
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
  });
}

/// Renders the pages about a session in one language: the view of a running session, reports, and what is
/// measured or tried out apart from a session.
int shoot_sessions(const QString& out, const QStringList& sizes, const QString& shown,
                   turnpoint::ui::OperatorController& operating) {
  using namespace turnpoint;
  const std::string source = TURNPOINT_SOURCE_DIR, language = shown.toStdString();
  ui::PreviewController preview(
      {source + "/protocols/demo.toml", source + "/tests/support/thin_plate.toml", "", {}});
  ui::PreviewController zones(
      {source + "/protocols/friction-2ifc.toml", source + "/tests/support/thin_plate.toml", "", {}});
  wait_for([&] { return !preview.busy() && !zones.busy(); });
  const auto live = ui::live_exhibit("boundary-adaptive", 40, language),
             live2 = ui::live_exhibit("friction-2ifc", 12, language);
  const auto live3 = ui::live_exhibit("two-spots-oddity", 12, language);
  const auto report = ui::report_exhibit("speed-accuracy", language),
             report2 = ui::report_exhibit("boundary-constant", language),
             report3 = ui::forces_exhibit("speed-accuracy", language);
  const view::FingerGauges gauges{
      {0.45, 0.3, 0.6, "0.68 N"}, {0.4, 0.25, 0.55, "82 mm/s"}, {0.62, 0, 0, "186 mm"}};
  ui::LatencyController latency(rig::LatencyReference::photodiode);
  return shoot_each(out, sizes, {{shown, {shown}}}, [&](OperatorCamera& camera) {
    camera.shoot("OperatorPage.qml", "participant",
                 {{"operating", QVariant::fromValue(&operating)}, {"typing", true}});
    camera.shoot_live(live, "live");
    camera.shoot_live(live, "live-gauges", gauges);
    camera.shoot_live(live2, "live-2ifc");
    camera.shoot_live(live3, "live-oddity");
    camera.shoot_report(report, "report-trade");
    camera.shoot_report(report2, "report-boundary");
    camera.shoot_report(report3, "report-forces", "finger");
    camera.shoot_report(report3, "report-friction", "friction");
    camera.shoot("PreviewPage.qml", "preview", {{"controller", QVariant::fromValue(&preview)}},
                 [&] { return !preview.busy(); });
    camera.shoot("PreviewPage.qml", "preview-zone", {{"controller", QVariant::fromValue(&zones)}},
                 [&] { return !zones.busy(); });
    camera.shoot("LatencyPage.qml", "panel-latency", {{"controller", QVariant::fromValue(&latency)}});
  });
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
  int count = shoot_places(out, sizes, languages, operating);
  for (const auto& language : languages) count += shoot_sessions(out, sizes, language, operating);
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
  for (const char* mode : {"live", "pilot", "simulated"})
    for (const auto& exhibit : turnpoint::ui::gallery_in_mode(language.toStdString(), mode))
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
                     {"sizes", "Panel sizes in pixels, WIDTHxHEIGHT or WIDTHxHEIGHT@INCHES", "list",
                      "800x480,1280x800,1920x1080,800x1280"},
                     {"only", "Some participant's pages, early, operator", "list", ""}});
  parser.process(app);
  turnpoint::ui::set_fonts();
  const QString out = QDir(parser.value("out")).absolutePath();
  if (!QDir().mkpath(out)) qFatal("cannot make %s", qPrintable(out));
  const auto sizes = parser.value("sizes").split(','), languages = parser.value("languages").split(',');
  const auto only = parser.value("only").split(',', Qt::SkipEmptyParts);
  int count = 0;
  for (const auto& size : sizes) {
    for (const auto& language : languages) {
      if (!kLanguages.contains(language))
        qFatal("--languages: %s; allowed: en, de, ja, es, zh, ar", qPrintable(language));
      Camera camera(out, panel_of(size), size + "-" + language + "-", only);
      count += shoot_all(camera, language);
    }
  }
  const auto wanted = [&](const char* part) {
    return only.isEmpty() || only.contains("operator") || only.contains(part);
  };
  if (wanted("early")) count += shoot_early(out, sizes, languages);
  if (wanted("operator")) count += shoot_operator(out, sizes, languages);
  std::printf("%d pictures in %s\n", count, qPrintable(QDir(out).absolutePath()));
  return 0;
}
