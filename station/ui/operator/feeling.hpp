#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QTimer>
#include <optional>
#include <string>

#include "station/protocol/protocol.hpp"
#include "station/ui/platform/newest_job.hpp"
#include "station/ui/shared/phrases.hpp"

namespace turnpoint::ui {

/// Plays a scene of a draft on the rig, so that its designer can feel it. On a real rig this arms the
/// amplifier; the page therefore makes the operator hold the button. After each scene the surface rests as
/// the rig's limits demand. GUI thread only.
class Feeling : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  /// whether the rig has a surface that can be felt
  Q_PROPERTY(bool real READ real NOTIFY changed)
  Q_PROPERTY(bool possible READ possible NOTIFY changed)   ///< whether a scene can be played now
  Q_PROPERTY(QString playing READ playing NOTIFY changed)  ///< the scene that is played; "" if there is none
  Q_PROPERTY(QString last READ last NOTIFY changed)        ///< the scene that was played last
  /// length of the last scene in s, its number of tones, and its peak in percent of full scale
  Q_PROPERTY(double seconds READ seconds NOTIFY changed)
  Q_PROPERTY(int tones READ tones NOTIFY changed)
  Q_PROPERTY(int peakPercent READ peak_percent NOTIFY changed)
  Q_PROPERTY(QVariant problem READ problem NOTIFY changed)  ///< why the last scene was not played; may be ""

 public:
  explicit Feeling(QObject* parent = nullptr);

  void follow(const protocol::Protocol& protocol, const std::string& rig, bool real);
  void forget();

  bool real() const { return real_; }
  bool possible() const { return protocol_ && playing_.isEmpty() && !rest_.isActive(); }
  QString playing() const { return playing_; }
  QString last() const { return last_; }
  double seconds() const { return seconds_; }
  int tones() const { return tones_; }
  int peak_percent() const { return peak_percent_; }
  QVariant problem() const { return to_variant(problem_); }

  /// Plays a scene with the first levels of its factors, or the middle of their ranges.
  Q_INVOKABLE void play(const QString& scene);
  /// Ends the scene at once; its tones are ramped down.
  Q_INVOKABLE void stop();

 Q_SIGNALS:
  void changed();

 private:
  std::optional<protocol::Protocol> protocol_;
  std::string rig_;
  bool real_ = false;
  QString playing_, last_;
  core::Phrase problem_;
  double seconds_ = 0;
  int tones_ = 0, peak_percent_ = 0;
  QTimer rest_;
  // The last member, so that its thread ends before the objects that it uses are destroyed.
  NewestJob job_;
};

}  // namespace turnpoint::ui
