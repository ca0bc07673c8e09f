#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QVariantList>
#include <optional>

#include "station/protocol/protocol.hpp"
#include "station/rehearsal/power.hpp"
#include "station/ui/platform/newest_job.hpp"
#include "station/ui/shared/phrases.hpp"

namespace turnpoint::ui {

/// The precision that a study can be expected to have, from simulated sessions of its draft. They run on
/// other threads while somebody looks at them (`watched`). A new draft stops them, and they begin again. GUI
/// thread only.
class Precision : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(bool watched READ watched WRITE set_watched NOTIFY changed)
  Q_PROPERTY(bool busy READ busy NOTIFY changed)
  Q_PROPERTY(double progress READ progress NOTIFY progressed)  ///< from 0 to 1
  /// number of sessions from which the numbers come; 0 if there are none yet
  Q_PROPERTY(int sessions READ sessions NOTIFY changed)
  /// {name, truth, estimate, spread, width, coverage, tailed}, as texts; "" for what a number does not have
  Q_PROPERTY(QVariantList numbers READ numbers NOTIFY changed)
  Q_PROPERTY(QVariant figure READ figure NOTIFY changed)
  Q_PROPERTY(QVariant problem READ problem NOTIFY changed)  ///< why nothing can be expected; may be ""

 public:
  explicit Precision(QObject* parent = nullptr);

  void follow(const protocol::Protocol& protocol);
  void forget();

  bool watched() const { return watched_; }
  void set_watched(bool watched);
  bool busy() const { return busy_; }
  double progress() const { return progress_; }
  int sessions() const { return power_ ? power_->observers : 0; }
  QVariantList numbers() const;
  QVariant figure() const { return figure_; }
  QVariant problem() const { return to_variant(problem_); }

 Q_SIGNALS:
  void changed();
  void progressed();

 private:
  void start();
  void take(const rehearsal::Power& power, int draft);

  std::optional<protocol::Protocol> protocol_;
  bool watched_ = false, busy_ = false, stale_ = false;
  double progress_ = 0;
  std::optional<rehearsal::Power> power_;
  QVariant figure_;
  core::Phrase problem_;
  int draft_ = 0;  ///< number of the draft, so that numbers of an earlier one are not shown
  // The last member, so that its thread ends before the objects that it uses are destroyed.
  NewestJob job_;
};

}  // namespace turnpoint::ui
