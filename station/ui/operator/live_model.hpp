#pragma once
#include <QObject>
#include <QQmlEngine>
#include <optional>

#include "station/ui/operator/figure_view.hpp"
#include "station/ui/participant/session_bridge.hpp"
#include "station/view/live_view.hpp"

namespace turnpoint::ui {

/// The operator's view of a running session, and the operator's actions. Updates wait while a stimulus runs
/// or answers are open, because drawing them could delay the participant's screen. An adjustment lasts many
/// seconds, so there the texts follow the slider at once; the figures wait.
class LiveModel : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(QString heading READ heading NOTIFY wordsChanged)
  Q_PROPERTY(QVariantList scene READ scene NOTIFY wordsChanged)
  Q_PROPERTY(QVariantList course READ course NOTIFY wordsChanged)
  Q_PROPERTY(QVariantList limits READ limits NOTIFY wordsChanged)
  Q_PROPERTY(QVariantList sensors READ sensors NOTIFY wordsChanged)
  Q_PROPERTY(QVariantList surfaces READ surfaces NOTIFY picturesChanged)
  Q_PROPERTY(QVariant profile READ profile NOTIFY picturesChanged)
  Q_PROPERTY(QVariant trace READ trace NOTIFY picturesChanged)
  Q_PROPERTY(QVariant times READ times NOTIFY picturesChanged)
  Q_PROPERTY(QVariant strip READ strip NOTIFY picturesChanged)
  Q_PROPERTY(bool hasStrip READ has_strip NOTIFY picturesChanged)
  // What the force cells say of the finger. Each gauge is a list of its value and the two ends of the wanted
  // range, from 0 to 1. A value below 0 means that there is none.
  Q_PROPERTY(bool gauged READ gauged NOTIFY gaugesMoved)
  Q_PROPERTY(QList<double> forceGauge READ force_gauge NOTIFY gaugesMoved)
  Q_PROPERTY(QList<double> speedGauge READ speed_gauge NOTIFY gaugesMoved)
  Q_PROPERTY(QList<double> positionGauge READ position_gauge NOTIFY gaugesMoved)
  Q_PROPERTY(QStringList gaugeFigures READ gauge_figures NOTIFY gaugesMoved)
  Q_PROPERTY(bool held READ held NOTIFY heldChanged)

 public:
  explicit LiveModel(SessionBridge& bridge, QObject* parent = nullptr);

  /// Takes the newest state of the session. May be called on any thread; returns at once.
  void take(view::LiveState state);

  /// Takes the newest gauges; none if nothing is known of the finger, as before a session. May be called on
  /// any thread; returns at once. Gauges are small, so they are shown at once, also while a stimulus runs.
  void take(std::optional<view::FingerGauges> gauges);

  QString heading() const { return QString::fromStdString(state_.heading); }
  QVariantList scene() const;
  QVariantList course() const;
  QVariantList limits() const;
  QVariantList sensors() const;
  QVariantList surfaces() const;
  QVariant profile() const { return to_variant(state_.profile); }
  QVariant trace() const { return to_variant(state_.trace); }
  QVariant times() const { return to_variant(state_.times); }
  QVariant strip() const { return to_variant(state_.strip); }
  bool has_strip() const { return static_cast<bool>(state_.strip); }
  bool gauged() const { return gauges_.has_value(); }
  QList<double> force_gauge() const;
  QList<double> speed_gauge() const;
  QList<double> position_gauge() const;
  /// the values in figures, in this order
  QStringList gauge_figures() const;
  /// True while a stimulus runs or answers are open; the figures do not change during that time.
  bool held() const { return held_; }

  Q_INVOKABLE void pause() { bridge_.pause(); }
  Q_INVOKABLE void proceed() { bridge_.next(); }
  Q_INVOKABLE void stop() { bridge_.stop(); }
  Q_INVOKABLE void repeat() { bridge_.repeat(); }
  Q_INVOKABLE void arm() { bridge_.arm(); }
  Q_INVOKABLE void annotate(const QString& text) { bridge_.annotate(text); }

 Q_SIGNALS:
  void wordsChanged();
  void picturesChanged();
  void heldChanged();
  void gaugesMoved();

 private:
  void hold_or_show();

  SessionBridge& bridge_;
  view::LiveState state_;
  std::optional<view::LiveState> waiting_;
  std::optional<view::FingerGauges> gauges_;
  bool held_ = false;
};

}  // namespace turnpoint::ui
