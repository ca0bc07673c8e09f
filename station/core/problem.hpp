#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "station/core/texts.hpp"

namespace turnpoint::core {

/// A position in a file. Line and column count from 1; 0 means the file as a whole.
struct Place {
  std::string file;  ///< the path as the user typed it
  int line = 0;
  int column = 0;
};

/// One problem or warning about a file, and what would be correct.
struct Problem {
  Place place;
  Phrase what;
  Phrase allowed;  ///< what would be correct; may be empty if `what` says enough
};

/// Returns `file:line:column: what; allowed`. Parts that are not set are left out.
Phrase phrase_of(const Problem& problem);
/// Returns the same in English.
std::string format(const Problem& problem);

/// Reports all problems of a file at once: what() has one formatted problem per line, in English. The
/// programs exit with status 2.
class BadInput : public std::runtime_error {
 public:
  explicit BadInput(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// Returns the candidate nearest to `word` by edit distance, or "" if no candidate is close enough to explain
/// `word` as a typing error.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace turnpoint::core
