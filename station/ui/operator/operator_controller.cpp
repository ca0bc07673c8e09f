#include "station/ui/operator/operator_controller.hpp"

#include <QFileInfo>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <utility>

#include "station/session/prepare.hpp"
#include "station/session/resume.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/ui/shared/early_session.hpp"

namespace turnpoint::ui {

OperatorController::OperatorController(session::StationRequest request, Checker checker, Checks checks,
                                       QObject* parent)
    : QObject(parent),
      request_(std::move(request)),
      checker_(std::move(checker)),
      may_check_(checks == Checks::at_once),
      looker_(*this),
      worker_(*this) {
  std::filesystem::create_directories(std::filesystem::absolute(request_.database).parent_path());
  connect(&minutes_, &QTimer::timeout, this, &OperatorController::look_at_station);
  minutes_.start(std::chrono::minutes(1));
  refresh();
}

OperatorController::~OperatorController() = default;

void OperatorController::refresh() {
  armed_ = false;
  participant_.clear();
  too_early_.reset();
  protocols_ = view::list_studies(request_.protocols, request_.database);
  try {
    participants_ = to_list(view::known_participants(request_.database));
    interrupted_ = view::interrupted_note(request_.database);
    backup_ = view::backup_note(request_.database);
  } catch (const std::exception& error) {
    state_.refusal = core::phrase_of(error);  // until the state of the station has been read
  }
  look_at_station();
  Q_EMIT changed();
  if (selected_ < 0 && !protocols_.empty()) return select(0);
  if (checking_) check_selected();  // the check was stopped when the session began
}

void OperatorController::look_at_station() {
  looker_.start([this, database = request_.database](const std::stop_token&) -> Then {
    auto state = view::station_state(database);
    view::BackupNote backup;
    try {
      backup = view::backup_note(database);
    } catch (const std::exception& error) {
      state.refusal = core::phrase_of(error);
    }
    return [this, state = std::move(state), backup] {
      state_ = state;
      backup_ = backup;
      Q_EMIT changed();
    };
  });
}

QVariantList OperatorController::signs() const {
  QVariantList list;
  for (const auto& sign : state_.signs)
    list += QVariantMap{
        {"name", QString::fromStdString(sign.name)}, {"good", sign.good}, {"says", to_variant(sign.says)}};
  return list;
}

void OperatorController::tell_failure(const core::Phrase& why) {
  refused_ = {why};
  Q_EMIT changed();
}

/// Starts a job on the worker thread. The job returns a function, which then runs on the GUI thread unless a
/// newer job was started meanwhile. If the job throws, `failed` is called with the messages.
void OperatorController::work(std::function<Then(const std::stop_token&)> job,
                              void (OperatorController::*failed)(std::vector<core::Phrase>)) {
  worker_.start([this, failed, job = std::move(job)](const std::stop_token& stop) -> Then {
    try {
      return job(stop);
    } catch (const protocol::Abandoned&) {
      return {};
    } catch (const std::exception& error) {
      return [this, failed, reasons = phrases_of(error)] { (this->*failed)(reasons); };
    }
  });
}

void OperatorController::fail(std::vector<core::Phrase> problems) {
  words_.problems = std::move(problems);
  checking_ = preparing_ = false;
  Q_EMIT changed();
}

/// Shows why no session can begin with the current settings. With other settings, the protocol may still be
/// usable.
void OperatorController::refuse(std::vector<core::Phrase> reasons) {
  refused_ = std::move(reasons);
  stay();
}

/// Returns to the page after preparing a session that does not begin.
void OperatorController::stay() {
  preparing_ = false;
  if (checking_) check_selected();  // preparing the session had stopped the check, so start it again
  Q_EMIT changed();
}

const view::ProtocolEntry* OperatorController::entry() const {
  return selected_ >= 0 && selected_ < static_cast<int>(protocols_.size())
             ? &protocols_[static_cast<std::size_t>(selected_)]
             : nullptr;
}

void OperatorController::select(int index) {
  if (index < 0 || index >= static_cast<int>(protocols_.size()) || preparing_) return;
  selected_ = index;
  language_.clear();
  words_ = {};
  forget_refusal();
  not_live_.clear();
  worker_.abandon();
  if (!entry()->problems.empty()) return fail(entry()->problems);
  checking_ = true;
  Q_EMIT changed();
  check_selected();
}

void OperatorController::allow_checks() {
  may_check_ = true;
  if (checking_) check_selected();
}

void OperatorController::check_selected() {
  if (entry() == nullptr || !may_check_) return;
  work(
      [this, path = entry()->path, rig = request_.rig](const std::stop_token& stop) -> Then {
        auto words = view::words_of(checker_(path, rig, stop));
        return [this, words = std::move(words)] {
          words_ = words;
          checking_ = false;
          Q_EMIT changed();
          if (live_) check_live();
        };
      },
      &OperatorController::fail);
}

session::RunRequest OperatorController::request_for(const char* mode) const {
  session::RunRequest request;
  request.self_test = true;
  request.protocol = entry()->path;
  request.rig = request_.rig;
  request.database = request_.database;
  request.participant = session::kCodeToCome;
  request.mode = mode;
  return request;
}

/// Checks whether a live session of the chosen protocol is possible on this rig.
void OperatorController::check_live() {
  if (!may_begin()) return;
  preparing_ = true;
  Q_EMIT changed();
  work(
      [this, request = request_for("live")](const std::stop_token& stop) -> Then {
        return [this, reasons = session::live_problems(request, stop)] { refuse_live(reasons); };
      },
      &OperatorController::refuse_live);
}

void OperatorController::refuse_live(std::vector<core::Phrase> reasons) {
  not_live_ = std::move(reasons);
  stay();
}

void OperatorController::chooseLanguage(int index) {
  if (index < -1 || index >= languages().size()) return;
  language_ = index < 0 ? QString() : languages()[index];
  forget_refusal();
  Q_EMIT changed();
}

void OperatorController::enterParticipant(const QString& code) {
  participant_ = code;
  forget_refusal();
  Q_EMIT changed();
}

void OperatorController::setLive(bool live) {
  if (preparing_) return;
  live_ = live;
  forget_refusal();
  not_live_.clear();
  Q_EMIT changed();
  if (live_) check_live();
}

void OperatorController::setArmed(bool armed) {
  armed_ = armed;
  Q_EMIT changed();
}

bool OperatorController::may_begin() const {
  return entry() != nullptr && !refuses() && !checking_ && !preparing_ && words_.problems.empty() &&
         not_live_.empty();
}

void OperatorController::begin() { prepare(""); }

void OperatorController::beginEarly(const QString& reason) {
  const auto why = reason.trimmed().toStdString();
  if (too_early_ && !why.empty()) prepare(why);
}

void OperatorController::forget_refusal() {
  refused_.clear();
  too_early_.reset();
}

void OperatorController::prepare(const std::string& early) {
  if (!may_begin()) return;
  auto request = request_for(live_ ? "live" : "pilot");
  const bool ask_code = participant_.isEmpty();
  const bool ask_language = language() < 0 && languages().size() > 1;
  if (!ask_code) request.participant = participant_.toStdString();
  request.early = early;
  if (language() >= 0)
    request.language = language_.toStdString();
  else if (languages().size() == 1)
    request.language = languages().front().toStdString();
  preparing_ = true;
  forget_refusal();
  Q_EMIT changed();
  work(
      [this, request, ask_code, ask_language, arm = armed_](const std::stop_token& stop) -> Then {
        try {
          ChosenSession session{session::prepare(request, stop), ask_language, ask_code, arm};
          return [this, session] {
            preparing_ = false;
            Q_EMIT changed();
            Q_EMIT chosen(session);
          };
        } catch (const session::TooEarly& refused) {
          return [this, early = refused.early()] {
            too_early_ = early;
            stay();
          };
        }
      },
      &OperatorController::refuse);
}

void OperatorController::replaceMachine() { name_station({"", store::Whose::moved}); }

void OperatorController::nameCopy(const QString& name) { name_station({name.trimmed().toStdString()}); }

void OperatorController::name_station(const store::StationName& how) {
  if (preparing_) return;
  preparing_ = true;
  forget_refusal();
  Q_EMIT changed();
  work(
      [this, how, database = request_.database](const std::stop_token&) -> Then {
        store::name_station(database, how);
        return [this] {
          stay();
          refresh();
        };
      },
      &OperatorController::refuse);
}

void OperatorController::resume() {
  if (interrupted_) resumeSession(QString::fromStdString(interrupted_->session_id));
}

void OperatorController::resumeSession(const QString& session_id) {
  if (preparing_) return;
  preparing_ = true;
  forget_refusal();
  Q_EMIT changed();
  work(
      [this, arm = armed_, id = session_id.toStdString()](const std::stop_token&) -> Then {
        std::ostringstream messages;
        session::ResumeRequest request;
        request.self_test = true;
        request.database = request_.database;
        request.session_id = id;
        const auto setup = session::prepare_resume(request, messages);
        return [this, setup, arm] {
          if (!setup) return stay();
          preparing_ = false;
          Q_EMIT changed();
          Q_EMIT chosen({*setup, false, false, arm});
        };
      },
      &OperatorController::refuse);
}

QVariantList OperatorController::protocols() const {
  QVariantList list;
  for (const auto& entry : protocols_) {
    const auto file = QFileInfo(QString::fromStdString(entry.path)).fileName();
    list += QVariantMap{{"id", entry.id.empty() ? file : QString::fromStdString(entry.id)},
                        {"title", QString::fromStdString(entry.title)},
                        {"usable", entry.problems.empty()}};
  }
  return list;
}

QVariantList OperatorController::facts() const { return to_list(words_.facts); }
/// True if the station can record no session.
bool OperatorController::refuses() const { return state_.refusal != core::Phrase(); }

QVariantList OperatorController::problems() const {
  QVariantList all;
  // The page asks what happened to a database of another machine, instead of saying what to type.
  if (refuses() && !state_.other_machine) all += to_variant(state_.refusal);
  return all + to_list(words_.problems) + to_list(refused_);
}
QVariantList OperatorController::not_live() const { return to_list(not_live_); }
QVariantList OperatorController::warnings() const { return to_list(words_.warnings); }

QVariantMap OperatorController::too_early() const { return too_early_ ? to_map(*too_early_) : QVariantMap(); }

QVariantList OperatorController::cues() const {
  QVariantList list;
  for (const auto& cue : words_.cues)
    list += QVariantMap{{"name", to_variant(cue.name)}, {"says", to_variant(cue.says)}, {"leaks", cue.leaks}};
  return list;
}

QStringList OperatorController::languages() const {
  if (entry() == nullptr) return {};
  return to_list(words_.languages.empty() ? entry()->languages : words_.languages);
}

QVariantMap OperatorController::backup() const {
  using State = view::BackupNote::State;
  const auto* state = backup_.state == State::none     ? "none"
                      : backup_.state == State::recent ? "recent"
                      : backup_.state == State::old    ? "old"
                                                       : "ahead";
  return {{"state", state}, {"hours", backup_.hours}};
}

QVariantMap OperatorController::interrupted() const {
  if (!interrupted_) return {};
  return {{"participant", QString::fromStdString(interrupted_->participant)},
          {"protocol", QString::fromStdString(interrupted_->protocol_id)},
          {"trials", interrupted_->trials},
          {"ageS", interrupted_->age_s}};
}

}  // namespace turnpoint::ui

#include "moc_operator_controller.cpp"
