#pragma once
#include <string>
#include <vector>

#include "station/store/export.hpp"
#include "station/store/read.hpp"
#include "station/store/text_table.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::store {

/// All sessions of one protocol that are exported, and the columns of its factors.
struct ProtocolSelection {
  std::string protocol_id, folder;  ///< folder: where its files are written; ends without a slash
  std::vector<std::string> factors;
  std::vector<SessionRecord> sessions;
};

/// Writes a file by way of a temporary one, so that readers see either the old or the new bytes. Creates the
/// folder. Throws StoreError.
void write_file(const std::string& path, const std::string& bytes);

/// The same for a table of any length, written row by row.
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

/// The two formats.
void export_csv(Database& database, const ProtocolSelection& selection, const TableStyle& style,
                std::vector<ExportedFile>& files);
void export_bids(Database& database, const ProtocolSelection& selection, std::vector<ExportedFile>& files);

}  // namespace turnpoint::store
