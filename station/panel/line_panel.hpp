#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "station/panel/buttons.hpp"
#include "station/panel/edge_filter.hpp"
#include "station/panel/lines.hpp"

namespace turnpoint::panel {

/// Which lines are watched: buttons first, in order, then perhaps the contact.
struct LinePanel {
  std::vector<LineRequest> requests;
  std::vector<std::string> names;  ///< of each line: "left", "right", "contact"
  int lines = 0;
  int contact = -1;                               ///< index of the contact line
  bool buttons_low = false, contact_low = false;  ///< active level
  EdgeFilter::Rules button_rules, contact_rules;
};

/// open_panel() on lines that `request` gives for those that the rig names.
using RequestLines = std::function<std::unique_ptr<Lines>(const std::vector<LineRequest>&)>;
std::unique_ptr<Panel> open_panel(const std::optional<ButtonsConfig>& buttons,
                                  const std::optional<ContactConfig>& contact, PanelHandlers handlers,
                                  const RequestLines& request);

/// A panel on lines, kernel or simulated. Throws what `open` throws at the start.
std::unique_ptr<Panel> watch_lines(OpenLines open, const LinePanel& plan, PanelHandlers handlers);

}  // namespace turnpoint::panel
