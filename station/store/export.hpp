#pragma once
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

enum class ExportFormat { csv, bids, signals };

struct ExportOptions {
  /// which sessions to export; "" does not restrict the choice
  std::string session_id, participant, protocol_id;
  ExportFormat format = ExportFormat::csv;
  char separator = ',';
  char decimal = '.';
  bool byte_order_mark = false;  ///< only for ExportFormat::csv
};

struct ExportedFile {
  std::string path;
  std::size_t rows = 0;
};

/// Writes one folder per protocol below `directory`, with trials.csv, intervals.csv, events.csv, sessions.csv
/// and codebook.json (or the BIDS set, or signals.csv with compressed tables of all signals). It opens the
/// database for reading only. The same data give the same bytes. During the export, and after an interrupted
/// export, the folder contains EXPORT-INCOMPLETE.txt. Throws StoreError.
std::vector<ExportedFile> export_data(const std::string& database, const std::string& directory,
                                      const ExportOptions& options);

}  // namespace turnpoint::store
