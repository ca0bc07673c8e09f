#pragma once
// Sentences for people that a program can also say in another language.
#include <array>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace turnpoint::physics {

// A sentence in English, with its code and the values in it.
struct Statement {
  std::string code;
  std::string text;
  std::vector<std::string> values;
};

// A value of a sentence: a number with this many significant digits, or a word.
struct StatementValue {
  StatementValue(double number, int digits = 6);
  StatementValue(std::string word) : text(std::move(word)) {}
  std::string text;
};

// Makes a statement with this sentence, in which %1, %2 and so on stand for the values.
Statement make_statement(std::string code, std::string_view sentence,
                         std::initializer_list<StatementValue> values = {});

// The codes of all refusals, for programs.
inline constexpr std::array refusal_codes{
    "constant-width", "no-such-edge",       "edge-not-tabulated", "at-resonance",
    "below-cut-off",  "turning-beyond",     "peak-hidden",        "no-peak",
    "zone-place",     "zone-friction",      "zone-edge",          "zone-without-edge",
    "zone-band",      "zone-mean-friction", "no-smooth-zone",     "boundary-nowhere",
    "no-peak-at",     "measured-boundary",  "nothing-uncertain",  "boundary-fit"};

// Thrown if the surface cannot do what was asked for, with one of these codes. Errors that only a program can
// make, such as an empty list of tones, are std::invalid_argument.
class Refused : public std::domain_error {
 public:
  explicit Refused(Statement why) : domain_error(why.text), why_(std::move(why)) {}
  const Statement& why() const { return why_; }

 private:
  Statement why_;
};

}  // namespace turnpoint::physics
