#pragma once
#include <string>
#include <vector>

#include "station/session/page.hpp"

namespace turnpoint::ui {

/// A page as some session would show it, under the name of its screenshot.
struct Exhibit {
  std::string name;
  session::Page page;
};

/// Every kind of page, with texts as long as real protocols have them. Languages: en, de, ja.
std::vector<Exhibit> gallery(const std::string& language);

}  // namespace turnpoint::ui
