#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/store/export_tables.hpp"
#include "station/store/names.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// Returns the names of a session's streams (sources of signals), in alphabetical order.
std::vector<std::string> signal_streams(Database& database, const std::string& session_id);

/// All channels that signals of this stream have in the session, in the order in which they first occur.
std::vector<SignalChannel> signal_channels(Database& database, const std::string& session_id,
                                           const std::string& stream);

/// A stored signal, with the trial and the segment (run of the program) to which it belongs.
struct StoredSignal {
  int trial_index = 0, segment_index = 0;
  SignalRow row;
};

/// Reads the signals of one stream of a session one by one, in the order of their trials.
class SignalReader {
 public:
  /// Reads only the trials of `segment` (a run of the program) if one is given.
  SignalReader(Database& database, const std::string& session_id, const std::string& stream,
               std::optional<int> segment = {});
  std::optional<StoredSignal> next();

 private:
  Statement rows_;
};

/// Frames per second of the playback in a session, from its rig file; empty if the file cannot be read.
std::optional<double> playback_rate_Hz(const SessionStart& start);

/// Returns, for each channel of the signal, its index in `channels`.
std::vector<std::size_t> places_of(const SignalRow& signal, const std::vector<SignalChannel>& channels);

/// Name and explanation of a channel in exports; the name includes the unit, such as normal_n or speed_mm_s.
Column signal_column(const SignalChannel& channel);
std::vector<Column> signal_columns(const std::vector<SignalChannel>& channels);

}  // namespace turnpoint::store
