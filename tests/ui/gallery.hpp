#pragma once
#include <string>
#include <vector>

#include "station/session/page.hpp"

namespace turnpoint::ui {

/// A page as a session shows it, and the name of its screenshot.
struct Exhibit {
  std::string name;
  session::Page page;
};

/// One page of every kind, with texts as long as in real protocols. Languages: en, de, ja, ar, zh.
std::vector<Exhibit> gallery(const std::string& language);
/// The same pages of a run that is live, pilot or simulated. The names of the latter two end with "-pilot" or
/// "-simulated".
std::vector<Exhibit> gallery_in_mode(const std::string& language, const std::string& mode);

}  // namespace turnpoint::ui
