#pragma once
#include <memory>

#include "station/app/prepare.hpp"
#include "station/cli/command.hpp"

namespace turnpoint::cli {

/// Adds the options of `turnpoint run` to a command; turnpoint-ui takes the same ones.
std::shared_ptr<app::RunRequest> add_run_options(CLI::App& command);

}  // namespace turnpoint::cli
