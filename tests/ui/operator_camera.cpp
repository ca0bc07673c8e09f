#include "tests/ui/operator_camera.hpp"

#include <QGuiApplication>
#include <QQmlComponent>
#include <QQmlEngine>
#include <QQuickItem>
#include <algorithm>
#include <cmath>
#include <utility>

#include "station/ui/shared/operator_screen.hpp"

namespace turnpoint::ui {

Panel panel_of(const QString& text) {
  const auto known = text.split('@');
  const auto parts = known[0].split('x');
  if (parts.size() != 2 || known.size() > 2)
    qFatal("--sizes: %s; allowed: WIDTHxHEIGHT or WIDTHxHEIGHT@INCHES", qPrintable(text));
  const QSize size(parts[0].toInt(), parts[1].toInt());
  if (known.size() == 2)
    return {size, std::hypot(size.width(), size.height()) / (25.4 * known[1].toDouble())};
  const int longer = std::max(size.width(), size.height());
  return {size, longer <= 800    ? 5.2
                : longer <= 1280 ? 5.9
                                 : 5.6};  // px per mm for diagonals of 7", 10.1" and 15.6"
}

OperatorCamera::OperatorCamera(QString out, const Panel& panel, QString prefix, Look look)
    : out_(std::move(out)),
      look_(std::move(look)),
      panel_(panel),
      prefix_(std::move(prefix)),
      bridge_([] { return 0; }, [](const auto&) {}),
      live_(bridge_) {}

void OperatorCamera::shoot(const QString& page, const QString& name, QVariantMap properties,
                           const std::function<bool()>& ready,
                           const std::function<void(QQuickWindow&)>& operate) {
  properties["pixelsPerMm"] = panel_.pixels_per_mm;
  QQmlEngine engine;
  engine.addImportPath("qrc:/qt/qml");
  // The first page of the program makes the module and its singletons known.
  QQmlComponent component(&engine, QUrl("qrc:/qt/qml/Turnpoint/" + page));
  auto* screen = engine.singletonInstance<OperatorScreen*>(qmlTypeId("Turnpoint", 1, 0, "OperatorScreen"));
  screen->set_language(look_.language);
  screen->set_dark(look_.dark);
  screen->set_text_percent(look_.text_percent);
  QQuickWindow window;
  auto* item = qobject_cast<QQuickItem*>(component.createWithInitialProperties(properties));
  if (item == nullptr) qFatal("%s: %s", qPrintable(page), qPrintable(component.errorString()));
  item->setParentItem(window.contentItem());
  item->setSize(panel_.size);
  window.resize(panel_.size);
  window.show();
  wait_for(ready);
  QGuiApplication::processEvents();
  operate(window);
  QGuiApplication::processEvents();
  const QString file = out_ + "/" + prefix_ + name + ".png";
  if (!window.grabWindow().save(file)) qFatal("cannot write %s", qPrintable(file));
  ++count_;
  delete item;
}

void OperatorCamera::shoot_live(const view::LiveState& state, const QString& name,
                                const std::optional<view::FingerGauges>& gauges) {
  session::Page page;
  page.kind = session::PageKind::interval;
  page.run_mode = "pilot";
  bridge_.show(page);
  live_.take(state);
  live_.take(gauges);
  QGuiApplication::processEvents();
  shoot("LiveView.qml", name,
        {{"live", QVariant::fromValue(&live_)}, {"bridge", QVariant::fromValue(&bridge_)}});
}

void OperatorCamera::shoot_report(const view::ReportPages& pages, const QString& name,
                                  const std::string& figure) {
  const auto found = std::ranges::find(pages.figures, figure, &report::NamedFigure::name);
  const auto picture = found == pages.figures.end() ? 0 : static_cast<int>(found - pages.figures.begin());
  report_.take(pages);
  QGuiApplication::processEvents();
  shoot("ReportPage.qml", name,
        {{"report", QVariant::fromValue(&report_)}, {"runMode", "pilot"}, {"shown", picture}});
}

}  // namespace turnpoint::ui
