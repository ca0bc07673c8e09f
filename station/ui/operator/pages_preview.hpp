#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <vector>

#include "station/ui/participant/session_bridge.hpp"
#include "station/ui/shared/phrases.hpp"
#include "station/view/sample_pages.hpp"

namespace turnpoint::ui {

/// The participant's pages of a study that is being designed, one at a time, in one of its languages. What is
/// tapped on them has no effect. GUI thread only.
class PagesPreview : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  /// shows the chosen page to a ParticipantView
  Q_PROPERTY(turnpoint::ui::SessionBridge* bridge READ bridge CONSTANT)
  /// keys of the texts that name the pages, in their order; empty until a study could be read
  Q_PROPERTY(QStringList names READ names NOTIFY changed)
  Q_PROPERTY(int shown READ shown NOTIFY changed)
  Q_PROPERTY(QStringList languages READ languages NOTIFY changed)
  Q_PROPERTY(QString language READ language NOTIFY changed)
  /// why there are no pages of the present text; "" if there are
  Q_PROPERTY(QVariant problem READ problem NOTIFY changed)

 public:
  explicit PagesPreview(QObject* parent = nullptr);

  /// Shows the pages of this study on this rig from now on. The page and the language stay if there still are
  /// such ones.
  void follow(const protocol::Protocol& protocol, const rig::Rig& rig);
  void forget();

  SessionBridge* bridge() { return &bridge_; }
  QStringList names() const;
  int shown() const { return shown_; }
  QStringList languages() const { return languages_; }
  QString language() const { return language_; }
  QVariant problem() const { return to_variant(problem_); }

  Q_INVOKABLE void show(int page);
  Q_INVOKABLE void choose(const QString& language);

 Q_SIGNALS:
  void changed();

 private:
  void make();

  SessionBridge bridge_;
  protocol::Protocol protocol_;
  rig::Rig rig_;
  std::vector<view::SamplePage> pages_;
  QStringList languages_;
  QString language_;
  core::Phrase problem_;
  int shown_ = 0;
};

}  // namespace turnpoint::ui
