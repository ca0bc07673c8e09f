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

}  // namespace turnpoint::ui
