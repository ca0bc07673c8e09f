#include "station/ui/operator/sessions_controller.hpp"

#include <QDateTime>
#include <algorithm>
#include <filesystem>
#include <utility>

#include "station/store/backup.hpp"
#include "station/store/export.hpp"
#include "station/store/session_log.hpp"
#include "station/ui/operator/facts.hpp"
#include "station/view/report_pages.hpp"

namespace turnpoint::ui {

namespace fs = std::filesystem;

namespace {

using core::phrase, core::plain;

QVariantMap to_map(const view::SessionLine& session) {
  return {{"id", QString::fromStdString(session.session_id)},
          {"person", QString::fromStdString(session.person)},
          {"protocol", QString::fromStdString(session.protocol)},
          {"started", QString::fromStdString(session.started.substr(0, 16)).replace('T', ' ')},
          {"mode", QString::fromStdString(session.run_mode)},
          {"status", QString::fromStdString(session.status)},
          {"reason", to_variant(session.reason)},
          {"trials", session.trials},
          {"resumable", session.resumable}};
}

/// Describes in words what a withdrawal deletes, or would delete.
std::vector<core::Phrase> words_of(const store::Withdrawal& gone, bool done) {
  std::vector<core::Phrase> words{phrase(done ? "operator.deleted" : "operator.would_delete",
                                         {plain(gone.participant), plain(gone.sessions.size()),
                                          plain(gone.trials), plain(gone.events), plain(gone.annotations)})};
  if (!gone.removed_copies.empty())
    words.push_back(phrase(done ? "operator.copies_deleted" : "operator.copies_would",
                           {plain(gone.removed_copies.size())}));
  for (const auto& path : gone.remaining_copies)
    words.push_back(phrase("operator.copy_remains", {plain(path)}));
  return words;
}

/// Returns the options for withdrawing everything of a person. They include the folder of the last backup, if
/// that folder can be reached.
store::WithdrawOptions withdrawal_of(const std::string& person, const std::string& database) {
  store::WithdrawOptions options;
  options.participant = person;
  const auto last = store::last_backup(database);
  if (!last) return options;
  const auto folder = fs::path(last->path).parent_path();
  std::error_code unreachable;
  if (fs::is_directory(folder, unreachable)) options.backup_directory = folder.string();
  return options;
}

core::Phrase what_is_not_searched(const store::WithdrawOptions& options) {
  return options.backup_directory.empty()
             ? phrase("operator.backups_unsearched")
             : phrase("operator.backups_included", {plain(options.backup_directory)});
}

}  // namespace

SessionsController::SessionsController(const session::StationRequest& request, maintenance::DiskSources disks,
                                       QObject* parent)
    : QObject(parent),
      database_(fs::absolute(request.database).string()),
      sources_(std::move(disks)),
      worker_(*this) {
  sources_.data = database_;
  report_.save_in((fs::path(database_).parent_path() / "figures").string());
}

void SessionsController::open() {
  said_ = {};
  failed_ = false;
  unreadable_ = false;
  try {
    read_list();
  } catch (const std::exception& error) {
    failed_ = unreadable_ = true;
    said_ = explanation_of(error);
  }
  lookForDisks();
}

void SessionsController::read_list() {
  all_ = view::session_lines(database_);
  view::put_in_order(all_, order_ == "study"         ? view::SessionOrder::study
                           : order_ == "participant" ? view::SessionOrder::participant
                                                     : view::SessionOrder::newest);
  if (line() == nullptr) chosen_ = all_.empty() ? "" : all_.front().session_id;
}

void SessionsController::setSearch(const QString& search) {
  search_ = search;
  Q_EMIT changed();
}

void SessionsController::setOrder(const QString& order) {
  if (order == order_) return;
  order_ = order;
  open();
}

void SessionsController::lookForDisks() {
  try {
    disks_ = maintenance::removable_disks(sources_);
  } catch (const std::exception& error) {  // ignore this: a disk was unplugged while the list was made
    disks_.clear();
    said_ = explanation_of(error);
    failed_ = true;
  }
  Q_EMIT changed();
}

const view::SessionLine* SessionsController::line() const {
  const auto found = std::find_if(all_.begin(), all_.end(),
                                  [this](const auto& session) { return session.session_id == chosen_; });
  return found == all_.end() ? nullptr : &*found;
}

void SessionsController::select(int index) {
  const auto shown = sessions();
  if (busy_ || index < 0 || index >= shown.size()) return;
  chosen_ = shown[index].toMap()["id"].toString().toStdString();
  said_ = {};
  failed_ = false;
  Q_EMIT changed();
}

/// Runs an action on the worker thread. An action is never abandoned, because it writes files.
void SessionsController::act(std::function<Done()> action) {
  if (busy_) return;
  busy_ = true;
  failed_ = false;
  said_ = {};
  Q_EMIT changed();
  worker_.start([this, action = std::move(action)](const std::stop_token&) -> std::function<void()> {
    Done done;
    bool failed = false;
    try {
      done = action();
    } catch (const std::exception& error) {
      done.said = phrases_of(error);
      failed = true;
    }
    return [this, done = std::move(done), failed] {
      busy_ = false;
      failed_ = failed;
      said_ = in_lines(done.said);
      if (done.then) done.then();
      Q_EMIT changed();
    };
  });
}

void SessionsController::makeReport(const QString& language) {
  if (line() == nullptr || line()->trials == 0) return;
  report_.clear();
  act([this, id = chosen_, language = language.toStdString()] {
    report_.take(view::report_pages(database_, id, language));
    return Done{};
  });
}

void SessionsController::annotate(const QString& note) {
  if (line() == nullptr || note.trimmed().isEmpty()) return;
  act([this, id = chosen_, text = note.trimmed().toStdString()] {
    store::annotate(database_, id, text);
    return Done{{phrase("operator.note_added")}, [this] { read_list(); }};
  });
}

std::string SessionsController::folder_of(int place) const {
  if (place == 0) return (fs::path(database_).parent_path() / "exports").string();
  return disks_[static_cast<std::size_t>(place) - 1].folder;
}

/// Returns the folder of a place. If the place is a disk, mounts it first unless it still is; the folder of a
/// disk that was pulled out lies on the system's own disk.
static std::string mounted(std::string folder, const std::vector<maintenance::Disk>& disks, int place,
                           const maintenance::DiskSources& sources) {
  return place > 0 ? maintenance::mount(disks[static_cast<std::size_t>(place) - 1], sources)
                   : std::move(folder);
}

void SessionsController::exportTo(int place, const QString& what, const QString& format) {
  if (!is_place(place) || (what != "all" && line() == nullptr)) return;
  store::ExportOptions options;
  if (what == "session") options.session_id = chosen_;
  if (what == "study") options.protocol_id = line()->protocol_id;
  if (format == "bids") options.format = store::ExportFormat::bids;
  // Each export gets a new folder, so that files of an earlier export never stand beside newer ones.
  const auto name =
      "turnpoint-export-" + QDateTime::currentDateTime().toString("yyyy-MM-dd-hhmmss").toStdString();
  act([this, options, name, place, disks = disks_, folder = folder_of(place)] {
    const auto to = (fs::path(mounted(folder, disks, place, sources_)) / name).string();
    const auto files = store::export_data(database_, to, options);
    return Done{{phrase("operator.exported", {plain(files.size()), plain(to)})}, [this] { lookForDisks(); }};
  });
}

void SessionsController::backUpTo(int place) {
  if (!is_place(place)) return;
  act([this, place, disks = disks_, folder = folder_of(place)] {
    store::BackupOptions options;
    const auto at = mounted(folder, disks, place, sources_);
    options.directory = place == 0 ? (fs::path(database_).parent_path() / "backups").string()
                                   : (fs::path(at) / "turnpoint-backups").string();
    // If the disk was pulled out meanwhile, its folder would now lie on the system's own disk. With this
    // setting the backup refuses that.
    if (place > 0) options.destination = store::Destination::disk;
    const auto report = store::backup(database_, options);
    std::vector<core::Phrase> said{
        phrase("operator.backed_up", {plain(report.path), plain(report.sessions), plain(report.trials)})};
    if (place == 0) said.push_back(phrase("operator.backup_here"));
    if (!report.unrecorded.empty()) said.push_back(plain(report.unrecorded));
    return Done{said, [this] { lookForDisks(); }};
  });
}

void SessionsController::eject(int place) {
  if (!is_place(place) || place == 0) return;
  act([this, disk = disks_[static_cast<std::size_t>(place) - 1]] {
    maintenance::eject(disk, sources_);
    return Done{{phrase("operator.can_unplug", {plain(disk.name)})}, [this] { lookForDisks(); }};
  });
}

void SessionsController::planWithdrawal() {
  if (line() == nullptr) return;
  act([this, person = line()->person] {
    const auto options = withdrawal_of(person, database_);
    auto plan = words_of(store::plan_withdrawal(database_, options), false);
    plan.push_back(what_is_not_searched(options));
    return Done{{}, [this, plan, person] {
                  consequence_ = in_lines(plan);
                  withdrawing_ = person;
                  Q_EMIT planned();
                }};
  });
}

void SessionsController::withdraw() {
  if (withdrawing_.empty() || busy_) return;
  act([this, person = std::exchange(withdrawing_, {})] {
    const auto options = withdrawal_of(person, database_);
    auto words = words_of(store::withdraw(database_, options), true);
    words.push_back(what_is_not_searched(options));
    return Done{words, [this] {
                  consequence_ = {};
                  read_list();
                }};
  });
}

QVariantList SessionsController::sessions() const {
  QVariantList list;
  std::string group;
  for (const auto& session : all_) {
    if (!view::matches(session, search_.toStdString())) continue;
    auto map = to_map(session);
    const auto& own = order_ == "study" ? session.protocol_id : session.person;
    map["heading"] = order_ == "newest" || own == group ? QString() : QString::fromStdString(own);
    group = own;
    list += map;
  }
  return list;
}

int SessionsController::selected() const {
  int index = 0;
  for (const auto& session : all_) {
    if (!view::matches(session, search_.toStdString())) continue;
    if (session.session_id == chosen_) return index;
    ++index;
  }
  return -1;
}

QVariant SessionsController::chosen() const { return line() == nullptr ? QVariantMap() : to_map(*line()); }

QStringList SessionsController::notes() const {
  return line() == nullptr ? QStringList() : to_list(line()->notes);
}

QVariantList SessionsController::places() const {
  QVariantList list{
      QVariantMap{{"name", ""},
                  {"folder", QString::fromStdString(fs::path(database_).parent_path().string())},
                  {"disk", false},
                  {"mounted", true}}};
  for (const auto& disk : disks_)
    list += QVariantMap{{"name", QString::fromStdString(disk.name)},
                        {"folder", QString::fromStdString(disk.folder)},
                        {"disk", true},
                        {"mounted", !disk.folder.empty()}};
  return list;
}

}  // namespace turnpoint::ui

#include "moc_sessions_controller.cpp"
