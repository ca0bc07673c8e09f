#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/lines/buttons.hpp"
#include "station/lines/edge_filter.hpp"
#include "station/lines/lines.hpp"

namespace turnpoint::lines {

/// The lines to watch: first the buttons in order, then the contact, if any.
struct WatchedLines {
  std::vector<LineRequest> requests;
  std::vector<std::string> names;  ///< for each line: "left", "right", "contact"
  int lines = 0;
  int contact = -1;                               ///< index of the contact line
  bool buttons_low = false, contact_low = false;  ///< active level
  EdgeFilter::Rules button_rules, contact_rules;
};

/// Like open_buttons(), but on lines that `request` provides for those named in the rig.
using RequestLines = std::function<std::unique_ptr<Lines>(const std::vector<LineRequest>&)>;
std::unique_ptr<Buttons> open_buttons(const std::optional<ButtonsConfig>& buttons,
                                      const std::optional<ContactConfig>& contact, ButtonsHandlers handlers,
                                      const RequestLines& request);

/// Buttons on lines, kernel or simulated. Throws what `open` throws at the start.
std::unique_ptr<Buttons> watch_lines(OpenLines open, const WatchedLines& plan, ButtonsHandlers handlers);

}  // namespace turnpoint::lines
