#include "station/store/stored_signals.hpp"

#include <algorithm>
#include <cctype>
#include <map>

#include "station/core/letters.hpp"
#include "station/store/fields.hpp"

namespace turnpoint::store {

namespace {

bool same(const SignalChannel& a, const SignalChannel& b) { return a.name == b.name && a.unit == b.unit; }

auto found_in(const std::vector<SignalChannel>& channels, const SignalChannel& channel) {
  return std::find_if(channels.begin(), channels.end(), [&](const auto& one) { return same(one, channel); });
}

const char* meaning_of(const std::string& channel) {
  static const std::map<std::string, const char*> meanings = {
      {"normal", "Force of the finger perpendicular to the surface"},
      {"lateral", "Force of the finger along the surface, positive towards larger positions"},
      {"position",
       "Position of the finger from the wide end of the surface; missing if the finger does not press"},
      {"speed", "Speed of the finger, positive towards larger positions; missing if the position is missing"},
      {"gain",
       "Gain of the drive at this frame, as it was commanded; 1 is as planned; missing between intervals"},
      {"place",
       "Place of the contact, from the wide end of the surface, as predicted for this frame; missing if not "
       "known"},
      {"asked",
       "What the scene asks for at that place: the coefficient of friction, or the displacement (um)"},
      {"commanded", "Coefficient of friction there by the friction table and the commanded envelope"},
      {"felt",
       "Measured coefficient of friction of the newest forces, which were measured `age` earlier; missing if "
       "the "
       "finger does not slide"},
      {"age", "Time from the newest forces to this frame"},
      {"at_rest", "Coefficient of friction of the surface at rest, as the loop estimates it"},
      {"following", "0: the gain rests; 1: the gain follows the finger"},
      {"fault",
       "What keeps the surface from following at this moment: 0 nothing, 1 late, 2 reference, 3 force, 4 "
       "lifted, "
       "5 position, 6 saturated"}};
  if (channel.starts_with("channel_"))
    return "What was captured on this channel, as it came from the converter: 2147483648 is full scale; a "
           "sample of -2147483648 is stored as -2147483647";
  const auto found = meanings.find(channel);
  return found == meanings.end() ? "Channel of this name" : found->second;
}

}  // namespace

std::vector<std::string> signal_streams(Database& database, const std::string& session_id) {
  std::vector<std::string> streams;
  Statement rows(database, "SELECT DISTINCT stream FROM signal WHERE session_id = ? ORDER BY stream");
  rows.bind(session_id);
  while (rows.step()) streams.push_back(rows.text(0));
  return streams;
}

std::vector<SignalChannel> signal_channels(Database& database, const std::string& session_id,
                                           const std::string& stream) {
  std::vector<SignalChannel> all;
  Statement rows(database,
                 "SELECT channels FROM signal WHERE session_id = ? AND stream = ? GROUP BY channels"
                 " ORDER BY min(trial_index)");
  rows.bind(session_id, stream);
  while (rows.step()) {
    std::vector<SignalChannel> channels;
    from_json(rows.text(0), channels);
    for (auto& channel : channels)
      if (found_in(all, channel) == all.end()) all.push_back(std::move(channel));
  }
  return all;
}

SignalReader::SignalReader(Database& database, const std::string& session_id, const std::string& stream,
                           std::optional<int> segment)
    : rows_(database,
            "SELECT " + column_list(signal_table(), "signal.") +
                ", segment_index FROM signal JOIN trial USING (session_id, trial_index)"
                " WHERE signal.session_id = ? AND stream = ? AND segment_index = coalesce(?, segment_index)"
                " ORDER BY signal.trial_index") {
  rows_.bind(session_id, stream, segment);
}

std::optional<StoredSignal> SignalReader::next() {
  if (!rows_.step()) return std::nullopt;
  StoredSignal stored;
  stored.row = record_of(rows_, signal_table());
  stored.trial_index = static_cast<int>(rows_.integer(1));
  stored.segment_index = static_cast<int>(rows_.integer(rows_.columns() - 1));
  return stored;
}

std::vector<std::size_t> places_of(const SignalRow& signal, const std::vector<SignalChannel>& channels) {
  std::vector<std::size_t> places;
  for (const auto& channel : signal.channels)
    places.push_back(static_cast<std::size_t>(found_in(channels, channel) - channels.begin()));
  return places;
}

Column signal_column(const SignalChannel& channel) {
  std::string name;
  for (const char c : channel.unit.empty() ? channel.name : channel.name + "_" + channel.unit) {
    const auto letter = static_cast<unsigned char>(c);
    name += std::isalnum(letter) != 0 ? core::lower(c) : '_';
  }
  return {name, meaning_of(channel.name), channel.unit, ""};
}

std::vector<Column> signal_columns(const std::vector<SignalChannel>& channels) {
  std::vector<Column> columns;
  for (const auto& channel : channels) columns.push_back(signal_column(channel));
  return columns;
}

}  // namespace turnpoint::store
