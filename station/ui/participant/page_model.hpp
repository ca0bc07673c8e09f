#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QString>
#include <QStringList>
#include <QVariantList>
#include <cstdint>
#include <functional>
#include <utility>

#include "station/session/page.hpp"
#include "station/ui/participant/surface_drawing.hpp"

namespace turnpoint::ui {

/// The page that the session wants to show, as properties for QML. All properties change together, with one
/// `changed`, so that a page is never drawn half old and half new. Lengths are in mm, times in seconds. GUI
/// thread only.
class PageModel : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("pages come from the session")
  Q_PROPERTY(Kind kind READ kind NOTIFY changed)
  Q_PROPERTY(QString title READ title NOTIFY changed)
  Q_PROPERTY(QString text READ text NOTIFY changed)
  Q_PROPERTY(QString cue READ cue NOTIFY changed)
  Q_PROPERTY(QStringList answers READ answers NOTIFY changed)
  Q_PROPERTY(QStringList captions READ captions NOTIFY changed)
  Q_PROPERTY(double valueLow READ value_low NOTIFY changed)
  Q_PROPERTY(double valueHigh READ value_high NOTIFY changed)
  Q_PROPERTY(int valueDecimals READ value_decimals NOTIFY changed)
  Q_PROPERTY(QList<double> anchorPlaces READ anchor_places NOTIFY changed)
  Q_PROPERTY(QStringList anchorTexts READ anchor_texts NOTIFY changed)
  Q_PROPERTY(QString first READ first NOTIFY changed)
  Q_PROPERTY(bool answersOpen READ answers_open NOTIFY changed)
  Q_PROPERTY(bool back READ back NOTIFY changed)
  Q_PROPERTY(bool playing READ playing NOTIFY changed)
  Q_PROPERTY(QString picture READ picture NOTIFY changed)
  Q_PROPERTY(bool again READ again NOTIFY changed)
  Q_PROPERTY(bool offersAgain READ offers_again NOTIFY changed)
  Q_PROPERTY(bool answerNow READ answer_now NOTIFY changed)
  Q_PROPERTY(bool flash READ flash NOTIFY changed)
  Q_PROPERTY(Verdict verdict READ verdict NOTIFY changed)
  Q_PROPERTY(QString instruction READ instruction NOTIFY changed)
  Q_PROPERTY(bool hasMark READ has_mark NOTIFY changed)
  Q_PROPERTY(double markMm READ mark_mm NOTIFY changed)
  Q_PROPERTY(turnpoint::ui::SurfaceOutline surface READ surface NOTIFY changed)
  Q_PROPERTY(int interval READ interval NOTIFY changed)
  Q_PROPERTY(int intervals READ intervals NOTIFY changed)
  Q_PROPERTY(QStringList intervalNames READ interval_names NOTIFY changed)
  Q_PROPERTY(int trialsDone READ trials_done NOTIFY changed)
  Q_PROPERTY(int trialsTotal READ trials_total NOTIFY changed)
  /// about how many minutes the rest of the session takes, at the pace so far; -1 if that is not known yet
  Q_PROPERTY(int minutesLeft READ minutes_left NOTIFY changed)
  Q_PROPERTY(double remainingSeconds READ remaining_s NOTIFY changed)
  Q_PROPERTY(double slider READ slider NOTIFY changed)
  Q_PROPERTY(double sliderMin READ slider_min NOTIFY changed)
  Q_PROPERTY(double sliderMax READ slider_max NOTIFY changed)
  Q_PROPERTY(double sliderStep READ slider_step NOTIFY changed)
  Q_PROPERTY(bool sliderMoved READ slider_moved NOTIFY changed)
  Q_PROPERTY(QString language READ language NOTIFY changed)
  Q_PROPERTY(QString runMode READ run_mode NOTIFY changed)
  Q_PROPERTY(QString safe READ safe NOTIFY changed)
  Q_PROPERTY(QString toDo READ to_do NOTIFY changed)
  Q_PROPERTY(QString detail READ detail NOTIFY changed)
  /// set on a failed page if the session would have begun too early (see to_map() in early_session.hpp)
  Q_PROPERTY(QVariantMap early READ early NOTIFY changed)
  Q_PROPERTY(bool awaitsArming READ awaits_arming NOTIFY changed)
  Q_PROPERTY(bool awaitsNote READ awaits_note NOTIFY changed)
  Q_PROPERTY(bool resumable READ resumable NOTIFY changed)
  Q_PROPERTY(bool unsaved READ unsaved NOTIFY changed)
  Q_PROPERTY(QVariantList summaryLabels READ summary_labels NOTIFY changed)
  Q_PROPERTY(QStringList summaryValues READ summary_values NOTIFY changed)
  // The bars that guide the finger. Each bar is a list of the finger's value and the two ends of the wanted
  // range, from 0 to 1. A value below 0 means that there is none.
  Q_PROPERTY(bool guided READ is_guided NOTIFY barsMoved)
  Q_PROPERTY(bool barsFrozen READ bars_frozen NOTIFY barsMoved)
  Q_PROPERTY(QList<double> forceBar READ force_bar NOTIFY barsMoved)
  Q_PROPERTY(QList<double> speedBar READ speed_bar NOTIFY barsMoved)
  Q_PROPERTY(double paceMmPerS READ pace_mm_s NOTIFY barsMoved)

