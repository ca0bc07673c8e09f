// Renders every page in every size and language into PNG files, for people to look at:
//   screenshots --out DIR [--languages en,ja,dark] [--sizes 800x480,1280x800] [--only rest,early]
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
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
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

using turnpoint::ui::DesignController;
using turnpoint::ui::Look;
using turnpoint::ui::OperatorCamera;
using turnpoint::ui::OperatorController;
using turnpoint::ui::Panel;
using turnpoint::ui::panel_of;
using turnpoint::ui::RigController;
using turnpoint::ui::SessionBridge;
using turnpoint::ui::StartController;
using turnpoint::ui::wait_for;

const QString kSource = TURNPOINT_SOURCE_DIR;
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

/// The operator's pages have these looks besides those of the languages.
const std::vector<std::pair<QString, Look>> kLooks{{"dark", {"en", true}}, {"large", {"en", false, 200}}};

Look look_of(const QString& name) {
  for (const auto& [known, look] : kLooks)
    if (known == name) return look;
  return {name};
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

/// The designer with a study that has a mistake, so that a problem is at its field.
void begin_study(DesignController& design) {
  design.make("contrast", "my-study");
  auto text = design.text();
  design.setText(text.replace("deadline_s = 3.0", "deadline_s = -3.0"));
}

/// A picture of an operator's page.
struct OperatorPicture {
  QString name;
  std::function<void(OperatorCamera&)> shoot;
};

/// Returns a function that makes something in a language, and remembers it.
template <typename Make>
auto by_language(const Make& make) {
  using Made = std::invoke_result_t<Make, std::string>;
  return [make, made = std::make_shared<std::map<std::string, Made>>()](
             const std::string& language) -> const Made& {
    const auto found = made->find(language);
    return found != made->end() ? found->second : made->emplace(language, make(language)).first->second;
  };
}

/// Prepares what the operator's pages show, each thing when the first picture needs it. All files are in a
/// temporary folder, which is the current one, so that a picture in a manual shows no folder of the machine
/// on which it was made.
class OperatorStudio {
 public:
  OperatorStudio() {
    QDir::setCurrent(folder_.path());
    QFile::copy(kSource + "/tests/support/thin_plate.toml", "plate.toml");
    QFile::copy(kSource + "/deploy/rigs/simulated-forces.toml", "plate-with-cells.toml");
  }

  std::vector<OperatorPicture> pictures() {
    std::vector<OperatorPicture> all;
    add_places(all);
    add_rig(all);
    add_design(all);
    add_sessions(all);
    add_tools(all);
    return all;
  }

 private:
  void add_places(std::vector<OperatorPicture>& all) {
    for (const char* place : {"run", "studies", "sessions", "rig"})
      all.push_back({place, [this, place](OperatorCamera& camera) {
                       if (place == std::string("studies")) choose_study();
                       if (place == std::string("rig")) examine_rig();
                       design().close();
                       auto pages = station_pages(operating());
                       pages["shown"] = place;
                       camera.shoot("StationPages.qml", place, pages,
                                    [this] { return !studies_->checking() && !operating_->checking(); });
                     }});
    const auto ready = [] { return true; };
    all.push_back({"early", [=, this](OperatorCamera& camera) {
                     camera.shoot("StationPages.qml", "early", station_pages(early()), ready);
                   }});
    all.push_back({"early-reason", [=, this](OperatorCamera& camera) {
                     camera.shoot("StationPages.qml", "early-reason", station_pages(early()), ready,
                                  ask_reason);
                   }});
    all.push_back({"participant", [this](OperatorCamera& camera) {
                     camera.shoot("OperatorPage.qml", "participant",
                                  {{"operating", QVariant::fromValue(&operating())}, {"typing", true}});
                   }});
  }

  void add_rig(std::vector<OperatorPicture>& all) {
    const auto add = [&all](
                         const QString& name, const QString& tab,
                         const std::function<RigController&()>& prepared,
                         const std::function<void(RigController&)>& leave = [](RigController&) {}) {
      all.push_back({name, [=](OperatorCamera& camera) {
                       auto& rig = prepared();
                       camera.shoot("RigPage.qml", name, {{"rig", QVariant::fromValue(&rig)}, {"tab", tab}});
                       leave(rig);
                     }});
    };
    add("weights", "weights", [this]() -> RigController& { return weighing(); });
    for (const QString series : {"", "boundaries", "response", "friction", "sound", "panel_button"})
      add(
          "guide-" + series, "guide", [this, series]() -> RigController& { return guided(series); },
          [](RigController& rig) { rig.guide()->leave(); });
    add("self-test", "selfTest", [this]() -> RigController& { return weighed(); });
    add("residuals", "weights", [this]() -> RigController& { return weighed(); });
  }

  void add_design(std::vector<OperatorPicture>& all) {
    const auto add = [&](
                         const QString& name, const QString& beside, const std::function<void()>& prepare,
                         const std::function<void()>& leave = [] {}) {
      all.push_back({name, [=, this](OperatorCamera& camera) {
                       prepare();
                       camera.shoot("DesignPage.qml", name,
                                    {{"design", QVariant::fromValue(&design())}, {"beside", beside}},
                                    [this] { return design_ready(); });
                       design().precision()->set_watched(false);
                       leave();
                     }});
    };
    const auto made = [this](int section) {
      if (design().stage() != "form") design().make("contrast", "my-study");
      design().show(section);
    };
    add("design-goals", "", [this] { design().startNew(); });
    for (int section = 0; section < 7; ++section)
      add("design-" + QString::number(section), "", [=] { made(section); });
    for (const QString beside : {"text", "pages", "precision"})
      add("design-" + beside, beside, [=] { made(6); });
    const auto close = [this] { design().close(); };
    add(
        "design-pages-trial", "pages",
        [=, this] {
          made(6);
          design().pages()->show(2);
          design().pages()->choose("de");
        },
        close);
    add("design-check", "check", [=] { made(6); });
    add(
        "design-problem", "",
        [this] {
          begin_study(design());
          design().show(5);
        },
        close);
  }

  /// The view of a running session, and reports.
  static void add_sessions(std::vector<OperatorPicture>& all) {
    using namespace turnpoint;
    const auto live = [](const char* protocol, int trials) {
      return by_language(
          [=](const std::string& language) { return ui::live_exhibit(protocol, trials, language); });
    };
    const auto add_live = [&all](const char* name, const auto& exhibit,
                                 const std::optional<view::FingerGauges>& gauges = std::nullopt) {
      all.push_back({name, [=](OperatorCamera& camera) {
                       camera.shoot_live(exhibit(camera.language()), name, gauges);
                     }});
    };
    const auto adaptive = live("boundary-adaptive", 40);
    add_live("live", adaptive);
    add_live(
        "live-gauges", adaptive,
        view::FingerGauges{{0.45, 0.3, 0.6, "0.68 N"}, {0.4, 0.25, 0.55, "82 mm/s"}, {0.62, 0, 0, "186 mm"}});
    add_live("live-2ifc", live("friction-2ifc", 12));
    add_live("live-oddity", live("two-spots-oddity", 12));
    const auto report = [](const char* protocol, auto exhibit) {
      return by_language([=](const std::string& language) { return exhibit(protocol, language); });
    };
    const auto add_report = [&all](const char* name, const auto& exhibit, const char* figure = "") {
      all.push_back({name, [=](OperatorCamera& camera) {
                       camera.shoot_report(exhibit(camera.language()), name, figure);
                     }});
    };
    add_report("report-trade", report("speed-accuracy", ui::report_exhibit));
    add_report("report-boundary", report("boundary-constant", ui::report_exhibit));
    const auto forces = report("speed-accuracy", ui::forces_exhibit);
    add_report("report-forces", forces, "finger");
    add_report("report-friction", forces, "friction");
  }

  /// What is measured or tried out apart from a session.
  void add_tools(std::vector<OperatorPicture>& all) {
    using turnpoint::ui::PreviewController;
    const auto add_preview = [&](const char* name, const char* protocol) {
      const auto controller = std::make_shared<std::unique_ptr<PreviewController>>();
      all.push_back({name, [=](OperatorCamera& camera) {
                       auto& preview = *controller;
                       if (!preview)
                         preview = std::make_unique<PreviewController>(turnpoint::view::PreviewRequest{
                             (kSource + "/protocols/" + protocol + ".toml").toStdString(),
                             (kSource + "/tests/support/thin_plate.toml").toStdString(),
                             "",
                             {}});
                       camera.shoot("PreviewPage.qml", name,
                                    {{"controller", QVariant::fromValue(preview.get())}},
                                    [&] { return !preview->busy(); });
                     }});
    };
    add_preview("preview", "demo");
    add_preview("preview-zone", "friction-2ifc");
    all.push_back(
        {"panel-latency", [this](OperatorCamera& camera) {
           camera.shoot("LatencyPage.qml", "panel-latency", {{"controller", QVariant::fromValue(&latency_)}});
         }});
  }

  /// The pages with their bar.
  QVariantMap station_pages(OperatorController& shown) {
    if (!studies_) studies_.emplace(request_);
    if (!sessions_) sessions_.emplace(request_);
    if (!rig_) rig_.emplace(request_);
    return {{"operating", QVariant::fromValue(&shown)},
            {"studies", QVariant::fromValue(&*studies_)},
            {"sessions", QVariant::fromValue(&*sessions_)},
            {"rig", QVariant::fromValue(&*rig_)},
            {"design", QVariant::fromValue(&design())}};
  }

  OperatorController& operating() {
    if (!operating_) {
      turnpoint::ui::interrupted_exhibit(".");
      operating_.emplace(request_);
      operating_->select(9);
      wait_for([&] { return !operating_->checking(); });
    }
    return *operating_;
  }

  /// The start page after it has refused a session that begins too early.
  OperatorController& early() {
    if (early_) return *early_;
    auto request = request_;
    request.database = turnpoint::ui::today_exhibit(".");
    early_.emplace(request);
    for (int i = 0; i < early_->protocols().size(); ++i)
      if (early_->protocols()[i].toMap()["id"] == "friction-training") early_->select(i);
    wait_for([&] { return !early_->checking(); });
    early_->enterParticipant("P01");
    early_->begin();
    wait_for([&] { return !early_->preparing() && !early_->checking(); });
    return *early_;
  }

  void choose_study() {
    if (studies_chosen_) return;
    station_pages(operating());
    studies_->open();
    studies_->select(3);
    wait_for([&] { return !studies_->checking(); });
    studies_chosen_ = true;
  }

  void examine_rig() {
    if (rig_examined_) return;
    station_pages(operating());
    rig_->selfTest();
    wait_for([&] { return rig_->busy().isEmpty(); });
    rig_->examine();
    wait_for([&] { return rig_->busy().isEmpty(); });
    rig_examined_ = true;
  }

  turnpoint::session::StationRequest with_cells() const {
    auto request = request_;
    request.rig = "plate-with-cells.toml";
    return request;
  }

  /// A rig on whose force cells weights are being put.
  RigController& weighing() {
    if (!weighing_) {
      weighing_.emplace(with_cells());
      weighing_->weigh();
      wait_for([&] { return weighing_->asked() == "weight"; });
    }
    return *weighing_;
  }

  /// A rig whose force cells have been calibrated.
  RigController& weighed() {
    if (weighed_) return *weighed_;
    weighed_.emplace(with_cells());
    weighed_->weigh();
    while (!weighed_->busy().isEmpty()) {
      wait_for([&] { return weighed_->busy().isEmpty() || weighed_->asked() == "weight"; });
      weighed_->answer("read");
    }
    weighed_->selfTest();
    wait_for([&] { return weighed_->busy().isEmpty(); });
    return *weighed_;
  }

  /// The same rig in a series of guided measurements.
  RigController& guided(const QString& series) {
    auto* guide = weighed().guide();
    guide->begin(series);
    if (series != "response") return *weighed_;
    guide->play();
    wait_for([&] {  // the first reading is from the ramp of the tone
      const auto readings = guide->readings();
      return !readings.isEmpty() && readings[0].toMap()["percent"].toDouble() > 1;
    });
    return *weighed_;
  }

  DesignController& design() {
    if (!design_)
      design_.emplace(
          turnpoint::ui::DesignPlace{studies_folder_.path().toStdString(), request_.rig, request_.protocols});
    return *design_;
  }

  bool design_ready() {
    return design().verdict() != "checking" &&
           (design().stage() != "form" || design().verdict() == "bad" || !design().profiles().isEmpty()) &&
           !design().precision()->busy();
  }

  QTemporaryDir folder_, studies_folder_;
  turnpoint::session::StationRequest request_{(kSource + "/protocols").toStdString(), "plate.toml",
                                              "lab.sqlite"};
  std::optional<OperatorController> operating_, early_;
  std::optional<turnpoint::ui::StudiesController> studies_;
  std::optional<turnpoint::ui::SessionsController> sessions_;
  std::optional<RigController> rig_, weighing_, weighed_;
  std::optional<DesignController> design_;
  turnpoint::ui::LatencyController latency_{turnpoint::rig::LatencyReference::photodiode};
  bool studies_chosen_ = false, rig_examined_ = false;
};

const std::vector<const char*> kModes{"live", "pilot", "simulated"};

/// The names of the pictures that shoot_participant() takes.
QStringList participant_names() {
  QStringList names{"gate-locked", "gate", "language", "consent", "code"};
  for (const char* mode : kModes)
    for (const auto& exhibit : turnpoint::ui::gallery_in_mode("en", mode))
      names << QString::fromStdString(exhibit.name);
  return names;
}

int shoot_participant(Camera& camera, const QString& language) {
  camera.shoot_gate();
  camera.start().ask({kLanguages, "", "", "2026-03", "pilot"});
  camera.shoot("language");
  camera.start().chooseLanguage(static_cast<int>(kLanguages.indexOf(language)));
  camera.shoot("consent");
  camera.start().consent();
  camera.shoot("code");
  camera.start().enterCode("P07");
  for (const char* mode : kModes)
    for (const auto& exhibit : turnpoint::ui::gallery_in_mode(language.toStdString(), mode))
      camera.shoot(exhibit.page, QString::fromStdString(exhibit.name));
  return camera.count();
}

/// Whether all words of the option are among those allowed; says which is not.
bool are_allowed(const char* option, const QStringList& words, const QStringList& allowed) {
  for (const auto& word : words)
    if (!allowed.contains(word)) {
      std::fprintf(stderr, "screenshots: --%s: %s; allowed: %s\n", option, qPrintable(word),
                   qPrintable(allowed.join(", ")));
      return false;
    }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (!qEnvironmentVariableIsSet("QT_QPA_PLATFORM")) qputenv("QT_QPA_PLATFORM", "offscreen");
  if (!qEnvironmentVariableIsSet("QT_QUICK_BACKEND")) qputenv("QT_QUICK_BACKEND", "software");
  QGuiApplication app(argc, argv);
  QCommandLineParser parser;
  parser.addHelpOption();
  parser.addOptions(
      {{"out", "Folder for the pictures", "dir", "screenshots"},
       {"languages", "Languages; dark and large (text) are looks of the operator's pages in English", "list",
        "en,ja,dark,large"},
       {"sizes", "Panel sizes in pixels, WIDTHxHEIGHT or WIDTHxHEIGHT@INCHES", "list",
        "800x480,1280x800,1920x1080,800x1280"},
       {"only", "Names of pictures; operator: all pictures of the operator's pages", "list", ""}});
  parser.process(app);
  turnpoint::ui::set_fonts();
  const QString out = QDir(parser.value("out")).absolutePath();
  if (!QDir().mkpath(out)) qFatal("cannot make %s", qPrintable(out));
  const auto sizes = parser.value("sizes").split(','), languages = parser.value("languages").split(',');
  auto looks = kLanguages;
  for (const auto& [name, look] : kLooks) looks << name;
  if (!are_allowed("languages", languages, looks)) return 2;

  OperatorStudio studio;
  auto pictures = studio.pictures();
  const auto participant = participant_names();
  auto only = parser.value("only").split(',', Qt::SkipEmptyParts);
  auto allowed = QStringList("operator") + participant;
  for (const auto& picture : pictures) allowed << picture.name;
  if (!are_allowed("only", only, allowed)) return 2;
  if (!only.isEmpty() && !only.contains("operator"))
    std::erase_if(pictures, [&](const auto& picture) { return !only.contains(picture.name); });
  const bool any_participant = only.isEmpty() || std::ranges::any_of(only, [&](const auto& name) {
                                 return participant.contains(name);
                               });

  int count = 0;
  for (const auto& size : sizes)
    for (const auto& language : languages) {
      if (any_participant && kLanguages.contains(language)) {
        Camera camera(out, panel_of(size), size + "-" + language + "-", only);
        count += shoot_participant(camera, language);
      }
      OperatorCamera camera(out, panel_of(size), size + "-operator-" + language + "-", look_of(language));
      for (const auto& picture : pictures) picture.shoot(camera);
      count += camera.count();
    }
  std::printf("%d pictures in %s\n", count, qPrintable(out));
  return 0;
}
