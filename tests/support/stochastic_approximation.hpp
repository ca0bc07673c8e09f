#pragma once
#include <stdexcept>
#include <string>
#include <utility>

#include "station/core/read_file.hpp"

/// Returns the shipped staircase protocol, with both of its staircases replaced by accelerated stochastic
/// approximation of 20 trials each.
inline std::string stochastic_approximation() {
  auto source =
      turnpoint::core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/friction-staircase.toml");
  const std::pair<std::string, std::string> edits[] = {
      {"kind = \"up-down\"", "kind = \"accelerated-stochastic-approximation\"\ntarget = 0.794"},
      {"n_down = 3 ", "# "},
      {"n_up = 1 ", "# "},
      {"initial_down = 1 ", "# "},
      {"step = [4.0, 2.0, 1.0]", "step = 8.0"},
      {"stop = { reversals = 10, trials = 60, rule = \"or\" }", "stop = { trials = 20 }"}};
  for (const auto& [from, to] : edits) {
    const auto at = source.find(from);
    if (at == std::string::npos) throw std::logic_error("the shipped protocol has no " + from);
    source.replace(at, from.size(), to);
  }
  return source;
}
