#include "station/design/draft.hpp"

#include <utility>

namespace turnpoint::design {

namespace {

// How many earlier texts are kept. A protocol has some kilobytes, so this many need a few megabytes.
constexpr std::size_t most_texts = 500;

}  // namespace

Draft::Draft(std::string text, std::string file) : file_(std::move(file)), texts_{std::move(text)} { read(); }

void Draft::change(std::string text) {
  if (text == this->text()) return;
  texts_.resize(now_ + 1);
  texts_.push_back(std::move(text));
  if (texts_.size() > most_texts) texts_.erase(texts_.begin());
  now_ = texts_.size() - 1;
  read();
}

void Draft::undo() {
  if (!can_undo()) return;
  --now_;
  read();
}

void Draft::redo() {
  if (!can_redo()) return;
  ++now_;
  read();
}

void Draft::read() {
  document_.reset();
  problems_.clear();
  try {
    document_.emplace(text(), file_);
  } catch (const text::BadInput& bad) {
    problems_ = bad.problems();
  }
}

}  // namespace turnpoint::design
