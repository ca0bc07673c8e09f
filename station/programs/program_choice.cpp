#include "station/programs/program_choice.hpp"

#include <filesystem>

#include "station/programs/programs.hpp"
#include "station/terms/usage_error.hpp"
#include "station/text/number.hpp"

namespace turnpoint::programs {

namespace {

const std::string kPrefix = "program:";
constexpr double kLongestLimit_s = 60;

}  // namespace

bool is_program(const std::string& text) { return text.starts_with(kPrefix); }

std::string located(const std::string& observer) {
  if (!is_program(observer)) return observer;
  const auto path = existing_program("--observer", observer).path;
  return kPrefix + std::filesystem::absolute(path).lexically_normal().string() +
         observer.substr(kPrefix.size() + path.size());
}

ProgramChoice parse_program(const std::string& option, const std::string& text) {
  const auto bad = [&](const std::string& what) {
    throw terms::UsageError(option + " " + text + ": " + what +
                            "; a program is written program:FILE[,limit_s=S][,KEY=VALUE]...");
  };
  if (!is_program(text)) bad("no program");
  ProgramChoice choice;
  auto comma = text.find(',');
  choice.path = text.substr(kPrefix.size(), comma == std::string::npos ? comma : comma - kPrefix.size());
  if (choice.path.empty()) bad("the file is missing");
  while (comma != std::string::npos) {
    const auto next = text.find(',', comma + 1);
    const auto entry = text.substr(comma + 1, next == std::string::npos ? next : next - comma - 1);
    comma = next;
    const auto equals = entry.find('=');
    if (equals == std::string::npos || equals == 0) bad("\"" + entry + "\" is not KEY=VALUE");
    const auto key = entry.substr(0, equals), value = entry.substr(equals + 1);
    const auto number = text::read_number(value);
    if (key != "limit_s")
      choice.settings[key] = number ? Json(*number) : Json(value);
    else if (!number || !(*number > 0 && *number <= kLongestLimit_s))
      bad("limit_s must be above 0 and at most " + text::number(kLongestLimit_s) + " s");
    else
      choice.limit_s = *number;
  }
  return choice;
}

ProgramChoice existing_program(const std::string& option, const std::string& text) {
  auto choice = parse_program(option, text);
  if (const auto problem = problem_of(choice.path); !problem.empty())
    throw terms::UsageError(option + " " + text + ": " + problem);
  return choice;
}

}  // namespace turnpoint::programs
