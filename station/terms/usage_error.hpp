#pragma once
#include <stdexcept>

namespace turnpoint::terms {

/// What the user asked for cannot be understood, or this station cannot do it: a value on the command line or
/// in a file. The message names the value and what is allowed; the programs exit with 2.
///
/// A failure at run time (a disk, a device) is any other exception: exit 1. A broken contract between parts
/// of the program is a std::logic_error: exit 70, with the request to report it.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace turnpoint::terms
