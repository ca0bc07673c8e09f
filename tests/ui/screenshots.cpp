// Renders every page in every size and language into PNG files, for people to look at:
//   screenshots --out DIR [--languages en,ja] [--sizes 800x480,1280x800] [--only NAME]
#include <QCommandLineParser>
#include <QDir>
#include <QGuiApplication>
#include <QQmlApplicationEngine>
#include <QQmlExtensionPlugin>
#include <QQuickWindow>
#include <cstdio>

#include "station/ui/screen.hpp"
#include "station/ui/session_bridge.hpp"
#include "station/ui/start_controller.hpp"
#include "tests/ui/gallery.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

namespace {

using turnpoint::ui::SessionBridge;
using turnpoint::ui::StartController;

const QStringList kLanguages{"en", "de", "ja"};

/// The panels looked at: pixels and the density of a common panel of that size.
struct Panel {
  QSize size;
  double pixels_per_mm;
};

Panel panel_of(const QString& text) {
  const auto parts = text.split('x');
  if (parts.size() != 2) qFatal("--sizes: %s; allowed: WIDTHxHEIGHT", qPrintable(text));
  const QSize size(parts[0].toInt(), parts[1].toInt());
  return {size, size.width() <= 800 ? 5.2 : size.width() <= 1280 ? 5.9 : 5.6};  // 7", 10.1", 15.6"
}

/// The station's window on one panel in one language.
class Camera {
 public:
  Camera(const QString& out, const Panel& panel, const QString& prefix, const QString& only)
      : out_(out),
        prefix_(prefix),
        only_(only),
        bridge_([] { return 0; }, [](const auto&) {}),
        start_(kLanguages, "", "", [](const QString&) { return true; }) {
    engine_.addImportPath("qrc:/qt/qml");
    engine_.setInitialProperties({{"bridge", QVariant::fromValue(&bridge_)},
                                  {"start", QVariant::fromValue(&start_)},
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
    shoot(name);
  }

  int count() const { return count_; }

 private:
  QString out_, prefix_, only_;
  SessionBridge bridge_;
  StartController start_;
  QQmlApplicationEngine engine_;
  QQuickWindow* window_ = nullptr;
  int count_ = 0;
};

int shoot_all(Camera& camera, const QString& language) {
  camera.shoot("language");
  camera.start().chooseLanguage(static_cast<int>(kLanguages.indexOf(language)));
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
  const QString out = parser.value("out");
  if (!QDir().mkpath(out)) qFatal("cannot make %s", qPrintable(out));
  int count = 0;
  for (const auto& size : parser.value("sizes").split(',')) {
    for (const auto& language : parser.value("languages").split(',')) {
      if (!kLanguages.contains(language))
        qFatal("--languages: %s; allowed: en, de, ja", qPrintable(language));
      Camera camera(out, panel_of(size), size + "-" + language + "-", parser.value("only"));
      count += shoot_all(camera, language);
    }
  }
  std::printf("%d pictures in %s\n", count, qPrintable(QDir(out).absolutePath()));
  return 0;
}
