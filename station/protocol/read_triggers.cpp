#include <algorithm>
#include <map>

#include "station/core/number.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/triggers.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::TableReader;

namespace {

TriggerEvent event_of(const std::string& word) {
  const auto words = trigger_event_names();
  const auto found = std::find(words.begin(), words.end(), word);
  return static_cast<TriggerEvent>(found == words.end() ? 0 : found - words.begin());
}

void read_send(TableReader& reader, Triggers& triggers) {
  if (!reader.has("send")) {
    return reader.defaulted("send", reader.declared("send").fallback);
  }
  triggers.send.clear();
  const auto& events = reader.words("send");
  for (const auto& word : reader.maybe_strings("send")) {
    if (std::find(events.begin(), events.end(), word) == events.end())
      reader.problem("send", phrase("\"%1\" has \"%2\"", {plain("send"), plain(word)}),
                     phrase("allowed: %1", {core::quoted_list(events)}));
    else if (std::find(triggers.send.begin(), triggers.send.end(), event_of(word)) != triggers.send.end())
      reader.problem("send", phrase("\"%1\" appears twice in \"%2\"", {plain(word), plain("send")}),
                     phrase("list each event only once"));
    else
      triggers.send.push_back(event_of(word));
  }
}

void read_code(const core::Value& table, Reading& reading) {
  TableReader reader(table, "triggers.code", reading.findings, keys_of("triggers.code"));
  TriggerCode code;
  code.event = event_of(reader.word("event"));
  const auto known = conditions(reading.protocol);
  code.condition = reader.maybe_string("condition").value_or("");
  if (!code.condition.empty() && std::find(known.begin(), known.end(), code.condition) == known.end())
    reader.problem(
        "condition", phrase("there is no condition \"%1\"", {plain(code.condition)}),
        known.empty()
            ? phrase(
                  "leave out \"condition\": no factor is in [analysis] %1, and no block has an instruction",
                  {plain("\"by\"")})
            : core::suggestion(code.condition, known));
  code.code = reader.integer("code");
  const auto& send = reading.protocol.triggers.send;
  if (std::find(send.begin(), send.end(), code.event) == send.end())
    reader.problem("event", phrase("\"%1\" is not in \"send\"", {plain(name(code.event))}),
                   phrase("add it to \"send\" in [triggers]"));
  reader.finish();
  reading.protocol.triggers.stated.push_back(code);
}

std::string described(const TriggerCode& code) {
  return std::string(name(code.event)) + (code.condition.empty() ? "" : " (" + code.condition + ")");
}

/// Reports two events with the same code, because a recorder could not tell them apart.
void check_unique(TableReader& reader, const Reading& reading) {
  std::map<int, TriggerCode> seen;
  for (const auto& code : trigger_codes(reading.protocol)) {
    const auto [first, fresh] = seen.emplace(code.code, code);
    if (!fresh)
      reader.problem(
          "code",
          phrase("the code %1 stands for %2 and for %3",
                 {plain(core::number(code.code)), plain(described(first->second)), plain(described(code))}),
          phrase("give each event of each condition its own code"));
  }
}

}  // namespace

void read_triggers(TableReader& file, Reading& reading) {
  const auto* table = file.maybe_table("triggers");
  if (!table) return;
  TableReader reader(*table, "triggers", reading.findings, file.keys("triggers"));
  reading.protocol.triggers.place = table->place;
  read_send(reader, reading.protocol.triggers);
  for (const auto* code : reader.tables("code")) read_code(*code, reading);
  check_unique(reader, reading);
  reader.finish();
}

}  // namespace turnpoint::protocol
