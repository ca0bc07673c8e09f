#pragma once
#include <stdexcept>

namespace turnpoint::core {

/// Thrown if the user asks, on the command line or in a file, for something that the program does not
/// understand or that this station cannot do. The message names the value and what is allowed; the programs
/// exit with status 2.
///
/// Other errors have other types. A breach of contract between parts of the program is a std::logic_error
/// (exit status 70, with the request to report it). A failure at run time (a disk, a device) is any other
/// exception (exit status 1).
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A program that chooses levels, answers trials or estimates has failed: it died, was late, or wrote what it
/// must not write. what() names the program and the reason. Nothing is lost: asking again starts the program
/// afresh and brings it to the same state.
class ProgramFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace turnpoint::core
