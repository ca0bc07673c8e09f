#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <QTimer>
#include <QVariantList>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "station/session/prepare.hpp"
#include "station/session/session.hpp"
#include "station/store/station.hpp"
#include "station/ui/operator/check_protocol.hpp"
#include "station/ui/platform/newest_job.hpp"
#include "station/view/choices.hpp"
#include "station/view/station_state.hpp"

namespace turnpoint::ui {

/// A session that an operator has chosen and that has passed every check.
struct ChosenSession {
  session::Setup setup;
  /// true if the language or the code is to be asked for on the participant's screen
  bool ask_language = false, ask_code = false;
  bool arm = false;  ///< arm the amplifier as soon as the session has opened it
};

/// The operator's start page: protocols with their check, participant, language, run mode, arming, and the
/// interrupted session. Files are read and checked on a separate thread, so that the page never waits.
/// Choosing another protocol abandons the running check. Everything else is for the GUI thread only.
class OperatorController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(QVariantList protocols READ protocols NOTIFY changed)  ///< protocols as {id, title, usable}
  Q_PROPERTY(int selected READ selected NOTIFY changed)
  Q_PROPERTY(bool checking READ checking NOTIFY changed)
  Q_PROPERTY(QVariantList facts READ facts NOTIFY changed)
  /// cues that could give the right answer away, as {name, says (the finding in words), leaks (whether it
  /// does)}
  Q_PROPERTY(QVariantList cues READ cues NOTIFY changed)
  Q_PROPERTY(QVariantList problems READ problems NOTIFY changed)
  /// why the chosen protocol cannot run live
  Q_PROPERTY(QVariantList notLive READ not_live NOTIFY changed)
  /// set if the chosen session would begin too early, which a reason of the operator can overrule (see
  /// to_map() in early_session.hpp)
  Q_PROPERTY(QVariantMap tooEarly READ too_early NOTIFY changed)
  Q_PROPERTY(QVariantList warnings READ warnings NOTIFY changed)
  Q_PROPERTY(QStringList languages READ languages NOTIFY changed)
  /// index of the chosen language; -1 if the participant chooses it on the screen
  Q_PROPERTY(int language READ language NOTIFY changed)
  Q_PROPERTY(QString participant READ participant NOTIFY changed)
  Q_PROPERTY(bool participantKnown READ participant_known NOTIFY changed)
  Q_PROPERTY(QStringList participants READ participants NOTIFY changed)
  Q_PROPERTY(bool live READ live NOTIFY changed)
  Q_PROPERTY(bool armed READ armed NOTIFY changed)
  /// the interrupted session, if there is one: {participant, protocol, trials, ageS (the time since then in
  /// seconds)}
  Q_PROPERTY(QVariantMap interrupted READ interrupted NOTIFY changed)
  /// age of the last backup as {state: none | recent | old | ahead (its time is in the future), hours}
  Q_PROPERTY(QVariantMap backup READ backup NOTIFY changed)
  /// what the operator has to know before a session, as {name (database, disk, clock), good, says}; empty
  /// until it was read
  Q_PROPERTY(QVariantList signs READ signs NOTIFY changed)
  Q_PROPERTY(QString station READ station NOTIFY changed)  ///< the name under which the station records
  /// whether the database was recorded on another machine, and somebody has to say what happened
  Q_PROPERTY(bool otherMachine READ other_machine NOTIFY changed)
  Q_PROPERTY(bool mayBegin READ may_begin NOTIFY changed)
  Q_PROPERTY(bool preparing READ preparing NOTIFY changed)
  Q_PROPERTY(QString rig READ rig CONSTANT)
  Q_PROPERTY(QString folder READ folder CONSTANT)  ///< folder of the protocols
  Q_PROPERTY(QString database READ database CONSTANT)

 public:
  /// When protocols are checked: from the beginning, or only after allow_checks(), so that the first check
  /// does not compete with the first page for the processor.
  enum class Checks { at_once, when_allowed };
  /// `checker` runs on the worker thread.
  explicit OperatorController(session::StationRequest request, Checker checker = check_protocol,
                              Checks checks = Checks::at_once, QObject* parent = nullptr);
  ~OperatorController() override;

