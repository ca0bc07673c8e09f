#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "station/core/read_file.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/report/document.hpp"
#include "station/report/stored_estimates.hpp"
#include "station/report/stored_trials.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/replaced.hpp"

namespace turnpoint {

/// The text of a shipped protocol.
inline std::string shipped(const std::string& name) {
  return core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + name + ".toml");
}

/// The data of a simulated session, for a report.
inline report::SessionData data_of(const std::string& source, const std::string& observer = "sim",
                                   int sequence_index = 0) {
  const auto protocol = protocol::parse(source, "p.toml");
  const auto rehearsal = rehearsal::rehearse(
      protocol, sequence_index, 5, rehearsal::rehearser(simulation::Observer(simulation::parse(observer))));
  report::SessionData data;
  report::add_trials(rehearsal.blocks, protocol, data);
  report::add_estimates(rehearsal.blocks, protocol, 5, {}, data);
  data.replicates = 40;
  return data;
}

inline nlohmann::json report_of(const report::SessionData& data) {
  return nlohmann::json::parse(report::to_json(report::summarise(data)));
}

}  // namespace turnpoint
