#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "station/core/number.hpp"
#include "station/follow/pattern.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/interludes.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

/// True if the first bytes of the file are those of a PNG or JPEG file.
bool is_picture(const std::string& path) {
  std::string start(4, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), 4);
  return file && (start == "\x89PNG" || start.substr(0, 3) == "\xFF\xD8\xFF");
}

/// Reads a column of numbers from 0 to 1, whose first line may be a title.
std::vector<double> read_samples(const std::string& text, const std::string& path, core::Findings& findings) {
  std::vector<double> samples;
  std::istringstream lines{std::string(core::without_byte_order_mark(text))};
  int line = 0;
  for (std::string said; std::getline(lines, said);) {
    ++line;
    while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back()))) said.pop_back();
    said.erase(0, said.find_first_not_of(" \t"));
    const auto value = core::read_number(said);
    if (said.empty() || (line == 1 && !value)) continue;
    if (!value || !(*value >= 0 && *value <= 1)) {
      findings.add({path, line, 1}, phrase("\"%1\" is not a number from 0 to 1", {plain(said)}),
                   phrase("one number in each line, with a decimal point; the first line may be a title"));
      return {};
    }
    samples.push_back(*value);
  }
  if (samples.size() < 2 || samples.size() > static_cast<std::size_t>(follow::kTableSamples))
    findings.add({path, 0, 0}, phrase("the file has %1 numbers", {plain(samples.size())}),
                 phrase("allowed: 2 to %1", {plain(follow::kTableSamples)}));
  return samples;
}

/// The parts of scenes that name a file with their samples, in the order of the text.
std::vector<const core::Part*> files_of_samples(const core::Part& document) {
  std::vector<const core::Part*> files;
  const auto* scenes = document.find("scene");
  if (scenes == nullptr) return files;
  for (const auto& scene : scenes->parts) {
    const auto* follow = scene.find("follow");
    const auto* parts = follow != nullptr ? follow->find("parts") : nullptr;
    if (parts == nullptr) continue;
    for (const auto& part : parts->parts)
      if (const auto* file = part.find("samples_file"); file != nullptr &&
                                                        file->scalar.kind == core::Value::Kind::string &&
                                                        part.find("samples") == nullptr)
        files.push_back(file);
  }
  std::ranges::sort(files, {}, [](const auto* file) { return file->key.begin; });
  return files;
}

/// The text with the numbers of each file in place of its name, so that a session stores all of it. Lines
/// keep their numbers. Throws BadInput.
std::string with_samples(const std::string& source, const std::string& path) {
  if (source.find("samples_file") == std::string::npos) return source;
  const auto document = core::parts_of(source, path);
  core::Findings findings;
  std::string text, origins;
  std::size_t copied = 0;
  for (const auto* part : files_of_samples(document)) {
    const auto& name = part->scalar.string;
    const auto file = (std::filesystem::path(path).parent_path() / name).string();
    std::string content;
    try {
      content = core::read_text_file(file);
    } catch (const std::exception&) {
      findings.add(part->scalar.place, phrase("the file %1 cannot be read", {plain(file)}),
                   phrase("write a path relative to the protocol file"));
      continue;
    }
    std::string list;
    for (const double sample : read_samples(content, file, findings))
      list += (list.empty() ? "" : ", ") + fmt::format("{}", sample);
    text += source.substr(copied, part->key.begin - copied) + "samples = [" + list + "]";
    copied = part->value.end;
    origins += fmt::format("# samples of line {}: {}, SHA-256 {}\n", part->line, name, core::sha256(content));
  }
  findings.throw_if_any();
  text += source.substr(copied);
  if (!text.ends_with('\n')) text += '\n';
  return text + origins;
}

}  // namespace

Protocol parse(const std::string& given, const std::string& path) {
  const auto source = with_samples(given, path);
  const auto document = core::parse_toml(source, path);
  core::Findings findings;
  Protocol protocol;
  protocol.path = path, protocol.source = source, protocol.sha256 = core::sha256(source);
  const KeyPlaces places(document, path);
  Reading reading{protocol, findings, places, {}};
  core::TableReader file(document, "", findings, protocol_keys());
  read_header(file, reading);
  read_factors(file, reading);
  read_scenes(file, reading);
  read_instructions(file, reading);
  read_task(file, reading);
  read_timing(file, reading);
  read_payoff(file, reading);
  read_procedures(file, reading);
  read_sessions(file, reading);
  read_plan(file, reading);
  read_interludes(file, reading);
  read_analysis(file, reading);
  read_exclusion(file, reading);
  read_triggers(file, reading);
  read_sensing(file, reading);
  read_resume(file, reading);
  check_whole(file, reading);
  check_visits(reading);
  file.finish();
  findings.throw_if_any();
  protocol.defaults_used = findings.defaults_used;
  protocol.by_task.clear();
  if (!reading.tasks.empty()) {
    auto all = as_tasks_see(reading);
    for (auto& one : all) one.meanings = meanings_of(one);
    protocol.task = reading.tasks.front();
    protocol.by_task = std::move(all);
  }
  protocol.meanings = protocol.by_task.empty() ? meanings_of(protocol) : meanings_of_tasks(protocol);
  return protocol;
}

Protocol load(const std::string& path) {
  auto protocol = parse(core::read_text_file(path), path);
  core::Findings findings;
  for (const auto& picture : pictures(protocol))
    if (!is_picture(picture.path))
      findings.add(picture.place,
                   phrase("the picture %1 does not exist, or is neither PNG nor JPEG", {plain(picture.path)}),
                   phrase("write a path relative to the protocol file"));
  findings.throw_if_any();
  return protocol;
}

}  // namespace turnpoint::protocol
