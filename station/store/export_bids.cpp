#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "station/core/letters.hpp"
#include "station/core/number.hpp"
#include "station/core/toml.hpp"
#include "station/store/export_files.hpp"
#include "station/store/export_tables.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/sqlite.hpp"
#include "station/store/stored_signals.hpp"

namespace turnpoint::store {

// Texts that a BIDS data set contains in addition to its tables.

std::string bids_description(const ProtocolSelection& selection);
std::string bids_readme(const ProtocolSelection& selection);

/// Returns the BIDS sidecar file (JSON) of a table. It describes the task, the participant's instructions and
/// the program, as in the newest session, and then each column.
std::string bids_sidecar(const SessionStart& start, const std::vector<Column>& columns);

/// Returns the columns of trials.csv. Onset and duration are called stimulus_onset and stimulus_duration,
/// because BIDS reserves the short names for tables of events.
ExportColumns bids_trial_columns(const std::vector<ExportedFactor>& factors);
std::vector<Column> bids_participant_columns();
std::vector<Column> bids_event_columns();

/// Returns the values of an event's row in the table. `origin_ns` is the time on the station's clock at which
/// the event's run of the program (segment) began.
std::vector<Cell> bids_event_cells(const EventRow& event, std::int64_t origin_ns);

/// Returns only the letters and digits of a text. A BIDS label may contain no other characters.
std::string bids_label(const std::string& text);

namespace {

using Json = nlohmann::ordered_json;

/// Reads a text of the protocol, which is a string, or a table with one string per language.
std::string text_of(const core::Value* value, const std::string& language) {
  if (value == nullptr) return "";
  if (value->kind == core::Value::Kind::string) return value->string;
  if (value->kind != core::Value::Kind::table || value->entries.empty()) return "";
  const auto* found = value->find(language) == nullptr ? &value->entries.front() : value->find(language);
  return found->value.string;
}

const core::Value* at(const core::Value& table, const std::string& key) {
  const auto* entry = table.find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

/// The texts of a protocol that were stored with its newest session.
struct Texts {
  std::string title, instructions;
};

Texts texts_of(const SessionStart& start) {
  Texts texts;
  try {
    const auto document = core::parse_toml(start.protocol_text, start.protocol_path);
    if (const auto* head = at(document, "protocol"))
      texts.title = text_of(at(*head, "title"), start.language);
    if (const auto* task = at(document, "task")) {
      texts.instructions = text_of(at(*task, "instructions"), start.language);
      const auto question = text_of(at(*task, "question"), start.language);
      if (!question.empty()) texts.instructions += (texts.instructions.empty() ? "" : "\n") + question;
    }
    if (const auto* tasks = at(document, "tasks"))
      for (const auto& task : tasks->entries)
        texts.instructions += (texts.instructions.empty() ? "" : "\n") + task.key + ": " +
                              text_of(at(task.value, "question"), start.language);
  } catch (const core::BadInput&) {
    // Leave out texts that this release can no longer read. The data are exported anyway.
  }
  if (texts.title.empty()) texts.title = start.protocol_id;
  return texts;
}

}  // namespace

std::string bids_label(const std::string& text) {
  std::string letters;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) letters += c;
  return letters;
}

std::string bids_description(const ProtocolSelection& selection) {
  Json json;
  json["Name"] = selection.protocol_id;
  json["BIDSVersion"] = "1.9.0";
  json["DatasetType"] = "raw";
  json["License"] = "n/a";
  json["Authors"] = {"n/a"};
  json["GeneratedBy"] = {
      {{"Name", "Turnpoint"}, {"Version", selection.sessions.back().start.software_version}}};
  return json.dump(2) + "\n";
}

std::string bids_readme(const ProtocolSelection& selection) {
  return fmt::format(
      "Behavioural data of the protocol {}, exported by Turnpoint. Each start of the station program is one "
      "run: a session that was resumed has several runs.\n",
      selection.protocol_id);
}

std::string bids_sidecar(const SessionStart& start, const std::vector<Column>& columns) {
  const auto texts = texts_of(start);
  Json json;
  json["TaskName"] = bids_label(start.protocol_id);
  json["TaskDescription"] = texts.title;
  if (!texts.instructions.empty()) json["Instructions"] = texts.instructions;
  json["StimulusPresentation"] = {{"OperatingSystem", start.kernel},
                                  {"SoftwareName", "Turnpoint"},
                                  {"SoftwareVersion", start.software_version}};
  const auto explained = Json::parse(columns_json(columns));
  for (const auto& [name, column] : explained.items()) json[name] = column;
  return json.dump(2) + "\n";
}

ExportColumns bids_trial_columns(const std::vector<ExportedFactor>& factors) {
  auto columns = trial_columns(factors);
  for (auto& [column, cell] : columns)
    if (column.name == "onset" || column.name == "duration") column.name = "stimulus_" + column.name;
  return columns;
}

std::vector<Column> bids_participant_columns() {
  return {{"participant_id", "Label of the participant in this data set", "", ""},
          {"code", "Codes that the stations gave to the participant", "", ""},
          {"sessions", "Number of sessions in this data set", "", ""},
          {"station", "Stations at which the sessions were run", "", ""}};
}

std::vector<Column> bids_event_columns() {
  return {{"onset", "Time of the event, from the start of the run", "s", ""},
          {"duration", "Length of a stimulus; 0 for all other events, which have no duration", "s", ""},
          {"trial_type", "What happened", "", ""},
          {"value", "Detail", "", ""},
          {"trial_index", "Index of the trial in the session, from 0", "", ""}};
}

std::vector<Cell> bids_event_cells(const EventRow& event, std::int64_t origin_ns) {
  return {cell(static_cast<double>(event.time_ns - origin_ns) * 1e-9), cell(event_length_s(event)),
          cell(event.kind), cell(event.value), cell(event.trial_index)};
}

namespace {

using Json = nlohmann::ordered_json;

/// Returns the label of a recording. The stream "finger" of the force cells is labelled "force", after what
/// it measures.
std::string recording_of(const std::string& stream) {
  return stream == "finger" ? "force" : bids_label(stream);
}

/// Writes the signals of one run as one table. BIDS gives a recording one start and one rate, so the table
/// has no gaps: each trial is placed by its time, to within half a point, and the rows between trials are
/// filled.
class Recording {
 public:
  Recording(const std::string& base, const SignalRow& first, std::vector<SignalChannel> channels)
      : base_(base),
        start_s_(first.start_s),
        rate_Hz_(first.rate_Hz),
        channels_(std::move(channels)),
        table_(base + ".tsv.gz", {TableStyle::Kind::bids, '\t', '.'}, names_of(signal_columns(channels_)),
               TableFile::Header::left_out) {}

