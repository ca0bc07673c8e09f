#pragma once
#include <string>
#include <vector>

#include "station/store/export.hpp"
#include "station/store/read.hpp"
#include "station/store/text_table.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::store {

/// The sessions of one protocol that are to be exported, and the columns of its factors.
struct ProtocolSelection {
  /// folder: where the files of this protocol are written; ends without a slash
  std::string protocol_id, folder;
  std::vector<std::string> factors;
  std::vector<SessionRecord> sessions;
};

/// Writes a file by way of a temporary one, so that readers see either the old or the new bytes. Creates the
/// folder. Throws StoreError.
void write_file(const std::string& path, const std::string& bytes);

/// Writes a table of any length row by row, by way of a temporary file.
class TableFile {
 public:
  TableFile(const std::string& path, const TableStyle& style, const std::vector<std::string>& columns);
  void row(const std::vector<Cell>& cells);
  /// Gives the file its final name and adds it to `files`.
  void finish(std::vector<ExportedFile>& files);

 private:
  std::string path_;
  TextTable table_;
  system::FileWriter file_;
};

/// Write the sessions of one protocol as CSV files, or as a BIDS data set.
void export_csv(Database& database, const ProtocolSelection& selection, const TableStyle& style,
                std::vector<ExportedFile>& files);
void export_bids(Database& database, const ProtocolSelection& selection, std::vector<ExportedFile>& files);

}  // namespace turnpoint::store