  void allow_checks();

  const session::StationRequest& request() const { return request_; }
  QVariantList protocols() const;
  int selected() const { return selected_; }
  bool checking() const { return checking_; }
  QVariantList facts() const;
  QVariantList cues() const;
  QVariantList problems() const;
  QVariantList not_live() const;
  QVariantMap too_early() const;
  QVariantList warnings() const;
  QStringList languages() const;
  int language() const { return static_cast<int>(languages().indexOf(language_)); }
  QString participant() const { return participant_; }
  bool participant_known() const { return participants().contains(participant_); }
  QStringList participants() const { return participants_; }
  bool live() const { return live_; }
  bool armed() const { return armed_; }
  QVariantMap interrupted() const;
  QVariantMap backup() const;
  QVariantList signs() const;
  QString station() const { return QString::fromStdString(state_.station); }
  bool other_machine() const { return state_.other_machine; }
  bool may_begin() const;
  bool preparing() const { return preparing_; }
  QString rig() const { return QString::fromStdString(request_.rig); }
  QString folder() const { return QString::fromStdString(request_.protocols); }
  QString database() const { return QString::fromStdString(request_.database); }

  /// Reads protocols, participants and interrupted sessions again: at the start and after each session.
  Q_INVOKABLE void refresh();
  /// Tells the operator why the last session failed. The participant's page does not say it.
  void tell_failure(const core::Phrase& why);
  Q_INVOKABLE void select(int index);
  Q_INVOKABLE void chooseLanguage(int index);
  Q_INVOKABLE void enterParticipant(const QString& code);
  /// Choosing a live session checks at once whether it is possible.
  Q_INVOKABLE void setLive(bool live);
  Q_INVOKABLE void setArmed(bool armed);
  /// Prepares the chosen session. Then emits chosen(), or sets problems.
  Q_INVOKABLE void begin();
  /// Prepares the session although it begins too early. The reason is stored with it.
  Q_INVOKABLE void beginEarly(const QString& reason);
  /// Says that this machine replaces the one on which the database was recorded.
  Q_INVOKABLE void replaceMachine();
  /// Says that the database is a copy, and gives the station of this copy its own name.
  Q_INVOKABLE void nameCopy(const QString& name);
  /// Continues the newest interrupted session.
  Q_INVOKABLE void resume();
  Q_INVOKABLE void resumeSession(const QString& session_id);

 Q_SIGNALS:
  void changed();
  void chosen(const turnpoint::ui::ChosenSession& session);

 private:
  using Then = std::function<void()>;
  session::RunRequest request_for(const char* mode) const;
  void prepare(const std::string& early);
  void forget_refusal();
  void work(std::function<Then(const std::stop_token&)> job,
            void (OperatorController::*failed)(std::vector<core::Phrase>));
  void check_selected();
  void check_live();
  void refuse_live(std::vector<core::Phrase> reasons);
  void look_at_station();
  void name_station(const store::StationName& how);
  void stay();
  bool refuses() const;
  void fail(std::vector<core::Phrase> problems);
  void refuse(std::vector<core::Phrase> reasons);
  const view::ProtocolEntry* entry() const;

  session::StationRequest request_;
  Checker checker_;
  std::vector<view::ProtocolEntry> protocols_;
  QStringList participants_;
  std::optional<view::InterruptedNote> interrupted_;
  view::BackupNote backup_;
  view::StationState state_;
  QTimer minutes_;  ///< updates the ages shown on the page, which may be open for days
  view::CheckWords words_;
  std::vector<core::Phrase> refused_;  ///< why the last chosen session did not begin
  std::optional<session::EarlySession> too_early_;
  std::vector<core::Phrase> not_live_;  ///< why the chosen protocol cannot run live
  QString language_;  ///< "" if the participant chooses it
  int selected_ = -1;
  QString participant_;
  bool live_ = false, armed_ = false, checking_ = false, preparing_ = false;
  bool may_check_;
  // The last members, so that their threads end before the objects that they use are destroyed.
  NewestJob looker_;  ///< reads the state of the station
  NewestJob worker_;
};

}  // namespace turnpoint::ui
