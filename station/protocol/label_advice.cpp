#include <algorithm>

#include "station/protocol/advice_list.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

/// How much room labels have on a button, in letters of the smallest size (capitals of 2.5 mm), on the
/// smallest screens: 7 inches, 800x480 upright or across. Long words are not broken. tests/ui/tst_labels.qml
/// shows that such labels fit.
struct Room {
  int word, label;
};
Room room_for(int answers) {
  if (answers <= 2) return {24, 96};
  if (answers == 4) return {19, 76};
  return {13, 52};
}

/// The longest part of a label that cannot be broken, and the whole of it, in letters. From U+3000 on, a
/// character takes the room of two letters, and a line may end after each.
struct Length {
  int word = 0, label = 0;
};
Length length_of(const std::string& label) {
  Length length;
  int word = 0;
  for (std::size_t i = 0; i < label.size(); ++i) {
    const auto byte = static_cast<unsigned char>(label[i]);
    if ((byte & 0xC0) == 0x80) continue;  // not the first byte of a character
    const bool soft_hyphen = label.compare(i, 2, "\u00AD") == 0;
    const bool wide = byte >= 0xE3;
    const int letters = soft_hyphen ? 0 : wide ? 2 : 1;
    length.label += letters;
    word = byte == ' ' || soft_hyphen ? 0 : wide ? letters : word + letters;
    length.word = std::max(length.word, word);
  }
  return length;
}

void check_label(AdviceList& advice, const std::string& key, const std::string& label, int answers) {
  const auto room = room_for(answers);
  const auto length = length_of(label);
  if (length.word > room.word)
    advice.add(
        key,
        phrase("\"%1\" does not fit a screen of 7 inches, where each of %2 answers has room for words of %3 "
               "letters",
               {plain(label), plain(answers), plain(room.word)}),
        phrase("shorter words, fewer answers, or a soft hyphen (\\u00AD) where a word may be divided"));
  else if (length.label > room.label)
    advice.add(
        key,
        phrase("\"%1\" does not fit a screen of 7 inches, where each of %2 answers has room for %3 letters",
               {plain(label), plain(answers), plain(room.label)}),
        phrase("a shorter label, or fewer answers"));
}

}  // namespace

void advise_on_labels(AdviceList& advice) {
  const auto& task = advice.protocol.task;
  if (!judges(task))
    for (std::size_t i = 0; i < task.choices.size(); ++i)
      for (const auto& [language, label] : task.choices[i].label)
        check_label(advice, key_of(task, "choices.") + std::to_string(i) + ".label." + language, label,
                    answer_count(task));
  for (const auto& [language, label] : task.unsure)
    check_label(advice, key_of(task, "unsure.") + language, label, answer_count(task));
  if (!task.confidence) return;
  const auto& labels = task.confidence->labels;
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (const auto& [language, label] : labels[i])
      check_label(advice, key_of(task, "confidence.labels.") + std::to_string(i) + "." + language, label,
                  static_cast<int>(labels.size()));
}

}  // namespace turnpoint::protocol
