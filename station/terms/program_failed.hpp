#pragma once
#include <stdexcept>

namespace turnpoint::terms {

/// A program that chooses levels, answers trials or estimates has failed: it died, was late, or wrote what it
/// must not write. what() names the program and the reason. Nothing is lost: asking again starts the program
/// afresh and brings it to the same state.
class ProgramFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace turnpoint::terms
