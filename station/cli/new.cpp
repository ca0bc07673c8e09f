#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>

#include "station/cli/command.hpp"
#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/protocol.hpp"
#include "station/session/places.hpp"
#include "station/system/write_file.hpp"
#include "station/view/goals.hpp"

namespace turnpoint::cli {

namespace new_command {

namespace fs = std::filesystem;

struct Options {
  std::string file, goal, id;
};

// Finds a goal by its word, or by its number in the list.
const view::Goal* find_goal(const std::string& answer) {
  int number = 1;
  for (const auto& goal : view::goals())
    if (answer == std::to_string(number++)) return &goal;
  return view::find_goal(answer);
}

std::string goal_words() {
  std::string all;
  for (const auto& goal : view::goals()) all += (all.empty() ? "" : ", ") + std::string(goal.word);
  return all;
}

// Asks on standard error, because standard output is for the command's result.
const view::Goal& ask(Context& context) {
  fmt::print(context.err, "What do you want to measure?\n");
  int number = 1;
  for (const auto& goal : view::goals())
    fmt::print(context.err, "  {:>2}  {} ({})\n", number++, describe(goal, "en"), goal.word);
  for (;;) {
    fmt::print(context.err, "Type a number or the word in brackets: ");
    context.err.flush();
    std::string answer;
    if (!std::getline(std::cin, answer))
      throw UsageError("new: there was no answer; use --measure with one of " + goal_words());
    if (const auto* goal = find_goal(answer)) return *goal;
    fmt::print(context.err, "\"{}\" is not one of these goals.\n", answer);
  }
}

void make(const Options& options, Context& context) {
  if (fs::exists(options.file)) throw UsageError(options.file + " already exists; choose another file name");
  const auto* goal = options.goal.empty() ? &ask(context) : find_goal(options.goal);
  if (!goal)
    throw UsageError(fmt::format("--measure {}: the allowed words are {}", options.goal, goal_words()));
  const auto from = fs::path(session::shipped("protocols")) / (std::string(goal->file) + ".toml");
  const auto id = options.id.empty() ? fs::path(options.file).stem().string() : options.id;
  const auto source = view::study_from(*goal, core::read_file(from.string()), id);
  protocol::parse(source, options.file);  // refuses an invalid id before anything is written
  system::write_file(options.file, source);
  fmt::print(context.out, "{}\n", options.file);
  fmt::print(context.err,
             "The new file is a copy of {}. Change its levels and texts, then run: turnpoint check {}\n",
             goal->file, options.file);
}

}  // namespace new_command

void add_new(CommandLine& app, Context& context) {
  using namespace new_command;
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand(
      "new", "Make a protocol file: asks what you want to measure and copies a suitable shipped protocol");
  command->add_option("file", options->file, "The file to write, such as my-study.toml")
      ->value("FILE")
      ->required();
  command->add_option("--measure", options->goal,
                      "What to measure, so that the command need not ask: " + goal_words());
  command->add_option("--id", options->id, "Id of the protocol; by default the name of the file");
  command->footer("Example: turnpoint new my-study.toml --measure contrast");
  command->callback([options, &context] { make(*options, context); });
}

}  // namespace turnpoint::cli
