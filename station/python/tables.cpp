#include "station/python/tables.hpp"

#include <cmath>
#include <limits>

#include "station/collector/fetch.hpp"
#include "station/store/export_files.hpp"
#include "station/store/signal_code.hpp"
#include "station/store/stored_signals.hpp"

namespace turnpoint::python {

using store::Cell;

namespace {

void add_row(MemoryTable& table, std::vector<Cell> cells) {
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const auto* text = std::get_if<std::string>(&cells[c]);
    if (text != nullptr && text->empty()) cells[c] = Cell{};
    table.cells.at(c).push_back(std::move(cells[c]));
  }
}

MemoryTable empty_table(const std::vector<std::string>& columns) {
  return {columns, std::vector<std::vector<Cell>>(columns.size())};
}

void add_points(SignalTable& table, const store::StoredSignal& stored,
                const std::vector<std::size_t>& places) {
  const auto& signal = stored.row;
  const auto decoded = store::decode(signal);
  const auto points = static_cast<std::size_t>(signal.points);
  const auto before = table.time_s.size();
  table.trial_index.resize(before + points, stored.trial_index);
  table.segment_id.resize(before + points, stored.segment_index);
  for (std::size_t k = 0; k < points; ++k)
    table.time_s.push_back(std::round(1e6 * (signal.start_s + static_cast<double>(k) / signal.rate_Hz)) /
                           1e6);
  for (auto& channel : table.values)
    channel.resize(before + points, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < decoded.size(); ++c)
    std::copy(decoded[c].begin(), decoded[c].end(),
              table.values[places[c]].begin() + static_cast<std::ptrdiff_t>(before));
}

collector::ReadableDatabase readable(const std::string& database, const store::ExportOptions& options) {
  return collector::ReadableDatabase(database,
                                     {options.session_id, options.participant, options.protocol_id});
}

}  // namespace

std::vector<ProtocolTables> read_tables(const std::string& database, const store::ExportOptions& options) {
  const auto copy = readable(database, options);
  auto selected = store::select_for_export(copy.path(), "", options);
  std::vector<ProtocolTables> all;
  for (const auto& selection : selected.protocols) {
    const auto columns = store::csv_columns(selection);
    auto& tables = all.emplace_back(ProtocolTables{
        selection.protocol_id, empty_table(store::names_of(columns.trials)),
        empty_table(store::names_of(columns.intervals)), empty_table(store::names_of(columns.events)),
        empty_table(store::names_of(columns.sessions)), empty_table(store::names_of(columns.self_tests)),
        empty_table(store::names_of(columns.answers)), empty_table(store::names_of(columns.friction_tables)),
        empty_table(store::names_of(columns.programs)), empty_table(store::names_of(columns.estimates))});
    const auto into = [](MemoryTable& table) {
      return [&table](const std::vector<Cell>& cells) { add_row(table, cells); };
    };
    store::for_each_row(selected.database, selection, columns,
                        {into(tables.trials), into(tables.intervals), into(tables.events),
                         into(tables.sessions), into(tables.self_tests), into(tables.answers),
                         into(tables.friction_tables), into(tables.programs), into(tables.estimates)});
  }
  return all;
}

std::vector<SignalTable> read_signals(const std::string& database, const store::ExportOptions& options,
                                      const std::string& stream) {
  const auto copy = readable(database, options);
  auto selected = store::select_for_export(copy.path(), "", options);
  store::keep_with_signals(selected.database, selected.protocols);
  std::vector<SignalTable> all;
  for (const auto& selection : selected.protocols)
    for (const auto& session : selection.sessions) {
      const auto channels = store::signal_channels(selected.database, session.session_id, stream);
      if (channels.empty()) continue;
      auto& table = all.emplace_back(SignalTable{session.session_id, stream, {}, {}, {}, {}, {}});
      for (const auto& column : store::signal_columns(channels)) table.channels.push_back(column.name);
      table.values.resize(channels.size());
      store::SignalReader reader(selected.database, session.session_id, stream);
      while (const auto stored = reader.next())
        add_points(table, *stored, store::places_of(stored->row, channels));
    }
  return all;
}

}  // namespace turnpoint::python
