#pragma once
#include <stdexcept>

namespace turnpoint::terms {

/// The user asked for something that the program does not understand or that this station cannot do, on the
/// command line or in a file. The message names the value and what is allowed; the programs exit with 2.
/// A failure at run time (a disk, a device) is any other exception: exit 1. If one part of the program breaks
/// another's contract, that is a std::logic_error: exit 70, and the message asks the user to report it.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace turnpoint::terms
