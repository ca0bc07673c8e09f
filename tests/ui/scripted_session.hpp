#pragma once
#include <QObject>
#include <QStringList>
#include <cstdint>

#include "station/ui/participant/session_bridge.hpp"

namespace turnpoint::ui {

/// Shows pages of the gallery, for tests of single pages. It records what the user does on a page as text
/// ("answer 1", "next", "slider 31", "stop", "pause").
class ScriptedSession : public QObject {
  Q_OBJECT
  Q_PROPERTY(turnpoint::ui::SessionBridge* bridge READ bridge CONSTANT)
  Q_PROPERTY(QStringList inputs READ inputs NOTIFY inputsChanged)
  Q_PROPERTY(int touches READ touches NOTIFY inputsChanged)
  Q_PROPERTY(QStringList pages READ pages CONSTANT)

 public:
  explicit ScriptedSession(QObject* parent = nullptr);
  SessionBridge* bridge() { return &bridge_; }
  QStringList inputs() const { return inputs_; }
  int touches() const { return touches_; }
  /// The names of all pages in the gallery.
  static QStringList pages();

  /// Shows a page of the gallery. If its name ends with "-pilot" or "-simulated", the run is one.
  Q_INVOKABLE void show(const QString& name, const QString& language);
  /// Shows the page with this text in every place whose text comes from a file or a device.
  Q_INVOKABLE void showWith(const QString& name, const QString& text);
  Q_INVOKABLE void forget();
  /// Sets how many milliseconds earlier than Qt's time stamp the kernel's time stamp of each touch is.
  Q_INVOKABLE void setKernelLead(double ms);
  /// The kernel knows only a touch at this place of the panel (0 to 1, in the panel's own axes).
  Q_INVOKABLE void setKernelTouch(double x, double y);
  Q_INVOKABLE void forgetKernel();
  /// Where the last answer's time stamp comes from: "kernel" or "toolkit".
  Q_INVOKABLE QString quality() const { return quality_; }
  /// Milliseconds since the last answer's time stamp.
  Q_INVOKABLE double answerAgeMs() const;

 Q_SIGNALS:
  void inputsChanged();

 private:
  void take(const session::Input& input);
  SessionBridge bridge_;
  QStringList inputs_;
  int touches_ = 0;
  QString quality_;
  std::int64_t answer_ns_ = 0;
};

}  // namespace turnpoint::ui
