#pragma once
#include <QQuickWindow>
#include <QSize>
#include <QString>
#include <QTest>
#include <QVariantMap>
#include <functional>

#include "station/ui/operator/live_model.hpp"
#include "station/ui/operator/report_model.hpp"
#include "station/ui/participant/session_bridge.hpp"
#include "station/view/live_view.hpp"
#include "station/view/report_pages.hpp"

namespace turnpoint::ui {

/// A panel for which pages are rendered: its size in pixels, and the pixel density of a common panel of this
/// size.
struct Panel {
  QSize size;
  double pixels_per_mm;
};

/// Reads a panel's size, such as 800x480. Ends the program if it is none.
Panel panel_of(const QString& text);

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
  OperatorCamera(QString out, const Panel& panel, QString prefix, Look look = {});

  /// Waits until `ready` returns true, and lets `operate` tap what is on the page, before it takes the
  /// picture.
  void shoot(
      const QString& page, const QString& name, QVariantMap properties,
      const std::function<bool()>& ready = [] { return true; },
      const std::function<void(QQuickWindow&)>& operate = [](QQuickWindow&) {});
  /// With gauges of the finger, if there are any.
  void shoot_live(const view::LiveState& state, const QString& name,
                  const std::optional<view::FingerGauges>& gauges = std::nullopt);
  /// `figure` is the name of the figure to show; the first one if there is none of that name.
  void shoot_report(const view::ReportPages& pages, const QString& name, const std::string& figure = "");

  std::string language() const { return look_.language.toStdString(); }
  int count() const { return count_; }

 private:
  QString out_;
  Look look_;
  Panel panel_;
  QString prefix_;
  SessionBridge bridge_;
  LiveModel live_;
  ReportModel report_;
  int count_ = 0;
};

}  // namespace turnpoint::ui
