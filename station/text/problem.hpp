#pragma once
#include <stdexcept>
#include <string>
#include <vector>

namespace turnpoint::text {

/// Where in a file something stands; line and column count from 1, 0 means the file as a whole.
struct Place {
  std::string file;  ///< the path as the user typed it
  int line = 0;
  int column = 0;
};

/// One thing wrong with a file (or worth a warning), and what would be right.
struct Problem {
  Place place;
  std::string what;
  std::string allowed;  ///< may be empty where `what` says it all
};

/// `file:line:column: what; allowed`, without the parts that are not there.
std::string format(const Problem& problem);

/// All problems of a file at once; `what()` holds one formatted problem a line. The programs exit with 2.
class BadInput : public std::runtime_error {
 public:
  explicit BadInput(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The candidate nearest to `word` by edit distance, or "" where none is near enough to be a typing slip.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace turnpoint::text
