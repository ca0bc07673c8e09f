#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "station/store/export_bids_texts.hpp"
#include "station/store/export_files.hpp"
#include "station/store/export_tables.hpp"
#include "station/store/sqlite.hpp"
#include "station/terms/letters.hpp"
#include "station/text/number.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

const TableStyle kBids{TableStyle::Kind::bids, '\t', '.'};

std::string joined(const std::set<std::string>& texts) {
  std::string all;
  for (const auto& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

struct Labels {
  std::map<std::string, std::string> participants;
  std::map<std::string, std::string> sessions;  ///< label of each session, by session_id
};

/// Makes labels of letters and digits only, as BIDS requires. Labels differ even if case is ignored, because
/// some file systems ignore it. If two names would get the same label, part of the name's hash is appended,
/// which is the same in every export.
std::map<std::string, std::string> labels_for(const std::set<std::string>& names) {
  std::map<std::string, int> users;
  for (const auto& name : names) ++users[terms::lower(bids_label(name))];
  std::map<std::string, std::string> labels;
  for (const auto& name : names) {
    const bool shared = users[terms::lower(bids_label(name))] > 1 || bids_label(name).empty();
    labels[name] = bids_label(name) + (shared ? "x" + text::sha256(name).substr(0, 8) : "");
  }
  return labels;
}

/// Labels each person, and numbers each person's sessions. If two stations have numbered sessions of the same
/// person, the labels of these sessions also contain the station.
Labels label_all(const ProtocolSelection& selection) {
  Labels labels;
  std::set<std::string> persons;
  std::map<std::string, std::set<std::string>> names_of_person;
  const auto numbered = [](const SessionRecord& session) {
    return fmt::format("{:02}", session.session_index);
  };
  std::map<std::pair<std::string, std::string>, int> users;
  for (const auto& session : selection.sessions) {
    persons.insert(session.person);
    ++users[{session.person, numbered(session)}];
  }
  labels.participants = labels_for(persons);
  for (const auto& session : selection.sessions) {
    const bool shared = users[{session.person, numbered(session)}] > 1;
    labels.sessions[session.session_id] =
        numbered(session) +
        (shared ? bids_label(session.start.station_id) + "x" + session.session_id.substr(0, 8) : "");
  }
  return labels;
}

class BidsWriter {
 public:
  BidsWriter(const ProtocolSelection& selection, std::vector<ExportedFile>& files)
      : selection_(selection),
        files_(files),
        labels_(label_all(selection)),
        task_(bids_label(selection.protocol_id)) {}

  void write(Database& database) {
    plain("dataset_description.json", bids_description(selection_));
    plain("README", bids_readme(selection_));
    const auto newest = session_record(database, selection_.sessions.back().session_id);
    plain(fmt::format("task-{}_beh.json", task_),
          bids_sidecar(newest.start, explanations(bids_trial_columns(selection_.factors))));
    plain(fmt::format("task-{}_events.json", task_), bids_sidecar(newest.start, bids_event_columns()));
    participants();
    for (const auto& session : selection_.sessions) {
      const auto stored = read_session(database, session);
      runs(database, stored, newest.start);
      collect_answers(stored);
    }
    phenotypes();
  }

 private:
  void plain(const std::string& name, const std::string& bytes) {
    write_file(selection_.folder + "/" + name, bytes);
    files_.push_back({selection_.folder + "/" + name, 0});
  }

  void participants() {
    TableFile table(selection_.folder + "/participants.tsv", kBids, names_of(bids_participant_columns()));
    std::map<std::string, std::vector<const SessionRecord*>> sessions;
    for (const auto& session : selection_.sessions) sessions[session.person].push_back(&session);
    for (const auto& [person, list] : sessions) {
      std::set<std::string> codes, stations;
      for (const auto* session : list)
        codes.insert(session->start.participant), stations.insert(session->start.station_id);
      table.row({cell("sub-" + labels_.participants.at(person)), cell(joined(codes)),
                 cell(static_cast<int>(list.size())), cell(joined(stations))});
    }
    table.finish(files_);
    plain("participants.json", columns_json(bids_participant_columns()));
  }

  /// Writes the runs (segments) of a session. `task` is a session that contains the texts of the protocol.
  void runs(Database& database, const StoredSession& stored, const SessionStart& task) {
    const auto spans = stimulus_spans(stored);
    const auto all_events = in_order_of_time(stored.events);
    for (std::size_t i = 0; i < stored.segments.size(); ++i) {
      const int segment = static_cast<int>(i) + 1;
      const auto subject = "sub-" + labels_.participants.at(stored.session.person);
      const auto session = "ses-" + labels_.sessions.at(stored.session.session_id);
      const auto base = fmt::format("{0}/{1}/{2}/beh/{1}_{2}_task-{3}_run-{4:02}", selection_.folder, subject,
                                    session, task_, segment);
      const auto columns = bids_trial_columns(selection_.factors);
      TableFile trials(base + "_beh.tsv", kBids, names_of(columns));
      for (const auto& block : stored.blocks)
        for (const auto& trial : block.trials)
          if (trial.segment_index == segment) {
            ExportRow row{&stored.session, &block.start, &trial};
            row.span = span_of(spans, trial);
            trials.row(cells_of(columns, row));
          }
      trials.finish(files_);
      TableFile events(base + "_events.tsv", kBids, names_of(bids_event_columns()));
      for (const auto& event : all_events)
        if (event.segment_index == segment)
          events.row(bids_event_cells(event, stored.segments[i].monotonic_ns));
      events.finish(files_);
      export_bids_signals(database, {stored.session.session_id, segment, task}, base, files_);
    }
  }

  /// The answers to one questionnaire: its items in the order in which they first occur, and for each session
  /// and occasion the answers by item.
  struct Answered {
    std::vector<std::string> items;
    std::map<std::pair<std::string, int>, std::map<std::string, std::string>> rows;
  };

  void collect_answers(const StoredSession& stored) {
    for (const auto* event : standing_answers(stored.events))
      for (const auto& answer : event->answers) {
        auto& [items, rows] = answers_[answer.questionnaire];
        if (std::find(items.begin(), items.end(), answer.item) == items.end()) items.push_back(answer.item);
        rows[{stored.session.session_id, answer.occasion}][answer.item] = answer.answer;
      }
  }

  /// Writes a table for each questionnaire, with a column for each item.
  void phenotypes() {
    std::map<std::string, std::string> persons;
    for (const auto& session : selection_.sessions) persons[session.session_id] = session.person;
    for (const auto& [name, answered] : answers_) {
      std::vector<Column> columns{{"participant_id", "Label of the participant", "", ""},
                                  {"session_id", "Label of the session", "", ""},
                                  {"occasion", "Number of blocks before the questionnaire", "", ""}};
      for (const auto& item : answered.items)
        columns.push_back({item, "Answer to this item of the questionnaire", "", ""});
      TableFile table(selection_.folder + "/phenotype/" + file_name_of(name) + ".tsv", kBids,
                      names_of(columns));
      for (const auto& [key, given] : answered.rows) {
        std::vector<Cell> cells{cell("sub-" + labels_.participants.at(persons.at(key.first))),
                                cell("ses-" + labels_.sessions.at(key.first)), cell(key.second)};
        for (const auto& item : answered.items)
          cells.push_back(given.count(item) > 0 ? cell(given.at(item)) : Cell{});
        table.row(cells);
      }
      table.finish(files_);
      plain("phenotype/" + file_name_of(name) + ".json", columns_json(columns));
    }
  }

  const ProtocolSelection& selection_;
  std::vector<ExportedFile>& files_;
  Labels labels_;
  std::map<std::string, Answered> answers_;
  std::string task_;
};

}  // namespace

void check_bids_folder(const ProtocolSelection& selection) {
  const auto labels = label_all(selection);
  std::set<std::string> expected;
  for (const auto& session : selection.sessions) {
    const auto person = "sub-" + labels.participants.at(session.person);
    expected.insert(person);
    expected.insert(person + "/ses-" + labels.sessions.at(session.session_id));
  }
  const auto require = [&](const std::string& name, const char* kind) {
    if (fs::path(name).filename().string().starts_with(kind) && expected.count(name) == 0)
      throw StoreError(ErrorKind::conflict, fmt::format("export bids: {} contains {}, which is not part of "
                                                        "this export; remove it, or name an empty folder",
                                                        selection.folder, name));
  };
  std::error_code ignored;
  for (const auto& person : fs::directory_iterator(selection.folder, ignored)) {
    const auto name = person.path().filename().string();
    require(name, "sub-");
    if (!name.starts_with("sub-")) continue;
    for (const auto& session : fs::directory_iterator(person.path(), ignored))
      require(name + "/" + session.path().filename().string(), "ses-");
  }
}

void export_bids(Database& database, const ProtocolSelection& selection, std::vector<ExportedFile>& files) {
  BidsWriter(selection, files).write(database);
}

}  // namespace turnpoint::store
