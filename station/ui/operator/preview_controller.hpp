#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <QVariantList>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "station/ui/operator/figure_view.hpp"
#include "station/view/preview.hpp"

namespace turnpoint::ui {

/// Shows a scene of a protocol, with a slider for each of its factors. Scenes are planned on a separate
/// thread, which always takes the newest request. Everything else is for the GUI thread only.
class PreviewController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(QString title READ title CONSTANT)
  Q_PROPERTY(QString rig READ rig CONSTANT)
  Q_PROPERTY(QStringList scenes READ scenes CONSTANT)
  Q_PROPERTY(int scene READ scene NOTIFY sceneChanged)
  /// sliders as {name, low, high, levels, value}
  Q_PROPERTY(QVariantList knobs READ knobs NOTIFY sceneChanged)
  /// language of the figures, such as "de"
  Q_PROPERTY(QString language READ language WRITE set_language NOTIFY changed)
  Q_PROPERTY(bool busy READ busy NOTIFY changed)
  Q_PROPERTY(QString problem READ problem NOTIFY changed)
  Q_PROPERTY(QVariantList facts READ facts NOTIFY changed)
  Q_PROPERTY(QVariantList cues READ cues NOTIFY changed)
  Q_PROPERTY(QVariant surface READ surface NOTIFY changed)
  Q_PROPERTY(QVariant profile READ profile NOTIFY changed)
  Q_PROPERTY(QVariant spectrum READ spectrum NOTIFY changed)

 public:
  /// Throws core::BadInput if a file is wrong, and core::UsageError if the protocol lacks the scene or
  /// factor.
  explicit PreviewController(const view::PreviewRequest& request, QObject* parent = nullptr);
  ~PreviewController() override;

  QString title() const;
  QString rig() const;
  QStringList scenes() const;
  int scene() const { return scene_; }
  QVariantList knobs() const;
  QString language() const { return language_; }
  void set_language(const QString& language);  // the setter of a QML property must have this name (NOLINT)
  bool busy() const { return busy_; }
  QString problem() const { return QString::fromStdString(look_.problem); }
  QVariantList facts() const;
  QVariantList cues() const;
  QVariant surface() const { return surface_; }
  QVariant profile() const { return profile_; }
  QVariant spectrum() const { return spectrum_; }

  Q_INVOKABLE void choose(int scene);
  Q_INVOKABLE void set(const QString& factor, double value);

 Q_SIGNALS:
  void sceneChanged();
  void changed();

 private:
  /// A scene with its figures, as made on the worker thread.
  struct Drawn {
    view::SceneLook look;
    QVariant surface, profile, spectrum;
  };
  struct Wanted {
    std::string scene;
    protocol::Factors factors;
    std::string language;
  };
  void plan();
  void work(const std::stop_token& stop);
  Drawn draw(const Wanted& wanted);
  void take(Drawn drawn);

  view::Preview preview_;
  std::vector<std::string> scenes_;
  protocol::Factors factors_;
  int scene_ = 0;
  QString language_ = "en";
  bool busy_ = false;
  view::SceneLook look_;
  QVariant surface_, profile_, spectrum_;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  std::optional<Wanted> wanted_;
  // The last member, so that the thread is joined before anything that it uses is destroyed.
  std::jthread worker_;
};

}  // namespace turnpoint::ui
