#include "station/store/export_bids_texts.hpp"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>

#include "station/text/toml.hpp"

namespace turnpoint::store {

namespace {

using Json = nlohmann::ordered_json;

/// Reads a text of the protocol, which is a string, or a table with one string per language.
std::string text_of(const text::Value* value, const std::string& language) {
  if (value == nullptr) return "";
  if (value->kind == text::Value::Kind::string) return value->string;
  if (value->kind != text::Value::Kind::table || value->entries.empty()) return "";
  const auto* found = value->find(language) == nullptr ? &value->entries.front() : value->find(language);
  return found->value.string;
}

const text::Value* at(const text::Value& table, const std::string& key) {
  const auto* entry = table.find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

/// The texts of a protocol that were stored with its newest session.
struct Texts {
  std::string title, instructions;
};

Texts texts_of(const SessionStart& start) {
  Texts texts;
  try {
    const auto document = text::parse_toml(start.protocol_text, start.protocol_path);
    if (const auto* head = at(document, "protocol"))
      texts.title = text_of(at(*head, "title"), start.language);
    if (const auto* task = at(document, "task")) {
      texts.instructions = text_of(at(*task, "instructions"), start.language);
      const auto question = text_of(at(*task, "question"), start.language);
      if (!question.empty()) texts.instructions += (texts.instructions.empty() ? "" : "\n") + question;
    }
  } catch (const text::BadInput&) {
    // Leave out texts that this release can no longer read. The data are exported anyway.
  }
  if (texts.title.empty()) texts.title = start.protocol_id;
  return texts;
}

}  // namespace

std::string bids_label(const std::string& text) {
  std::string letters;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) letters += c;
  return letters;
}

std::string bids_description(const ProtocolSelection& selection) {
  Json json;
  json["Name"] = selection.protocol_id;
  json["BIDSVersion"] = "1.9.0";
  json["DatasetType"] = "raw";
  json["License"] = "n/a";
  json["Authors"] = {"n/a"};
  json["GeneratedBy"] = {
      {{"Name", "Turnpoint"}, {"Version", selection.sessions.back().start.software_version}}};
  return json.dump(2) + "\n";
}

std::string bids_readme(const ProtocolSelection& selection) {
  return fmt::format(
      "Behavioural data of the protocol {}, exported by Turnpoint. Each start of the station program is one "
      "run: a session that was resumed has several runs.\n",
      selection.protocol_id);
}

std::string bids_sidecar(const SessionStart& start, const std::vector<Column>& columns) {
  const auto texts = texts_of(start);
  Json json;
  json["TaskName"] = bids_label(start.protocol_id);
  json["TaskDescription"] = texts.title;
  if (!texts.instructions.empty()) json["Instructions"] = texts.instructions;
  json["StimulusPresentation"] = {{"OperatingSystem", start.kernel},
                                  {"SoftwareName", "Turnpoint"},
                                  {"SoftwareVersion", start.software_version}};
  const auto explained = Json::parse(columns_json(columns));
  for (const auto& [name, column] : explained.items()) json[name] = column;
  return json.dump(2) + "\n";
}

ExportColumns bids_trial_columns(const std::vector<std::string>& factors) {
  auto columns = trial_columns(factors);
  for (auto& [column, cell] : columns)
    if (column.name == "onset" || column.name == "duration") column.name = "stimulus_" + column.name;
  return columns;
}

std::vector<Column> bids_participant_columns() {
  return {{"participant_id", "Label of the participant in this data set", "", ""},
          {"code", "Codes that the stations gave to the participant", "", ""},
          {"sessions", "Number of sessions in this data set", "", ""},
          {"station", "Stations at which the sessions were run", "", ""}};
}

std::vector<Column> bids_event_columns() {
  return {{"onset", "Time of the event, from the start of the run", "s", ""},
          {"duration", "Length of a stimulus; 0 for all other events, which have no duration", "s", ""},
          {"trial_type", "What happened", "", ""},
          {"value", "Detail", "", ""},
          {"trial_index", "Index of the trial in the session, from 0", "", ""}};
}

std::vector<Cell> bids_event_cells(const EventRow& event, std::int64_t origin_ns) {
  return {cell(static_cast<double>(event.time_ns - origin_ns) * 1e-9), cell(event_length_s(event)),
          cell(event.kind), cell(event.value), cell(event.trial_index)};
}

}  // namespace turnpoint::store
