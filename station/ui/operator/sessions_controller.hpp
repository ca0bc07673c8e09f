#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QStringList>
#include <QVariantList>
#include <functional>
#include <string>
#include <vector>

#include "station/maintenance/disks.hpp"
#include "station/session/prepare.hpp"
#include "station/store/withdraw.hpp"
#include "station/ui/operator/report_model.hpp"
#include "station/ui/platform/newest_job.hpp"
#include "station/ui/shared/phrases.hpp"
#include "station/view/session_list.hpp"

namespace turnpoint::ui {

/// The page of sessions: list, search, report, note, export, backup and withdrawal. One action runs at a
/// time, on a separate thread; while it runs, other actions are ignored. GUI thread only.
class SessionsController : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(QString search READ search WRITE setSearch NOTIFY changed)
  /// how the list is ordered: newest, study or participant
  Q_PROPERTY(QString order READ order WRITE setOrder NOTIFY changed)
  /// sessions that match the search, as {id, person, protocol, started, mode, status, trials, resumable, heading};
  /// `heading` is the study or the participant where the next ones begin, otherwise ""
  Q_PROPERTY(QVariantList sessions READ sessions NOTIFY changed)
  Q_PROPERTY(int total READ total NOTIFY changed)  ///< number of all sessions
  Q_PROPERTY(int selected READ selected NOTIFY changed)
  /// the chosen session, with the same fields as in `sessions`; empty if none is chosen
  Q_PROPERTY(QVariant chosen READ chosen NOTIFY changed)
  Q_PROPERTY(QStringList notes READ notes NOTIFY changed)
  Q_PROPERTY(bool busy READ busy NOTIFY changed)
  /// what the last action did, or why it failed
  Q_PROPERTY(QVariant said READ said NOTIFY changed)
  Q_PROPERTY(bool failed READ failed NOTIFY changed)
  Q_PROPERTY(bool unreadable READ unreadable NOTIFY changed)  ///< the list of sessions could not be read
  /// places for exports and backups as {name, folder, disk, mounted}; the first is a folder of this machine
  Q_PROPERTY(QVariantList places READ places NOTIFY changed)
  /// what a withdrawal of the chosen participant would delete; "" before planWithdrawal()
  Q_PROPERTY(QVariant consequence READ consequence NOTIFY changed)
  Q_PROPERTY(turnpoint::ui::ReportModel* report READ report CONSTANT)

 public:
  explicit SessionsController(const session::StationRequest& request, maintenance::DiskSources disks = {},
                              QObject* parent = nullptr);

  QString search() const { return search_; }
  // Qt calls this function by its name, as the setter of the property `search`.
  void setSearch(const QString& search);  // NOLINT(readability-identifier-naming)
  QString order() const { return order_; }
  void setOrder(const QString& order);  // NOLINT(readability-identifier-naming)
  QVariantList sessions() const;
  int total() const { return static_cast<int>(all_.size()); }
  int selected() const;
  QVariant chosen() const;
  QStringList notes() const;
  bool busy() const { return busy_; }
  QVariant said() const { return to_variant(said_); }
  bool failed() const { return failed_; }
  bool unreadable() const { return unreadable_; }
  QVariantList places() const;
  QVariant consequence() const { return to_variant(consequence_); }
  ReportModel* report() { return &report_; }

  /// Reads the list of sessions and the disks again.
  Q_INVOKABLE void open();
  Q_INVOKABLE void select(int index);
  Q_INVOKABLE void makeReport(const QString& language);
  Q_INVOKABLE void annotate(const QString& note);
  /// Updates the list of disks that are plugged in.
  Q_INVOKABLE void lookForDisks();
  /// Exports the chosen session, all sessions of its study, or all sessions (`what` is session, study or all) to a new
  /// folder at a place. `format` is csv or bids.
  Q_INVOKABLE void exportTo(int place, const QString& what, const QString& format);
  Q_INVOKABLE void backUpTo(int place);
  Q_INVOKABLE void eject(int place);
  /// Finds out what a withdrawal of the chosen participant would delete. withdraw() then deletes it.
  Q_INVOKABLE void planWithdrawal();
  Q_INVOKABLE void withdraw();

 Q_SIGNALS:
  void changed();
  void planned();  ///< emitted when `consequence` is known

 private:
  struct Done {
    std::vector<core::Phrase> said;
    std::function<void()> then = {};  ///< what else to do on the GUI thread; may be empty
  };
  void act(std::function<Done()> action);
  const view::SessionLine* line() const;
  std::string folder_of(int place) const;
  bool is_place(int place) const { return place >= 0 && place <= static_cast<int>(disks_.size()); }
  void read_list();

  std::string database_;
  maintenance::DiskSources sources_;
  std::vector<view::SessionLine> all_;
  std::vector<maintenance::Disk> disks_;
  QString search_, order_ = "newest";
  std::string chosen_;  ///< id of the chosen session
  core::Phrase said_;
  bool busy_ = false, failed_ = false, unreadable_ = false;
  core::Phrase consequence_;
  std::string withdrawing_;  ///< participant whose withdrawal `consequence_` describes
  ReportModel report_;
  NewestJob
      worker_;  // The last member, so that its thread ends before the objects that it uses are destroyed.
};

}  // namespace turnpoint::ui
