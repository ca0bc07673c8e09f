#include "station/cli/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "station/core/number.hpp"
#include "station/core/problem.hpp"
#include "station/core/usage_error.hpp"

namespace turnpoint::cli {

namespace {

using core::UsageError;

template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Makes a check for an option whose value is a number. `good` says whether a number is allowed; it is called
/// only with finite numbers.
template <class Number>
Check number_check(const std::string& allowed, std::function<bool(Number)> good) {
  return {allowed, [allowed, good = std::move(good)](const std::string& value) -> std::string {
            const auto number = parsed<Number>(value);
            if (number && std::isfinite(static_cast<double>(*number)) && good(*number)) return "";
            return fmt::format("\"{}\" is not allowed; write a {}, {}", value,
                               std::is_integral_v<Number> ? "whole number" : "number", allowed);
          }};
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  return fmt::format("{}", fmt::join(words, separator));
}

/// Returns "; did you mean KNOWN? ADVICE", or only "; ADVICE" if no known word resembles the typed one.
std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& advice) {
  auto near = core::nearest(word, known);
  // The beginning of a name (such as --lang) may differ from the whole name in many letters, so nearest() may
  // not find it.
  for (const auto& candidate : known)
    if (near.empty() && word.size() > 3 && candidate.starts_with(word)) near = candidate;
  return near.empty() ? "; " + advice : fmt::format("; did you mean {}? {}", near, advice);
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const auto* option : command.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// The name under which the user knows the option: "--db", or "protocol" for a positional one.
std::string name_of(const CLI::Option& option) { return option.get_name(false, false); }

/// Names every required option that was not given.
std::string missing_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const auto* option : command.get_options())
    if (option->get_required() && option->count() == 0) names.push_back(name_of(*option));
  return fmt::format("{} {} missing", joined(names, " and "), names.size() == 1 ? "is" : "are");
}

/// Explains an error whose message begins with the name of an option.
std::string explained(const CLI::App& command, const std::string& name) {
  for (const auto* option : command.get_options()) {
    if (name_of(*option) != name) continue;
    if (option->get_expected_max() == 0) return name + " takes no value";
    if (option->count() == 0 || option->results().empty() || option->results().front().empty())
      return name + " needs a value";
    if (static_cast<int>(option->count()) > option->get_expected_max())
      return fmt::format("{} was given {} times, but can have one value only", name, option->count());
    return fmt::format("{} {}: this is not a number", name, joined(option->results(), " "));
  }
  return name;
}

std::string before(const std::string& text, const std::string& mark) {
  return text.substr(0, text.find(mark));
}

/// Returns the help without CLI11's notes "Excludes: ...", which can be longer than the option's own text.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    return before(CLI::Formatter::make_option_opts(option), " Excludes:");
  }
};

/// Explains an error of CLI11, whose own messages count arguments and do not name the command.
std::string reason(const CLI::App& command, const CLI::ParseError& error) {
  const std::string said = error.what();
  if (dynamic_cast<const CLI::RequiredError*>(&error)) return missing_of(command);
  if (dynamic_cast<const CLI::ExtrasError*>(&error))
    return fmt::format("\"{}\" is one value too many", joined(command.remaining(), " "));
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return explained(command, before(said, ":"));
  const std::string excludes = " excludes ";
  if (dynamic_cast<const CLI::ExcludesError*>(&error))
    return fmt::format("{} cannot be used with {}", before(said, excludes),
                       said.substr(said.find(excludes) + excludes.size()));
  const std::string conversion = "Could not convert: ";
  if (said.starts_with(conversion)) return explained(command, before(said.substr(conversion.size()), " = "));
  if (dynamic_cast<const CLI::ConversionError*>(&error)) return explained(command, before(said, ":"));
  return said;
}

}  // namespace

Check range(std::int64_t least, std::int64_t most) {
  return number_check<std::int64_t>(fmt::format("{} to {}", least, most),
                                    [=](std::int64_t n) { return n >= least && n <= most; });
}

Check between(double least, double most) {
  return number_check<double>(fmt::format("{} to {}", core::number(least), core::number(most)),
                              [=](double n) { return n >= least && n <= most; });
}

Check positive() {
  return number_check<double>("above 0", [](double n) { return n > 0; });
}

Check not_negative() {
  return number_check<double>("0 or more", [](double n) { return n >= 0; });
}

Check one_of(std::vector<std::string> values) {
  const auto all = joined(values, " | ");
  return {all,
          [values, all](const std::string& value) -> std::string {
            if (std::find(values.begin(), values.end(), value) != values.end()) return "";
            return fmt::format("\"{}\" is not allowed{}", value,
                               suggestion(value, values, "allowed are " + all));
          },
          values};
}