 public:
  /// The values of session::PageKind under names that QML can use.
  enum class Kind {
    Instructions,
    Cue,
    Stimulus,
    Pause,
    Response,
    Confidence,
    Question,
    Explanation,
    Line,
    Number,
    Feedback,
    Interval,
    Rest,
    Adjust,
    Fault,
    Paused,
    End,
    Failed
  };
  Q_ENUM(Kind)
  /// What a feedback page says. With Message it shows only the page's own text (after a late answer).
  enum class Verdict { Message, Right, Wrong };
  Q_ENUM(Verdict)

  /// The clock (ns) tells the pace of the session.
  explicit PageModel(std::function<std::int64_t()> clock, QObject* parent = nullptr)
      : QObject(parent), clock_(std::move(clock)) {}
  void set(session::Page page);
  void guide(const session::Guidance& guidance);
  const session::Page& page() const { return page_; }

  bool is_guided() const { return page_.guidance.has_value(); }
  bool bars_frozen() const { return page_.guidance && page_.guidance->frozen; }
  /// The value of the force, and the lower and upper end of the range that the protocol asks for; empty if
  /// there is no such bar.
  QList<double> force_bar() const;
  QList<double> speed_bar() const;
  /// The speed at which the finger is to slide; 0 if there is none.
  double pace_mm_s() const { return page_.guidance ? page_.guidance->pace_mm_s.value_or(0) : 0; }
  Kind kind() const;
  QString title() const { return QString::fromStdString(page_.title); }
  QString text() const { return QString::fromStdString(page_.text); }
  QString cue() const { return QString::fromStdString(page_.cue); }
  QStringList answers() const;
  QStringList captions() const;
  double value_low() const { return page_.value.low; }
  double value_high() const { return page_.value.high; }
  int value_decimals() const { return page_.value.decimals; }
  QList<double> anchor_places() const { return {page_.value.places.begin(), page_.value.places.end()}; }
  QStringList anchor_texts() const;
  QString first() const { return QString::fromStdString(page_.value.first); }
  bool answers_open() const { return page_.answers_open; }
  bool back() const { return page_.back; }
  bool playing() const { return page_.playing; }
  QString picture() const;
  bool again() const { return page_.again; }
  bool offers_again() const { return page_.offers_again; }
  bool answer_now() const { return page_.answer_now; }
  bool flash() const { return page_.flash_ns.has_value(); }
  Verdict verdict() const;
  QString instruction() const { return QString::fromStdString(page_.instruction); }
  bool has_mark() const { return page_.mark_mm.has_value(); }
  double mark_mm() const { return page_.mark_mm.value_or(0); }
  SurfaceOutline surface() const { return {page_.surface}; }
  int interval() const { return page_.interval.number; }
  int intervals() const { return page_.interval.of; }
  QStringList interval_names() const;
  int trials_done() const { return page_.trials_done; }
  int trials_total() const { return page_.trials_total; }
  int minutes_left() const;
  double remaining_s() const { return page_.remaining_s; }
  double slider() const { return page_.slider.setting; }
  double slider_min() const { return page_.slider.low; }
  double slider_max() const { return page_.slider.high; }
  double slider_step() const { return page_.slider.step; }
  bool slider_moved() const { return page_.slider.moved; }
  QString language() const { return QString::fromStdString(page_.language); }
  QString run_mode() const { return QString::fromStdString(page_.run_mode); }
  QString safe() const { return QString::fromStdString(page_.safe); }
  QString to_do() const { return QString::fromStdString(page_.to_do); }
  QVariantMap early() const;
  QString detail() const { return QString::fromStdString(page_.fault.detail); }
  /// True if the session can continue from this page only after an operator has armed the amplifier.
  bool awaits_arming() const { return page_.amplifier == "disarmed" || page_.amplifier == "faulted"; }
  /// True if the session can continue from this page only after an operator has written down why it may.
  bool awaits_note() const {
    return page_.kind == session::PageKind::fault && page_.fault.kind == session::FaultKind::self_test;
  }
  bool resumable() const { return page_.resumable; }
  /// True while the last answer is kept in memory only, because the disk is full.
  bool unsaved() const {
    return page_.kind == session::PageKind::fault && page_.fault.kind == session::FaultKind::disk_full;
  }
  QVariantList summary_labels() const;
  QStringList summary_values() const;

 Q_SIGNALS:
  void changed();
  void barsMoved();  ///< Emitted when bars have moved.

 private:
  double now_s() const { return 1e-9 * static_cast<double>(clock_()); }

  std::function<std::int64_t()> clock_;
  session::Page page_;
  /// when the first page of the session was shown (s), and how many trials were done then
  double began_s_ = 0;
  int began_with_ = 0;
};

}  // namespace turnpoint::ui
