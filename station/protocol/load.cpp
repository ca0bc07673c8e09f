#include <fstream>

#include "station/core/number.hpp"
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

}  // namespace

Protocol parse(const std::string& source, const std::string& path) {
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
