#pragma once
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace turnpoint::cli {

/// A check of an option's value, together with the description of the allowed values for the help.
struct Check {
  std::string allowed;
  /// given the value, returns what is wrong with it; "" if nothing is
  std::function<std::string(const std::string& value)> problem;
  std::vector<std::string> values = {};  ///< the allowed values, if there are only a few
};
Check range(std::int64_t least, std::int64_t most);  ///< accepts whole numbers from `least` to `most`
Check between(double least, double most);            ///< accepts any number from `least` to `most`
Check positive();
Check not_negative();
Check one_of(std::vector<std::string> values);

/// One option of a sub-command. Each call returns the option itself, so that calls can be chained.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option* required();
  Option* capture_default_str();  ///< shows the target's current value in the help
  Option* check(Check check);
  /// names the kind of value in the help: FILE, FOLDER, PROTOCOL or RIG, which a shell completes
  Option* value(const std::string& kind);
  /// refuses a command line that has both this option and the other
  Option* excludes(const Option* other);
  /// replaces the value by the result of `change`
  Option* transform(std::function<std::string(const std::string& value)> change);

  bool is(const CLI::Option* option) const { return option == option_; }
  const std::vector<std::string>& values() const { return values_; }  ///< see Check::values

 private:
  CLI::Option* option_;
  std::vector<std::string> values_;
};

/// What the help says about one option or positional argument.
struct OptionText {
  std::string name;     ///< "--db", or "protocol" for a positional one
  std::string kind;     ///< kind of value, such as "FILE" or "INT"; "" for a flag
  std::string allowed;  ///< allowed values, such as "1 to 1000"; "" if nothing is said about them
  std::string preset;   ///< value of the option if it is not given; "" if there is none
  std::string help;
  bool positional = false, required = false;
  bool many = false;                ///< whether the option takes several values
  std::vector<std::string> values;  ///< the allowed values, if there are only a few
};

struct CommandText {
  std::string name, help, footer;
  std::vector<OptionText> options;
};

/// One sub-command: its options, the example below its help, and its action. An option writes into its
/// target, which must outlive the parsing. Names without leading dashes are positional. CLI11 is compiled
/// only in command_line.cpp, because including it costs each file ten seconds of compile time.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}
  template <class T>
  Option* add_option(const std::string& name, T& target, const std::string& help) {
    return add(name, &target, help);
  }
  void add_flag(const std::string& name, bool& target, const std::string& help);
  void footer(const std::string& text);
  CommandText text() const;
  void callback(std::function<void()> action);

 private:
  using Target = std::variant<std::string*, int*, double*, std::uint64_t*, std::vector<std::string>*,
                              std::vector<double>*, std::optional<std::string>*, std::optional<int>*,
                              std::optional<double>*, std::optional<std::uint64_t>*>;
  Option* add(const std::string& name, Target target, const std::string& help);

  CLI::App* app_;
  std::vector<std::unique_ptr<Option>> options_;
};

/// The whole command line. It requires exactly one of its sub-commands.
class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& program, const std::string& version);
  ~CommandLine();
  Command* add_subcommand(const std::string& name, const std::string& help);

  /// Parses the command line and runs the callback of the sub-command; exceptions of the callback pass
  /// through. Returns false if --help, --version or `help` was given, whose text it prints on `out`. Throws
  /// UsageError for a command line that it does not understand.
  bool parse(int argc, char** argv, std::ostream& out);

  std::vector<CommandText> texts() const;  ///< help texts of all sub-commands

 private:
  void require_known(const std::vector<std::string>& words) const;

  std::unique_ptr<CLI::App> app_;
  std::vector<std::unique_ptr<Command>> commands_;
};

}  // namespace turnpoint::cli
