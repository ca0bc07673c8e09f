#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"
#include "station/text/number.hpp"

namespace turnpoint::protocol {

Protocol parse(const std::string& source, const std::string& path) {
  const auto document = text::parse_toml(source, path);
  text::Findings findings;
  Protocol protocol;
  protocol.path = path, protocol.source = source, protocol.sha256 = text::sha256(source);
  const KeyPlaces places(document, path);
  Reading reading{protocol, findings, places, {}};
  text::TableReader file(document, "", findings);
  read_header(file, reading);
  read_factors(file, reading);
  read_scenes(file, reading);
  read_instructions(file, reading);
  read_task(file, reading);
  read_timing(file, reading);
  read_procedures(file, reading);
  read_plan(file, reading);
  read_analysis(file, reading);
  read_exclusion(file, reading);
  read_triggers(file, reading);
  read_sensing(file, reading);
  read_resume(file, reading);
  check_whole(file, reading);
  file.finish();
  findings.throw_if_any();
  protocol.defaults_used = findings.defaults_used;
  return protocol;
}

Protocol load(const std::string& path) { return parse(text::read_text_file(path), path); }

}  // namespace turnpoint::protocol