  void add(const SignalRow& signal) {
    if (signal.rate_Hz != rate_Hz_)
      throw StoreError(ErrorKind::corrupt,
                       fmt::format("export bids: the signals \"{}\" of one run have {} and {} points per "
                                   "second",
                                   signal.stream, rate_Hz_, signal.rate_Hz));
    const auto first = std::llround((signal.start_s - start_s_) * rate_Hz_);
    for (const std::vector<Cell> missing(channels_.size()); next_ < first; ++next_) table_.row(missing);
    const auto values = decode(signal);
    const auto places = places_of(signal, channels_);
    std::vector<Cell> cells(channels_.size());
    for (auto point = next_ - first; point < signal.points; ++point, ++next_) {
      for (std::size_t c = 0; c < values.size(); ++c) {
        const double value = values[c][static_cast<std::size_t>(point)];
        cells[places[c]] = std::isnan(value) ? Cell{} : cell(value);
      }
      table_.row(cells);
    }
  }

  /// `start` is the session whose protocol describes the task in the sidecar file.
  void finish(const SessionStart& start, std::vector<ExportedFile>& files) {
    table_.finish(files);
    const auto columns = signal_columns(channels_);
    Json json{{"SamplingFrequency", rate_Hz_},
              {"StartTime", start_s_},
              {"Columns", names_of(columns)},
              {"PhysioType", "generic"}};
    const auto described = Json::parse(bids_sidecar(start, columns));
    for (const auto& [name, value] : described.items()) json[name] = value;
    write_file(base_ + ".json", json.dump(2) + "\n");
    files.push_back({base_ + ".json", 0});
  }

 private:
  std::string base_;
  double start_s_, rate_Hz_;
  std::vector<SignalChannel> channels_;
  TableFile table_;
  std::int64_t next_ = 0;  ///< number of rows that have been written
};

}  // namespace

void export_bids_signals(Database& database, const BidsRun& run, const std::string& base,
                         std::vector<ExportedFile>& files) {
  const auto& session_id = run.session_id;
  for (const auto& stream : signal_streams(database, session_id)) {
    // A recording of BIDS has no gaps. Between two void trials, hours of samples would be missing.
    if (stream == core::kRawStream) continue;
    SignalReader reader(database, session_id, stream, run.segment);
    std::optional<Recording> recording;
    while (const auto stored = reader.next()) {
      if (!recording)
        recording.emplace(fmt::format("{}_recording-{}_physio", base, recording_of(stream)), stored->row,
                          signal_channels(database, session_id, stream));
      recording->add(stored->row);
    }
    if (recording) recording->finish(run.task, files);
  }
}

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
  for (const auto& name : names) ++users[core::lower(bids_label(name))];
  std::map<std::string, std::string> labels;
  for (const auto& name : names) {
    const bool shared = users[core::lower(bids_label(name))] > 1 || bids_label(name).empty();
    labels[name] = bids_label(name) + (shared ? "x" + core::sha256(name).substr(0, 8) : "");
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
        for (std::size_t at = 0; at < block.trials.size(); ++at)
          if (const auto& trial = block.trials[at]; trial.segment_index == segment) {
            ExportRow row{&stored.session, &block.start, &trial};
            row.span = span_of(spans, trial);
            row.previous = previous_trial(block, at);
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
