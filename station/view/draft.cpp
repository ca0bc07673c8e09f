#include "station/view/draft.hpp"

#include <utility>

namespace turnpoint::view {

namespace {

// How many earlier texts are kept. A protocol has some kilobytes, so this many need a few megabytes.
constexpr std::size_t most_texts = 500;

}  // namespace

std::string next_version(const std::string& version) {
  const auto last = version.find_last_of("0123456789");
  if (last == std::string::npos) return version + "-2";
  const auto before = version.find_last_not_of("0123456789", last);
  auto first = before == std::string::npos ? 0 : before + 1;
  auto number = version.substr(first, last + 1 - first);
  // counted by hand, so that a date or a long number stays exact
  auto digit = number.size();
  while (digit > 0 && number[digit - 1] == '9') number[--digit] = '0';
  if (digit == 0)
    number.insert(0, "1");
  else
    ++number[digit - 1];
  return version.substr(0, first) + number + version.substr(last + 1);
}

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
  } catch (const core::BadInput& bad) {
    problems_ = bad.problems();
  }
}

}  // namespace turnpoint::view
