#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace turnpoint::text {

/// A position in a file. Line and column count from 1; 0 means the file as a whole.
struct Place {
  std::string file;  ///< the path as the user typed it
  int line = 0;
  int column = 0;
};

/// One problem or warning about a file, and what would be correct.
struct Problem {
  Place place;
  std::string what;
  std::string allowed;  ///< may be empty if `what` is enough
};

/// `file:line:column: what; allowed`, without the parts that are missing.
std::string format(const Problem& problem);

/// All problems of a file at once; `what()` contains one formatted problem per line. The programs exit with
/// 2.
class BadInput : public std::runtime_error {
 public:
  explicit BadInput(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The candidate nearest to `word` by edit distance, or "" if none is close enough to be a typing error.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace turnpoint::text
