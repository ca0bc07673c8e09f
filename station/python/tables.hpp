#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/export.hpp"
#include "station/store/text_table.hpp"

namespace turnpoint::python {

/// A table in memory, column by column.
struct MemoryTable {
  std::vector<std::string> columns;
  std::vector<std::vector<store::Cell>> cells;  ///< indexed by [column][row]
};

/// The tables that export_data() would write for one protocol.
struct ProtocolTables {
  std::string protocol_id;
  MemoryTable trials, intervals, events, sessions, self_tests, answers, friction_tables, programs, estimates;
};

/// Reads into memory what store::export_data() would write with the format csv. Texts that are empty count as
/// missing, as in the files. Unlike in the files, texts that begin with = + - or @ get no apostrophe in
/// front. `database` may be a collector (collector/fetch.hpp). Throws like store::export_data() and
/// collector::ReadableDatabase.
std::vector<ProtocolTables> read_tables(const std::string& database, const store::ExportOptions& options);

/// All points of one stream of a session, such as the finger's forces. The vectors have one value per point.
struct SignalTable {
  std::string session_id, stream;
  std::vector<std::int64_t> trial_index, segment_id;
  /// time of each point from the start of the segment (program run), rounded to 1 us
  std::vector<double> time_s;
  std::vector<std::string> channels;
  std::vector<std::vector<double>> values;  ///< indexed by [channel][point]; NaN where a point is missing
};

/// Reads the signals of one stream that store::export_data() would write in its format "signals". Throws
/// StoreError if the sessions have no signals of any stream.
std::vector<SignalTable> read_signals(const std::string& database, const store::ExportOptions& options,
                                      const std::string& stream);

}  // namespace turnpoint::python
