#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/core/problem.hpp"
#include "station/view/document.hpp"

namespace turnpoint::view {

/// The version after this one: its last number raised by one, such as "2" after "1" and "1.3" after "1.2".
std::string next_version(const std::string& version);

/// A protocol file while somebody edits it: its present text, which may be invalid for a while, and the
/// earlier texts, to which the editor can return.
class Draft {
 public:
  Draft(std::string text, std::string file);

  const std::string& text() const { return texts_[now_]; }
  const std::string& file() const { return file_; }
  /// The document made from the text; nullptr while the text is not valid TOML.
  const Document* document() const { return document_ ? &*document_ : nullptr; }
  /// The reasons why the text is not valid TOML; empty if it is.
  const std::vector<core::Problem>& problems() const { return problems_; }

  /// Replaces the whole text. Does nothing if the new text equals the old one.
  void change(std::string text);
  bool can_undo() const { return now_ > 0; }
  bool can_redo() const { return now_ + 1 < texts_.size(); }
  void undo();
  void redo();

 private:
  void read();

  std::string file_;
  std::vector<std::string> texts_;
  std::size_t now_ = 0;
  std::optional<Document> document_;
  std::vector<core::Problem> problems_;
};

}  // namespace turnpoint::view