Option* Option::required() { return option_->required(), this; }
Option* Option::capture_default_str() { return option_->capture_default_str(), this; }

Option* Option::check(Check check) {
  values_ = std::move(check.values);
  option_->check(std::move(check.problem), std::move(check.allowed));
  return this;
}

Option* Option::value(const std::string& kind) { return option_->type_name(kind), this; }

Option* Option::excludes(const Option* other) { return option_->excludes(other->option_), this; }

Option* Option::transform(std::function<std::string(const std::string& value)> change) {
  option_->transform(std::move(change));
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

CommandText Command::text() const {
  CommandText command{app_->get_name(), app_->get_description(), app_->get_footer(), {}};
  for (const auto* option : app_->get_options()) {
    auto& text = command.options.emplace_back();
    text.name = name_of(*option), text.help = option->get_description();
    text.positional = option->get_positional(), text.required = option->get_required();
    text.many = option->get_expected_max() > 1, text.preset = option->get_default_str();
    if (option->get_expected_max() == 0) continue;
    const auto type = option->get_type_name();  // "INT", or "INT:" and what is allowed
    text.kind = before(type, ":");
    if (type.size() > text.kind.size()) text.allowed = type.substr(text.kind.size() + 1);
    for (const auto& known : options_)
      if (known->is(option)) text.values = known->values();
  }
  return command;
}

void Command::callback(std::function<void()> action) { app_->callback(std::move(action)); }

CommandLine::CommandLine(const std::string& description, const std::string& program,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(description, program)) {
  app_->formatter(std::make_shared<HelpFormat>());
  app_->require_subcommand(1);
  app_->set_version_flag("-V,--version", version);
  app_->footer("`turnpoint help COMMAND` explains a command and shows an example.");
}

CommandLine::~CommandLine() = default;

Command* CommandLine::add_subcommand(const std::string& name, const std::string& help) {
  commands_.push_back(std::make_unique<Command>(app_->add_subcommand(name, help)));
  return commands_.back().get();
}

/// Throws UsageError if the command or one of its options does not exist. CLI11 would complain first about
/// what is missing, and so hide a misspelt option.
void CommandLine::require_known(const std::vector<std::string>& words) const {
  const std::string list = "`turnpoint help` lists the commands";
  if (words.empty()) throw UsageError("no command was given; " + list);
  const auto& first = words.front();
  if (first.starts_with("-")) {
    auto known = options_of(*app_);
    known.insert(known.end(), {"-V", "-h"});
    if (std::find(known.begin(), known.end(), first) != known.end()) return;
    throw UsageError(
        fmt::format("{}: the command must come before its options{}", first, suggestion(first, known, list)));
  }
  std::vector<std::string> commands{"help"};
  const CLI::App* command = nullptr;
  for (const auto* one : app_->get_subcommands({})) {
    commands.push_back(one->get_name());
    if (one->get_name() == first) command = one;
  }
  if (!command)
    throw UsageError(fmt::format("there is no command \"{}\"{}", first, suggestion(first, commands, list)));
  const auto known = options_of(*command);
  for (std::size_t i = 1; i < words.size() && words[i] != "--"; ++i) {
    const auto name = before(words[i], "=");
    const bool option = name.size() > 1 && name[0] == '-' &&
                        (name[1] == '-' || std::isalpha(static_cast<unsigned char>(name[1])));
    if (!option || name == "-h" || std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw UsageError(
        fmt::format("{}: there is no option {}{}", first, name,
                    suggestion(name, known, fmt::format("`turnpoint help {}` lists the options", first))));
  }
}

std::vector<CommandText> CommandLine::texts() const {
  std::vector<CommandText> texts;
  for (const auto& command : commands_) texts.push_back(command->text());
  return texts;
}

bool CommandLine::parse(int argc, char** argv, std::ostream& out) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words[0] == "help")
    words =
        words.size() > 1 ? std::vector<std::string>{words[1], "--help"} : std::vector<std::string>{"--help"};
  require_known(words);
  try {
    auto reversed = std::vector<std::string>(words.rbegin(), words.rend());
    app_->parse(reversed);
    return true;
  } catch (const CLI::Success& wish) {  // CLI11 reports --help and --version by exceptions
    app_->exit(wish, out, out);
    return false;
  } catch (const CLI::ParseError& error) {
    const auto& command = *app_->get_subcommand(words[0]);
    throw UsageError(fmt::format("{}: {}; `turnpoint help {}` shows an example", words[0],
                                 reason(command, error), words[0]));
  }
}

}  // namespace turnpoint::cli
