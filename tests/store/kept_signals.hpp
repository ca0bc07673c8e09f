#pragma once
#include <cstring>
#include <vector>

#include "station/store/fields.hpp"
#include "tests/store/sample.hpp"

namespace sample {

/// The number of trials from 0 to before `acknowledged` whose signal in the database is not, sample by
/// sample, the one that answered() has given to the trial. Missing samples (NaN) must be missing in both.
inline int wrong_signals(Database& database, int acknowledged) {
  static std::vector<SignalRow> written;
  static std::vector<std::vector<std::vector<double>>> values;
  while (static_cast<int>(written.size()) < acknowledged) {
    written.push_back(answered(static_cast<int>(written.size())).signal_rows.at(0));
    values.push_back(decode(written.back()));
  }
  const auto equal = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  const auto is_kept = [&](const SignalRow& row, std::size_t trial) {
    const auto& as_written = written[trial];
    if (row.stream != as_written.stream || row.start_frame != as_written.start_frame ||
        row.rate_Hz != as_written.rate_Hz || row.channels != as_written.channels)
      return false;
    const auto stored = decode(row);
    return std::equal(stored.begin(), stored.end(), values[trial].begin(), values[trial].end(),
                      [&](const auto& a, const auto& b) {
                        return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
                      });
  };
  int wrong = 0;
  Statement rows(database, "SELECT " + column_list(signal_table()) + " FROM signal WHERE trial_index = ?");
  for (int trial = 0; trial < acknowledged; ++trial) {
    rows.bind(trial);
    try {
      const bool kept =
          rows.step() && is_kept(record_of(rows, signal_table()), static_cast<std::size_t>(trial));
      if (!kept || rows.step()) ++wrong;
    } catch (const StoreError&) {
      ++wrong;
    }
  }
  return wrong;
}

}  // namespace sample
