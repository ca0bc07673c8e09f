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
#include "tests/ui/gallery.hpp"

Q_IMPORT_QML_PLUGIN(TurnpointPlugin)

namespace {

using turnpoint::ui::SessionBridge;

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

class Camera {
 public:
  explicit Camera(const QString& out) : out_(out), bridge_([] { return 0; }, [](const auto&) {}) {
    engine_.addImportPath("qrc:/qt/qml");
    engine_.setInitialProperties(
        {{"bridge", QVariant::fromValue(&bridge_)}, {"pixelsPerMm", 5.2}, {"language", "en"}});
    engine_.load(QUrl("qrc:/qt/qml/Turnpoint/Main.qml"));
    window_ = engine_.rootObjects().isEmpty() ? nullptr
                                              : qobject_cast<QQuickWindow*>(engine_.rootObjects().first());
    if (window_ == nullptr) qFatal("Main.qml does not load");
  }

  void set_panel(const Panel& panel) {
    window_->setProperty("pixelsPerMm", panel.pixels_per_mm);
    window_->resize(panel.size);
  }

  void set_language(const QString& language) { window_->setProperty("language", language); }
  QQuickWindow& window() { return *window_; }

  void shoot(const turnpoint::session::Page& page, const QString& name) {
    bridge_.show(page);
    save(name);
  }

  void save(const QString& name) {
    QGuiApplication::processEvents();
    const QString file = out_ + "/" + name + ".png";
    if (!window_->grabWindow().save(file)) qFatal("cannot write %s", qPrintable(file));
    ++count_;
  }

  int count() const { return count_; }

 private:
  QString out_;
  SessionBridge bridge_;
  QQmlApplicationEngine engine_;
  QQuickWindow* window_ = nullptr;
  int count_ = 0;
};

void shoot_all(Camera& camera, const QString& size, const QString& language, const QString& only) {
  const QString prefix = size + "-" + language + "-";
  camera.set_language(language);
  for (const auto& exhibit : turnpoint::ui::gallery(language.toStdString())) {
    const QString name = QString::fromStdString(exhibit.name);
    if (only.isEmpty() || only == name) camera.shoot(exhibit.page, prefix + name);
  }
  if (!only.isEmpty() && only != "code") return;
  camera.window().setProperty("askCode", true);
  camera.save(prefix + "code");
  camera.window().setProperty("askCode", false);
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
  Camera camera(out);
  for (const auto& size : parser.value("sizes").split(',')) {
    camera.set_panel(panel_of(size));
    for (const auto& language : parser.value("languages").split(','))
      shoot_all(camera, size, language, parser.value("only"));
  }
  std::printf("%d pictures in %s\n", camera.count(), qPrintable(QDir(out).absolutePath()));
  return 0;
}
