#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <system_error>

#include "station/cli/command.hpp"
#include "station/protocol/protocol.hpp"
#include "station/setup/places.hpp"
#include "station/system/read_file.hpp"
#include "station/system/write_file.hpp"
#include "station/text/toml.hpp"

namespace turnpoint::cli {

namespace new_command {

namespace fs = std::filesystem;

// A goal that a researcher can choose: the word to type, its description, and the shipped protocol that
// measures it.
struct Goal {
  const char* word;
  const char* what;
  const char* file;
};
constexpr Goal goals[] = {
    {"boundary", "where people feel the end of the smooth part, and how sharply", "boundary-constant"},
    {"boundary-quick", "the end of the smooth part, with an even zone and fewer trials (adaptive)",
     "boundary-adaptive"},
    {"setting", "where people set the boundary themselves with a slider", "boundary-adjustment"},
    {"boundary-limits", "the end of the smooth part, in series from both sides (method of limits)",
     "limits-boundary"},
    {"contrast", "the smallest noticeable friction difference (two intervals, QUEST+)", "friction-2ifc"},
    {"contrast-staircase", "the smallest noticeable friction difference (3-down-1-up staircases)",
     "friction-staircase"},
    {"contrast-three", "the same with three intervals, one of which differs (QUEST+)", "friction-3ifc"},
    {"same-different", "whether two surfaces feel different, without saying which is smoother",
     "friction-same-different"},
    {"abx", "whether two surfaces can be told apart: A, B, then which of them is X?", "friction-abx"},
    {"pattern", "how far apart two slippery spots must be to be felt as two", "two-spots-oddity"},
    {"rating", "how smooth a surface feels, rated on points", "smoothness-points"},
    {"rating-line", "how smooth a surface feels, marked on a line", "smoothness-line"},
    {"magnitude", "how smoothness grows with vibration, in numbers (free modulus)", "magnitude-free"},
    {"magnitude-standard", "the same numbers against a standard", "magnitude-standard"},
    {"identification", "which of five degrees of slipperiness people recognise", "friction-identification"},
    {"confidence", "friction differences, and how sure people are of their answers", "friction-confidence"},
    {"speed-accuracy", "noticing a change under the finger, answering fast or carefully", "speed-accuracy"},
    {"response-signal", "how accuracy grows with the time to think, answering at a signal",
     "response-signal"},
    {"control", "whether the task can be done without touching the surface (control)", "no-touch-control"},
    {"demo", "ten trials to try out a station", "demo"},
};

struct Options {
  std::string file, goal, id;
};

const Goal* find_goal(const std::string& answer) {
  int number = 1;
  for (const auto& goal : goals) {
    if (answer == goal.word || answer == std::to_string(number)) return &goal;
    ++number;
  }
  return nullptr;
}

std::string goal_words() {
  std::string all;
  for (const auto& goal : goals) all += (all.empty() ? "" : ", ") + std::string(goal.word);
  return all;
}

// Asks on standard error, because standard output is for the command's result.
const Goal& ask(Context& context) {
  fmt::print(context.err, "What do you want to measure?\n");
  int number = 1;
  for (const auto& goal : goals)
    fmt::print(context.err, "  {:>2}  {} ({})\n", number++, goal.what, goal.word);
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

// Replaces the id of the shipped protocol by that of the study. Also replaces the version by 0.1.0, because
// nothing has been measured with the new protocol yet.
std::string own(std::string source, const std::string& shipped_id, const std::string& id) {
  const auto replace = [&source](const std::string& from, const std::string& to) {
    const auto at = source.find(from);
    if (at == std::string::npos) throw std::runtime_error("the shipped protocol has no line " + from);
    source.replace(at, from.size(), to);
  };
  replace("id = \"" + shipped_id + "\"", "id = \"" + id + "\"");
  replace("version = \"1.0.0\"", "version = \"0.1.0\"");
  return source;
}

void make(const Options& options, Context& context) {
  if (fs::exists(options.file)) throw UsageError(options.file + " already exists; choose another file name");
  const auto* goal = options.goal.empty() ? &ask(context) : find_goal(options.goal);
  if (!goal)
    throw UsageError(fmt::format("--measure {}: the allowed words are {}", options.goal, goal_words()));
  const auto from = fs::path(setup::shipped("protocols")) / (std::string(goal->file) + ".toml");
  const auto id = options.id.empty() ? fs::path(options.file).stem().string() : options.id;
  const auto source = own(system::read_file(from.string()), goal->file, id);
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
