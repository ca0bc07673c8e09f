#pragma once
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

enum class ExportFormat { csv, bids };

struct ExportOptions {
  std::string session_id, participant, protocol_id;  ///< "" takes all
  ExportFormat format = ExportFormat::csv;
  char separator = ',';
  char decimal = '.';
};

struct ExportedFile {
  std::string path;
  std::size_t rows = 0;
};

/// Writes one folder a protocol below `directory`: trials.csv, intervals.csv, events.csv, sessions.csv and
/// codebook.json (or the BIDS set). Reads SQLite only, through a read-only connection; the same data give the
/// same bytes. While it lasts, and after one that was interrupted, a folder holds EXPORT-INCOMPLETE.txt.
/// Throws StoreError.
std::vector<ExportedFile> export_data(const std::string& database, const std::string& directory,
                                      const ExportOptions& options);

}  // namespace turnpoint::store
