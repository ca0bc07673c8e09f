#pragma once
#include <string>

#include "station/programs/conversation.hpp"

namespace turnpoint::programs {

/// A program that an option of the command line names: `program:FILE[,limit_s=S][,KEY=VALUE]...`.
struct ProgramChoice {
  std::string path;
  double limit_s = 2;
  Json settings = Json::object();  ///< the other keys, which are numbers if they look like numbers
};

/// Reads the value of an option. `option` is the name of the option, for messages. Throws terms::UsageError.
ProgramChoice parse_program(const std::string& option, const std::string& text);

/// The same, and also throws terms::UsageError if there is no such program, or if it cannot be run.
ProgramChoice existing_program(const std::string& option, const std::string& text);

}  // namespace turnpoint::programs
