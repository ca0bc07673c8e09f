#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "station/store/export_files.hpp"
#include "station/store/export_tables.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

const TableStyle kBids{TableStyle::Kind::bids, '\t', '.'};

/// BIDS labels are letters and digits only.
std::string label(const std::string& text) {
  std::string letters;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) letters += c;
  return letters;
}

struct Labels {
  std::map<std::string, std::string> participants;  ///< code -> label
  std::map<std::string, std::string> sessions;      ///< session_id -> label
};

[[noreturn]] void collide(const std::string& what) {
  throw StoreError(Fault::conflict,
                   "export bids: " + what + " would share one label; export them one by one");
}

Labels label_all(const ProtocolSelection& selection) {
  Labels labels;
  std::map<std::string, std::string> owners;
  std::set<std::string> taken;
  for (const auto& session : selection.sessions) {
    const auto& code = session.start.participant;
    const auto [owner, fresh] = owners.emplace(label(code), code);
    if (!fresh && owner->second != code) collide("participants " + owner->second + " and " + code);
    labels.participants[code] = owner->first;
    auto name = fmt::format("{:02}", session.session_index);
    if (!taken.insert(code + "/" + name).second) {
      // Two stations may both have a first session of one participant.
      name += label(session.start.station_id);
      if (!taken.insert(code + "/" + name).second) collide("sessions of participant " + code);
    }
    labels.sessions[session.session_id] = name;
  }
  return labels;
}

/// What is left there of an earlier export would be taken for part of this one.
void refuse_leftovers(const std::string& folder, const Labels& labels) {
  std::error_code ignored;
  std::set<std::string> expected;
  for (const auto& [code, name] : labels.participants) expected.insert("sub-" + name);
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const auto name = entry.path().filename().string();
    if (name.rfind("sub-", 0) == 0 && expected.count(name) == 0)
      throw StoreError(
          Fault::conflict,
          fmt::format("export bids: {} holds {}, which is not of this export; remove it or name an "
                      "empty folder",
                      folder, name));
  }
}

std::string description_json(const ProtocolSelection& selection) {
  nlohmann::ordered_json json;
  json["Name"] = selection.protocol_id;
  json["BIDSVersion"] = "1.9.0";
  json["DatasetType"] = "raw";
  json["License"] = "n/a";
  json["Authors"] = {"n/a"};
  json["GeneratedBy"] = {
      {{"Name", "Turnpoint"}, {"Version", selection.sessions.back().start.software_version}}};
  return json.dump(2) + "\n";
}

std::vector<Column> bids_event_columns() {
  return {{"onset", "Time of the event, from the start of the run", "s", ""},
          {"duration", "Events are moments", "s", ""},
          {"trial_type", "What happened", "", ""},
          {"value", "Detail", "", ""},
          {"trial_index", "Trial of the session, from 0", "", ""}};
}

class BidsWriter {
 public:
  BidsWriter(const ProtocolSelection& selection, std::vector<ExportedFile>& files)
      : selection_(selection),
        files_(files),
        labels_(label_all(selection)),
        task_(label(selection.protocol_id)) {}

  void write(Database& database) {
    refuse_leftovers(selection_.folder, labels_);
    plain("dataset_description.json", description_json(selection_));
    plain("README",
          fmt::format("Behavioural data of the protocol {}, exported by Turnpoint. One run is one process "
                      "run of the station: a session that was resumed has several.\n",
                      selection_.protocol_id));
    plain(fmt::format("task-{}_beh.json", task_),
          sidecar_json(task_, explanations(trial_columns(selection_.factors))));
    plain(fmt::format("task-{}_events.json", task_), sidecar_json(task_, bids_event_columns()));
    participants();
    for (const auto& session : selection_.sessions) runs(read_session(database, session.session_id));
  }

 private:
  void plain(const std::string& name, const std::string& bytes) {
    write_file(selection_.folder + "/" + name, bytes);
    files_.push_back({selection_.folder + "/" + name, 0});
  }

  void participants() {
    TextTable table(kBids, {"participant_id", "code", "sessions"});
    std::map<std::string, int> counts;
    for (const auto& session : selection_.sessions) ++counts[session.start.participant];
    for (const auto& [code, count] : counts)
      table.row({cell("sub-" + labels_.participants.at(code)), cell(code), cell(count)});
    write_table(selection_.folder + "/participants.tsv", table, files_);
    nlohmann::ordered_json json;
    json["code"]["Description"] = "Participant code as given to the station";
    json["sessions"]["Description"] = "Number of sessions in this data set";
    plain("participants.json", json.dump(2) + "\n");
  }

  void runs(const StoredSession& stored) {
    for (std::size_t i = 0; i < stored.segments.size(); ++i) {
      const int segment = static_cast<int>(i) + 1;
      const auto subject = "sub-" + labels_.participants.at(stored.session.start.participant);
      const auto session = "ses-" + labels_.sessions.at(stored.session.session_id);
      const auto base = fmt::format("{0}/{1}/{2}/beh/{1}_{2}_task-{3}_run-{4:02}", selection_.folder, subject,
                                    session, task_, segment);
      const auto columns = trial_columns(selection_.factors);
      TextTable trials(kBids, names_of(columns));
      for (const auto& block : stored.blocks)
        for (const auto& trial : block.trials)
          if (trial.segment_index == segment)
            trials.row(cells_of(columns, {&stored.session, &block.start, &trial}));
      write_table(base + "_beh.tsv", trials, files_);
      TextTable events(kBids, {"onset", "duration", "trial_type", "value", "trial_index"});
      for (const auto& event : stored.events)
        if (event.segment_index == segment)
          events.row({cell(static_cast<double>(event.time_ns - stored.segments[i].monotonic_ns) * 1e-9),
                      cell(0), cell(event.kind), cell(event.value), cell(event.trial_index)});
      write_table(base + "_events.tsv", events, files_);
    }
  }

  const ProtocolSelection& selection_;
  std::vector<ExportedFile>& files_;
  Labels labels_;
  std::string task_;
};

}  // namespace

void export_bids(Database& database, const ProtocolSelection& selection, std::vector<ExportedFile>& files) {
  BidsWriter(selection, files).write(database);
}

}  // namespace turnpoint::store
