#include "tests/collector/exported.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "station/store/export.hpp"
#include "tests/store/sample.hpp"

using namespace turnpoint;

std::map<std::string, std::string> exported(const std::string& database, const std::string& folder,
                                            const store::SessionFilter& filter) {
  for (const auto format :
       {store::ExportFormat::csv, store::ExportFormat::bids, store::ExportFormat::signals}) {
    store::ExportOptions options{filter.session_id, filter.participant, filter.protocol_id};
    options.format = format;
    store::export_data(database, fmt::format("{}/{}", folder, static_cast<int>(format)), options);
  }
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder)] = sample::bytes_of(entry.path());
  return files;
}
