#include "station/cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <utility>

namespace turnpoint::cli {

namespace {

Check check_of(CLI::Validator validator) {
  const std::string allowed = validator.get_description();
  return {allowed, [validator = std::move(validator)](const std::string& value) { return validator(value); }};
}

}  // namespace

Check range(std::int64_t least, std::int64_t most) { return check_of(CLI::Range(least, most)); }
Check between(double least, double most) { return check_of(CLI::Range(least, most)); }
Check positive() { return check_of(CLI::PositiveNumber); }
Check not_negative() { return check_of(CLI::NonNegativeNumber); }
Check one_of(std::vector<std::string> values) { return check_of(CLI::IsMember(std::move(values))); }
Check existing_file() { return check_of(CLI::ExistingFile); }

Option* Option::required() { return option_->required(), this; }
Option* Option::capture_default_str() { return option_->capture_default_str(), this; }

Option* Option::check(Check check) {
  option_->check(std::move(check.problem), std::move(check.allowed));
  return this;
}

Option* Command::add(const std::string& name, Target target, const std::string& help) {
  auto* option = std::visit([&](auto* value) { return app_->add_option(name, *value, help); }, target);
  options_.push_back(std::make_unique<Option>(option));
  return options_.back().get();
}

void Command::add_flag(const std::string& name, bool& target, const std::string& help) {
  app_->add_flag(name, target, help);
}
void Command::footer(const std::string& text) { app_->footer(text); }
void Command::callback(std::function<void()> action) { app_->callback(std::move(action)); }

CommandLine::CommandLine(const std::string& description, const std::string& program,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(description, program)) {
  app_->require_subcommand(1);
  app_->set_version_flag("--version", version);
}

CommandLine::~CommandLine() = default;

Command* CommandLine::add_subcommand(const std::string& name, const std::string& help) {
  commands_.push_back(std::make_unique<Command>(app_->add_subcommand(name, help)));
  return commands_.back().get();
}

std::optional<int> CommandLine::parse(int argc, char** argv, std::ostream& out, std::ostream& err) {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    // CLI11 reports --help and --version by exceptions too; their code is 0.
    return app_->exit(error, out, err) == 0 ? 0 : 2;
  }
}

}  // namespace turnpoint::cli
