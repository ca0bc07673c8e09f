#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "station/store/export.hpp"
#include "station/store/export_tables.hpp"
#include "station/store/read.hpp"
#include "station/store/sqlite.hpp"
#include "station/store/text_table.hpp"
#include "station/system/write_file.hpp"

struct z_stream_s;

namespace turnpoint::store {

/// Compresses a text piece by piece into the format of gzip files (RFC 1952). The file contains neither a
/// name nor a time, so that the same text gives the same bytes.
class Gzip {
 public:
  Gzip();
  /// Returns the bytes that are ready to be written; often none.
  std::string add(std::string_view text);
  /// Returns the remaining bytes. Nothing can be added afterwards.
  std::string finish();

 private:
  std::string compressed(std::string_view text, int flush);

  struct End {
    void operator()(z_stream_s* stream) const;
  };
  std::unique_ptr<z_stream_s, End> stream_;
};

/// The sessions of one protocol that are exported, and the columns of the protocol's factors.
struct ProtocolSelection {
  /// `folder`: the folder for the files of this protocol, without a slash at the end
  std::string protocol_id, folder;
  std::vector<ExportedFactor> factors;
  std::vector<SessionRecord> sessions;
};

/// The sessions that an export or a reader takes from a database, read from one snapshot even if a running
/// session adds rows meanwhile.
struct SelectedSessions {
  Database database;
  std::vector<ProtocolSelection> protocols;
};

/// Opens the database and chooses the sessions. Throws StoreError, also if there are none.
SelectedSessions select_for_export(const std::string& database, const std::string& directory,
                                   const ExportOptions& options);

/// The columns of each exported table of a protocol.
struct CsvColumns {
  ExportColumns trials, intervals, events, sessions, self_tests, answers, friction_tables, programs,
      estimates;
};
CsvColumns csv_columns(const ProtocolSelection& selection);

/// For each table, a function that receives its rows one by one.
struct CsvRows {
  std::function<void(const std::vector<Cell>&)> trials, intervals, events, sessions, self_tests, answers,
      friction_tables, programs, estimates;
};
void for_each_row(Database& database, const ProtocolSelection& selection, const CsvColumns& columns,
                  const CsvRows& rows);

/// Makes the name of a file or folder from any text, such as a protocol's id. Characters that could lead out
/// of the folder are replaced.
std::string file_name_of(const std::string& text);

/// Writes the bytes to a temporary file and renames it, so that readers see either the old or the new bytes.
/// Creates the folder if necessary. Throws StoreError.
void write_file(const std::string& path, const std::string& bytes);

/// Writes a table of any length, row by row, to a temporary file. A file whose name ends in .gz is
/// compressed.
class TableFile {
 public:
  enum class Header { written, left_out };
  TableFile(const std::string& path, const TableStyle& style, const std::vector<std::string>& columns,
            Header header = Header::written);
  void row(const std::vector<Cell>& cells);
  /// Gives the temporary file its final name and adds the file to `files`.
  void finish(std::vector<ExportedFile>& files);

 private:
  void write_piece();

  std::string path_;
  TextTable table_;
  system::FileWriter file_;
  std::unique_ptr<Gzip> gzip_;  ///< null if the file is not compressed
};

/// Removes the sessions without stored signals, and then the protocols without sessions. Throws StoreError
/// (missing) if nothing is left.
void keep_with_signals(Database& database, std::vector<ProtocolSelection>& selections);

/// Keeps other exports out of a folder until it is destroyed; waits for one that is running. Creates the
/// folder if necessary. On a disk without locks it does nothing; the files of the exports are still whole
/// then, each by itself. Throws StoreError.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);

 private:
  core::FileDescriptor folder_;
};

/// These functions throw StoreError (conflict) if the folder has an earlier export with sessions that are not
/// part of this one. They change nothing. A part of the sessions, or those of another database, would
/// otherwise replace all of them, and readers would take the files of the other sessions for part of this
/// export. Sessions that were withdrawn from the database may disappear from CSV tables.
void check_csv_folder(Database& database, const ProtocolSelection& selection);
void check_bids_folder(const ProtocolSelection& selection);
void check_signals_folder(Database& database, const ProtocolSelection& selection);

/// These functions write the sessions of one protocol: as CSV files, as a BIDS data set, or their signals.
void export_csv(Database& database, const ProtocolSelection& selection, const TableStyle& style,
                std::vector<ExportedFile>& files);
void export_bids(Database& database, const ProtocolSelection& selection, std::vector<ExportedFile>& files);
void export_signals(Database& database, const ProtocolSelection& selection, const TableStyle& style,
                    std::vector<ExportedFile>& files);

/// One run of a BIDS data set: a segment of a session. `task` describes the protocol.
struct BidsRun {
  const std::string& session_id;
  int segment = 1;
  const SessionStart& task;
};

/// Writes the signals of a run as BIDS recordings: BASE_recording-NAME_physio.tsv.gz with its sidecar file,
/// or nothing if there are no signals.
void export_bids_signals(Database& database, const BidsRun& run, const std::string& base,
                         std::vector<ExportedFile>& files);

}  // namespace turnpoint::store
