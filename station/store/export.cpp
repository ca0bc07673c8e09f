#include "station/store/export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <tuple>
#include <utility>

#include "station/core/letters.hpp"
#include "station/core/usage_error.hpp"
#include "station/store/export_files.hpp"
#include "station/store/export_tables.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/sqlite.hpp"
#include "station/store/whole_file.hpp"
#include "station/store/withdraw.hpp"

namespace turnpoint::store {
namespace {

std::map<int, int> segments_of_trials(const StoredSession& stored) {
  std::map<int, int> segments;
  for (const auto& block : stored.blocks)
    for (const auto& trial : block.trials) segments[trial.trial_index] = trial.segment_index;
  return segments;
}

}  // namespace

double event_length_s(const EventRow& event) {
  double length = 0;
  if (event.kind == "stimulus")
    std::from_chars(event.value.data(), event.value.data() + event.value.size(), length);
  return length;
}

std::map<int, StimulusSpan> stimulus_spans(const StoredSession& stored) {
  const auto segments = segments_of_trials(stored);
  std::map<int, std::pair<std::int64_t, std::int64_t>> spans_ns;
  for (const auto& event : stored.events) {
    if (event.kind != "stimulus" || !event.trial_index) continue;
    const auto trial = segments.find(*event.trial_index);
    if (trial == segments.end() || trial->second != event.segment_index) continue;
    const auto origin = stored.segments.at(static_cast<std::size_t>(event.segment_index) - 1).monotonic_ns;
    const auto start_ns = event.time_ns - origin;
    const std::int64_t end_ns = start_ns + std::llround(event_length_s(event) * 1e9);
    const auto [found, fresh] = spans_ns.try_emplace(*event.trial_index, start_ns, end_ns);
    if (!fresh)
      found->second = {std::min(found->second.first, start_ns), std::max(found->second.second, end_ns)};
  }
  std::map<int, StimulusSpan> spans;
  for (const auto& [trial, span] : spans_ns)
    spans[trial] = {static_cast<double>(span.first) * 1e-9,
                    static_cast<double>(span.second - span.first) * 1e-9};
  return spans;
}

std::optional<StimulusSpan> span_of(const std::map<int, StimulusSpan>& spans, const TrialRow& trial) {
  const auto found = spans.find(trial.trial_index);
  return found == spans.end() ? std::nullopt : std::optional(found->second);
}

std::vector<EventRow> in_order_of_time(std::vector<EventRow> events) {
  std::stable_sort(events.begin(), events.end(), [](const auto& a, const auto& b) {
    return std::tie(a.segment_index, a.time_ns) < std::tie(b.segment_index, b.time_ns);
  });
  return events;
}

namespace fs = std::filesystem;

namespace {

void check_style(const ExportOptions& options) {
  const auto refuse = [](const std::string& what) { throw core::UsageError("export: " + what); };
  if (options.decimal != '.' && options.decimal != ',')
    refuse(fmt::format("the decimal mark must be '.' or ',', not '{}'", options.decimal));
  if (std::string(",;\t|").find(options.separator) == std::string::npos)
    refuse(fmt::format("the separator must be ',' ';' '|' or a tab, not '{}'", options.separator));
  if (options.separator == options.decimal)
    refuse(fmt::format(
        "the separator and the decimal mark are both '{}'; with a decimal comma, use the separator ';'",
        options.separator));
  if (options.byte_order_mark && options.format != ExportFormat::csv)
    refuse("--byte-order-mark is only for --format csv");
  if (options.format == ExportFormat::bids && (options.separator != ',' || options.decimal != '.'))
    refuse(
        "BIDS tables always use tabs and decimal points; --separator and --decimal are for the other "
        "formats");
}

void add_factors(std::vector<ExportedFactor>& all, const std::vector<std::string>& more) {
  for (const auto& name : more)
    if (std::none_of(all.begin(), all.end(), [&name](const auto& one) { return one.name == name; }))
      all.push_back({name, {}});
}

/// Adds the texts that were presented in a session. A reader of the export cannot tell a text "007" from a
/// number, nor a text "n/a" from a missing value.
void add_levels(Database& database, const std::string& session_id, std::vector<ExportedFactor>& factors) {
  Statement texts(database,
                  "SELECT DISTINCT f.key, f.value FROM trial, json_each(trial.factors) AS f"
                  " WHERE session_id = ? AND f.type = 'text' ORDER BY 1, 2");
  texts.bind(session_id);
  while (texts.step()) {
    const auto name = texts.text(0), level = texts.text(1);
    for (auto& factor : factors)
      if (factor.name == name &&
          std::find(factor.levels.begin(), factor.levels.end(), level) == factor.levels.end())
        factor.levels.push_back(level);
  }
}

std::vector<ProtocolSelection> select(Database& database, const std::string& directory,
                                      const ExportOptions& options) {
  std::map<std::string, ProtocolSelection> protocols;
  for (auto& session :
       list_sessions(database, {options.session_id, options.participant, options.protocol_id})) {
    auto& selection = protocols[session.start.protocol_id];
    add_factors(selection.factors, session.start.factor_columns);
    add_levels(database, session.session_id, selection.factors);
    selection.sessions.push_back(std::move(session));
  }
  std::vector<ProtocolSelection> list;
  std::map<std::string, std::string> owners;
  for (auto& [id, selection] : protocols) {
    const auto folder = file_name_of(id);
    // some file systems ignore case
    if (const auto [owner, fresh] = owners.emplace(core::lower(folder), id); !fresh)
      throw StoreError(ErrorKind::conflict,
                       fmt::format("export: the protocols \"{}\" and \"{}\" would share the folder "
                                   "{}; export one at a time with --protocol",
                                   owner->second, id, folder));
    selection.protocol_id = id;
    selection.folder = (fs::path(directory) / folder).string();
    list.push_back(std::move(selection));
  }
  return list;
}

}  // namespace

CsvColumns csv_columns(const ProtocolSelection& selection) {
  return {trial_columns(selection.factors),
          interval_columns(),
          event_columns(),
          session_columns(),
          self_test_columns(),
          answer_columns(),
          friction_columns(),
          program_columns(),
          estimate_columns()};
}

void for_each_row(Database& database, const ProtocolSelection& selection, const CsvColumns& columns,
                  const CsvRows& rows) {
  for (const auto& session : selection.sessions) {
    const auto stored = read_session(database, session);
    const auto spans = stimulus_spans(stored);
    ExportRow session_cells{&stored.session};
    session_cells.self_test = newest_self_test(stored);
    rows.sessions(cells_of(columns.sessions, session_cells));
    for (const auto& block : stored.blocks)
      for (std::size_t i = 0; i < block.trials.size(); ++i) {
        const auto& trial = block.trials[i];
        ExportRow row{&stored.session, &block.start, &trial};
        row.span = span_of(spans, trial);
        row.previous = previous_trial(block, i);
        rows.trials(cells_of(columns.trials, row));
        for (const auto& tone : trial.tones) {
          row.tone = &tone;
          rows.intervals(cells_of(columns.intervals, row));
        }
      }
    for (const auto& event : in_order_of_time(stored.events)) {
      const auto& segment = stored.segments.at(static_cast<std::size_t>(event.segment_index) - 1);
      ExportRow row{&stored.session, nullptr, nullptr, nullptr, &event, segment.monotonic_ns};
      rows.events(cells_of(columns.events, row));
      for (const auto& check : event.checks) {
        row.check = &check;
        rows.self_tests(cells_of(columns.self_tests, row));
      }
      for (const auto& level : event.friction_levels) {
        row.level = &level;
        rows.friction_tables(cells_of(columns.friction_tables, row));
      }
      for (const auto& program : event.programs) {
        row.program = &program;
        rows.programs(cells_of(columns.programs, row));
      }
      for (const auto& estimate : event.estimates) {
        row.estimate = &estimate;
        rows.estimates(cells_of(columns.estimates, row));
      }
    }
    for (const auto* event : core::standing_answers(stored.events)) {
      const auto& segment = stored.segments.at(static_cast<std::size_t>(event->segment_index) - 1);
      ExportRow row{&stored.session, nullptr, nullptr, nullptr, event, segment.monotonic_ns};
      for (const auto& answer : event->answers) {
        row.answer = &answer;
        rows.answers(cells_of(columns.answers, row));
      }
    }
  }
}

void export_csv(Database& database, const ProtocolSelection& selection, const TableStyle& style,
                std::vector<ExportedFile>& files) {
  const auto columns = csv_columns(selection);
  const auto table = [&](const char* name, const ExportColumns& all) {
    return TableFile(selection.folder + "/" + name, style, names_of(all));
  };
  auto trials = table("trials.csv", columns.trials), intervals = table("intervals.csv", columns.intervals),
       events = table("events.csv", columns.events), sessions = table("sessions.csv", columns.sessions),
       checks = table("self_tests.csv", columns.self_tests), answers = table("answers.csv", columns.answers),
       friction = table("friction_tables.csv", columns.friction_tables),
       programs = table("programs.csv", columns.programs),
       estimates = table("estimates.csv", columns.estimates);
  const auto into = [](TableFile& file) {
    return [&file](const std::vector<Cell>& cells) { file.row(cells); };
  };
  for_each_row(database, selection, columns,
               {into(trials), into(intervals), into(events), into(sessions), into(checks), into(answers),
                into(friction), into(programs), into(estimates)});
  for (auto* file : {&trials, &intervals, &events, &sessions}) file->finish(files);
  write_file(selection.folder + "/codebook.json", codebook_json(selection.protocol_id, selection.factors));
  files.push_back({selection.folder + "/codebook.json", 0});
  checks.finish(files);
  answers.finish(files);
  friction.finish(files);
  programs.finish(files);
  estimates.finish(files);
}

/// Refuses to write over sessions that are not part of this export, unless they were withdrawn.
void check_csv_folder(Database& database, const ProtocolSelection& selection) {
  const auto list = selection.folder + "/sessions.csv";
  if (!file_exists(list)) return;
  std::ifstream file(list, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  // The columns may be separated by any character; session ids are UUIDs, which are found anywhere.
  static const std::regex uuid("[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}");
  std::set<std::string> lost;
  for (std::sregex_iterator found(text.begin(), text.end(), uuid), end; found != end; ++found)
    lost.insert(found->str());
  for (const auto& session : selection.sessions) lost.erase(session.session_id);
  for (const auto& withdrawn : list_tombstones(database)) lost.erase(withdrawn.session_id);
  if (!lost.empty())
    throw StoreError(
        ErrorKind::conflict,
        fmt::format("export: {} has {} sessions that are not part of this export, such as {}; export "
                    "all sessions of the protocol from their database, or name an empty folder",
                    selection.folder, lost.size(), *lost.begin()));
}

SelectedSessions select_for_export(const std::string& path, const std::string& directory,
                                   const ExportOptions& options) {
  SelectedSessions selected{open_reader(path), {}};
  check_pages(selected.database);
  selected.database.execute("BEGIN");
  selected.protocols = select(selected.database, directory, options);
  if (selected.protocols.empty())
    throw StoreError(
        ErrorKind::missing,
        fmt::format(
            "export: no session in {} matches these options; `turnpoint sessions --db {}` lists all sessions",
            path, path));
  return selected;
}

std::vector<ExportedFile> export_data(const std::string& path, const std::string& directory,
                                      const ExportOptions& options) {
  check_style(options);
  auto [database, selections] = select_for_export(path, directory, options);
  std::vector<ExportedFile> files;
  if (options.format == ExportFormat::signals) keep_with_signals(database, selections);
  std::vector<FolderLock> locks;
  for (const auto& selection : selections) locks.emplace_back(selection.folder);
  // Before anything is written, check all folders.
  for (const auto& selection : selections) {
    if (options.format == ExportFormat::csv) check_csv_folder(database, selection);
    if (options.format == ExportFormat::bids) check_bids_folder(selection);
    if (options.format == ExportFormat::signals) check_signals_folder(database, selection);
  }
  for (const auto& selection : selections) {
    // Mark the folder as incomplete. Until the last file is written, old and new files may be mixed in it.
    const auto mark = selection.folder + "/EXPORT-INCOMPLETE.txt";
    write_file(mark, "An export into this folder did not finish. Export again.\n");
    const TableStyle style{TableStyle::Kind::rfc4180, options.separator, options.decimal,
                           options.byte_order_mark};
    switch (options.format) {
      case ExportFormat::csv:
        export_csv(database, selection, style, files);
        break;
      case ExportFormat::bids:
        export_bids(database, selection, files);
        break;
      case ExportFormat::signals:
        export_signals(database, selection, style, files);
        break;
    }
    sync_path(selection.folder);
    remove_file(mark);
  }
  return files;
}

}  // namespace turnpoint::store
