#pragma once
#include <string>
#include <vector>

#include "station/store/export.hpp"
#include "station/store/read.hpp"
#include "station/store/text_table.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::store {

/// The sessions of one protocol that are exported, and the columns of the protocol's factors.
struct ProtocolSelection {
  /// `folder`: the folder for the files of this protocol, without a slash at the end
  std::string protocol_id, folder;
  std::vector<std::string> factors;
  std::vector<SessionRecord> sessions;
};

/// Writes the bytes to a temporary file and renames it, so that readers see either the old or the new bytes.
/// Creates the folder if necessary. Throws StoreError.
void write_file(const std::string& path, const std::string& bytes);

/// Writes a table of any length, row by row, to a temporary file.
class TableFile {
 public:
  TableFile(const std::string& path, const TableStyle& style, const std::vector<std::string>& columns);
  void row(const std::vector<Cell>& cells);
  /// Gives the temporary file its final name and adds the file to `files`.
  void finish(std::vector<ExportedFile>& files);

 private:
  std::string path_;
  TextTable table_;
  system::FileWriter file_;
};

/// These functions write the sessions of one protocol as CSV files or as a BIDS data set.
void export_csv(Database& database, const ProtocolSelection& selection, const TableStyle& style,
                std::vector<ExportedFile>& files);
void export_bids(Database& database, const ProtocolSelection& selection, std::vector<ExportedFile>& files);

}  // namespace turnpoint::store
