#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/io/buttons.hpp"
#include "station/io/edge_filter.hpp"
#include "station/io/lines.hpp"

namespace turnpoint::io {

/// The lines to watch: first the buttons in order, then the contact line, if any.
struct WatchedLines {
  std::vector<LineRequest> requests;
  std::vector<std::string> names;  ///< name of each line: "left", "right", "contact"
  int lines = 0;
  int contact = -1;                               ///< index of the contact line; -1 if there is none
  bool buttons_low = false, contact_low = false;  ///< true if the lines are active at low level
  EdgeFilter::Rules button_rules, contact_rules;
};

using RequestLines = std::function<std::unique_ptr<Lines>(const std::vector<LineRequest>&)>;
/// Like open_buttons() in buttons.hpp, but calls `request` to open the lines that the rig names.
std::unique_ptr<Buttons> open_buttons(const std::optional<ButtonsConfig>& buttons,
                                      const std::optional<ContactConfig>& contact, ButtonsHandlers handlers,
                                      const RequestLines& request);

/// Watches buttons on kernel or simulated lines. Throws the errors of `open`.
std::unique_ptr<Buttons> watch_lines(OpenLines open, const WatchedLines& plan, ButtonsHandlers handlers);

}  // namespace turnpoint::io
