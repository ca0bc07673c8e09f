#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "station/core/toml.hpp"
#include "station/store/export_files.hpp"
#include "station/store/export_tables.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/sqlite.hpp"
#include "station/store/stored_signals.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

std::vector<Column> list_columns() {
  return {
      {"participant_id", "Code of the participant, or CODE@STATION if several people have this code", "", ""},
      {"session_id", "UUID of the session, unique over all stations", "", ""},
      {"run_mode", "Kind of session: only live sessions are data of a study", "", "live | pilot | simulated"},
      {"segment_id", "Run of the program within the session, from 1", "", ""},
      {"trial_index", "Index of the trial among all trials presented in the session, from 0", "", ""},
      {"stream",
       "What recorded the signal: finger means the force cells, follow and envelope what a scene that "
       "follows "
       "the finger did, raw all captured channels of the sound card",
       "", "finger | follow | envelope | raw"},
      {"onset", "Time of the signal's first point, from the start of the segment", "s", ""},
      {"start_frame", "Playback frame of the signal's first point", "", ""},
      {"rate_hz", "Points per second", "Hz", ""},
      {"points", "Number of points", "", ""},
      {"file", "Table in which the points are", "", ""},
      {"columns_version", "Version of this set of columns", "", ""}};
}

/// The first columns of a table of points; the columns of the signal's channels follow them.
std::vector<Column> point_columns() {
  return {
      {"trial_index", "Index of the trial among all trials presented in the session, from 0", "", ""},
      {"segment_id", "Run of the program within the session, from 1", "", ""},
      {"time_s",
       "Time of the point, from the start of the segment, as in trials.csv and events.csv; rounded to "
       "1 us",
       "s", ""},
      {"frame", "Playback frame of the point: a stimulus begins at onset_frame of intervals.csv", "", ""}};
}

std::vector<Column> followed_by(std::vector<Column> columns, const std::vector<Column>& more) {
  columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

/// Writes the points of one signal. A missing value becomes an empty cell.
void add_points(TableFile& table, const StoredSignal& stored, std::optional<double> playback_Hz,
                const std::vector<SignalChannel>& channels) {
  const auto& signal = stored.row;
  const auto values = decode(signal);
  const auto places = places_of(signal, channels);
  const auto before = point_columns().size();
  std::vector<Cell> cells(before + channels.size());
  cells[0] = cell(stored.trial_index);
  cells[1] = cell(stored.segment_index);
  const auto frames_per_point =
      playback_Hz ? std::optional<std::int64_t>(std::llround(*playback_Hz / signal.rate_Hz)) : std::nullopt;
  for (std::int64_t k = 0; k < signal.points; ++k) {
    const double time_s = signal.start_s + static_cast<double>(k) / signal.rate_Hz;
    cells[2] = cell(std::round(1e6 * time_s) / 1e6);
    if (frames_per_point) cells[3] = cell(signal.start_frame + k * *frames_per_point);
    for (std::size_t c = 0; c < values.size(); ++c) {
      const double value = values[c][static_cast<std::size_t>(k)];
      cells[before + places[c]] = std::isnan(value) ? Cell{} : cell(value);
    }
    table.row(cells);
  }
}

std::string table_name(const std::string& session_id, const std::string& stream) {
  return "signals/" + file_name_of(session_id + "_" + stream) + ".csv.gz";
}

/// Throws if the folder has signals that are not part of this export.
void refuse_leftovers(const std::string& folder, const std::set<std::string>& expected) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder + "/signals", ignored)) {
    const auto name = "signals/" + entry.path().filename().string();
    if (name.ends_with(".csv.gz") && expected.count(name) == 0)
      throw StoreError(ErrorKind::conflict, fmt::format("export signals: {} contains {}, which is not part "
                                                        "of this export; remove it, or name an empty folder",
                                                        folder, name));
  }
}

Json explained(const std::vector<Column>& columns) { return Json::parse(columns_json(columns)); }

}  // namespace

std::optional<double> playback_rate_Hz(const SessionStart& start) {
  try {
    const auto rig = core::parse_toml(start.rig_text, start.rig_path);
    const auto* output = rig.find("output");
    const auto* rate = output == nullptr ? nullptr : output->value.find("rate_Hz");
    if (rate != nullptr && rate->value.number > 0) return rate->value.number;
  } catch (const core::BadInput&) {
    // The stored rig file cannot be read, so the rate of frames is unknown. The export then leaves out frame
    // numbers.
  }
  return std::nullopt;
}

void keep_with_signals(Database& database, std::vector<ProtocolSelection>& selections) {
  for (auto& selection : selections)
    std::erase_if(selection.sessions, [&](const SessionRecord& session) {
      return signal_streams(database, session.session_id).empty();
    });
  std::erase_if(selections, [](const auto& selection) { return selection.sessions.empty(); });
  if (selections.empty())
    throw StoreError(ErrorKind::missing,
                     "export: the sessions that these options choose have no signals; a rig with force cells "
                     "records them, and a rig with [capture] keeps what was captured in void trials");
}

void check_signals_folder(Database& database, const ProtocolSelection& selection) {
  std::set<std::string> expected;
  for (const auto& session : selection.sessions)
    for (const auto& stream : signal_streams(database, session.session_id))
      expected.insert(table_name(session.session_id, stream));
  refuse_leftovers(selection.folder, expected);
}

void export_signals(Database& database, const ProtocolSelection& selection, const TableStyle& style,
                    std::vector<ExportedFile>& files) {
  TableFile list(selection.folder + "/signals.csv", style, names_of(list_columns()));
  std::map<std::string, std::vector<Column>> found;
  for (const auto& session : selection.sessions) {
    const auto rate = playback_rate_Hz(session_record(database, session.session_id).start);
    for (const auto& stream : signal_streams(database, session.session_id)) {
      const auto channels = signal_channels(database, session.session_id, stream);
      const auto columns = followed_by(point_columns(), signal_columns(channels));
      const auto name = table_name(session.session_id, stream);
      TableFile table(selection.folder + "/" + name, style, names_of(columns));
      SignalReader reader(database, session.session_id, stream);
      while (const auto stored = reader.next()) {
        const auto& signal = stored->row;
        list.row({cell(session.person), cell(session.session_id),
                  cell(std::string(store::name(session.start.run_mode))), cell(stored->segment_index),
                  cell(stored->trial_index), cell(signal.stream), cell(signal.start_s),
                  cell(signal.start_frame), cell(signal.rate_Hz), cell(signal.points), cell(name),
                  cell(std::string("1"))});
        add_points(table, *stored, rate, channels);
      }
      table.finish(files);
      for (const auto& column : columns) {
        auto& known = found["signals/*_" + stream + ".csv.gz"];
        if (std::none_of(known.begin(), known.end(), [&](const auto& k) { return k.name == column.name; }))
          known.push_back(column);
      }
    }
  }
  list.finish(files);
  Json codebook{{"protocol_id", selection.protocol_id}, {"missing", "n/a"}};
  codebook["signals.csv"] = explained(list_columns());
  for (const auto& [name, columns] : found) codebook[name] = explained(columns);
  write_file(selection.folder + "/signals.json", codebook.dump(2) + "\n");
  files.push_back({selection.folder + "/signals.json", 0});
}

}  // namespace turnpoint::store
