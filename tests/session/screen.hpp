#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "station/session/session.hpp"

namespace turnpoint {

/// Keeps the pages that a session shows. It can simulate a crash: it throws an exception at the page `cut`.
struct Screen : session::Display {
  std::vector<session::Page> pages;
  int cut;  ///< 0: never
  explicit Screen(int cut_at = 0) : cut(cut_at) {}
  void show(const session::Page& page) override {
    pages.push_back(page);
    if (cut > 0 && static_cast<int>(pages.size()) == cut) throw std::runtime_error("the plug was pulled");
  }
  std::vector<session::Page> titled(const std::string& title) const {
    std::vector<session::Page> found;
    for (const auto& page : pages)
      if (page.title == title) found.push_back(page);
    return found;
  }
};

}  // namespace turnpoint
