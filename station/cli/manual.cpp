#include "station/cli/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "station/core/letters.hpp"
#include "station/session/places.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::cli {
namespace {

/// Escapes a text for roff: no character is taken for a command, and a user can copy the hyphens.
std::string roff(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n'))
      safe += std::string("\\&") + c;
    else
      safe += c;
  }
  return safe;
}

std::string head(const std::string& page, const std::string& summary) {
  std::string upper;
  for (const char c : page) upper += core::upper(c);
  auto first = summary;
  if (first.size() > 1 && std::islower(static_cast<unsigned char>(first[1])))
    first[0] = core::lower(first[0]);
  return fmt::format(".TH {} 1 \"\" \"Turnpoint {}\" \"Turnpoint manual\"\n.ad l\n.nh\n.SH NAME\n{} \\- {}\n",
                     roff(upper), TURNPOINT_VERSION, roff(page), roff(first));
}

std::string tail(const std::string& see_also) {
  return ".SH EXIT STATUS\n.TP\n0\ndone\n.TP\n1\nfailed at run time\n.TP\n2\nbad input or usage\n.TP\n70\na "
         "fault of "
         "the program itself; please report it\n.TP\n128 and the number of a signal\na signal stopped the "
         "work, "
         "and the output contains the results until then (power, check)\n.SH SEE ALSO\n" +
         see_also + "\n.PP\nThe manuals in /usr/share/doc/turnpoint, README.md first.\n";
}

std::string item(const OptionText& option) {
  auto kind = option.kind;
  kind = core::lower(kind);
  const std::string shown = option.positional ? option.name : kind;
  std::string text = ".TP\n";
  if (option.positional)
    text += fmt::format("\\fI{}\\fR", roff(option.name));
  else
    text += fmt::format("\\fB{}\\fR{}", roff(option.name),
                        option.kind.empty() ? "" : " \\fI" + roff(shown) + "\\fR");
  if (option.many) text += " ...";
  text += "\n" + roff(option.help);
  std::vector<std::string> notes;
  if (option.required) notes.emplace_back("required");
  if (!option.allowed.empty()) notes.push_back("allowed: " + option.allowed);
  if (!option.preset.empty()) notes.push_back("default: " + option.preset);
  if (!notes.empty()) text += roff(fmt::format(" ({})", fmt::join(notes, "; ")));
  return text + "\n";
}

std::string page_of(const CommandText& command) {
  auto text = head("turnpoint-" + command.name, command.help);
  text += fmt::format(".SH SYNOPSIS\n\\fBturnpoint {}\\fR [\\fIoptions\\fR]", roff(command.name));
  std::string options, arguments;
  for (const auto& option : command.options) {
    (option.positional ? arguments : options) += item(option);
    if (option.positional)
      text += fmt::format(fmt::runtime(option.required ? " \\fI{}\\fR" : " [\\fI{}\\fR]"), roff(option.name));
    if (option.positional && option.many) text += " ...";
  }
  text += "\n.SH DESCRIPTION\n" + roff(command.help) + ".\n";
  if (!arguments.empty()) text += ".SH ARGUMENTS\n" + arguments;
  text += ".SH OPTIONS\n" + options;
  const std::string example = "Example: ";
  if (const auto at = command.footer.find(example); at != std::string::npos)
    text += ".SH EXAMPLE\n.EX\n" + roff(command.footer.substr(at + example.size())) + "\n.EE\n";
  return text + tail(".BR turnpoint (1)");
}

}  // namespace

void write_manual(const std::vector<CommandText>& commands, const std::string& description,
                  const std::string& folder) {
  system::make_folder(folder);
  const auto write = [&](const std::string& page, const std::string& text) {
    system::write_file((std::filesystem::path(folder) / (page + ".1")).string(), text);
  };
  std::string list, pages;
  for (const auto& command : commands) {
    write("turnpoint-" + command.name, page_of(command));
    list += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(command.name), roff(command.help));
    pages += fmt::format("{}.BR turnpoint\\-{} (1)", pages.empty() ? "" : ",\n", roff(command.name));
  }
  const std::string synopsis =
      ".SH SYNOPSIS\n\\fB{0}\\fR \\fIcommand\\fR [\\fIoptions\\fR]\n.br\n\\fB{0} help\\fR "
      "[\\fIcommand\\fR]\n.SH "
      "DESCRIPTION\n";
  write("turnpoint", head("turnpoint", description) + fmt::format(fmt::runtime(synopsis), "turnpoint") +
                         roff(description) + ".\n.SH COMMANDS\n" + list + tail(pages));
  write("turnpoint-ui", head("turnpoint-ui", "Turnpoint with a screen") +
                            fmt::format(fmt::runtime(synopsis), "turnpoint\\-ui") +
                            "The same program as \\fBturnpoint\\fR, with a touchscreen: it has all its "
                            "commands, and opens windows "
                            "for run, resume, preview, calibrate and station.\n" +
                            tail(".BR turnpoint (1)"));
}

namespace {

using Words = std::vector<std::string>;

/// Returns the names of the shipped files in a folder, such as protocols.
Words shipped_names(const std::string& folder) {
  Words names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(session::shipped(folder), error))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

Words values_of(const OptionText& option) {
  if (!option.values.empty()) return option.values;
  if (option.kind == "FILE") return {":files"};
  if (option.kind == "FOLDER") return {":folders"};
  auto names = option.kind == "PROTOCOL" ? shipped_names("protocols")
               : option.kind == "RIG"    ? shipped_names("deploy/rigs")
                                         : Words{};
  if (!names.empty()) names.emplace_back(":files");
  return names;
}

const OptionText* find(const CommandText& command, const std::string& name) {
  for (const auto& option : command.options)
    if (option.name == name && !option.positional) return &option;
  return nullptr;
}

/// Returns what can complete the last of these words, which the user is still typing.
Words after(const CommandText& command, const Words& words) {
  const OptionText* open = nullptr;  // the option that takes the next word as its value
  std::size_t place = 0;             // number of positional arguments before the next word
  for (std::size_t i = 1; i + 1 < words.size(); ++i) {
    if (words[i].starts_with("-")) {
      const auto* option = find(command, words[i]);
      open = option && !option->kind.empty() ? option : nullptr;
    } else if (!open) {
      ++place;
    } else if (!open->many) {
      open = nullptr;
    }
  }
  Words fitting, options;
  for (const auto& option : command.options)
    if (!option.positional &&
        (option.many || std::find(words.begin(), words.end() - 1, option.name) == words.end() - 1))
      options.push_back(option.name);
  if (words.back().starts_with("-")) return options;
  if (open) return values_of(*open);
  for (const auto& option : command.options)
    if (option.positional && (place == 0 || option.many)) {
      fitting = values_of(option);
      break;
    } else if (option.positional) {
      --place;
    }
  return fitting.empty() && words.back().empty() ? options : fitting;
}

}  // namespace

std::vector<std::string> completions(const std::vector<CommandText>& commands,
                                     std::vector<std::string> words) {
  // Bash splits "--db=lab" into three words, so remove the equals sign.
  if (words.size() > 1 && words.back() == "=") words.back().clear();
  words.erase(std::remove(words.begin(), words.end(), "="), words.end());
  if (words.empty()) return {};
  Words fitting;
  const bool help = words.front() == "help" && words.size() == 2;
  if (words.size() == 1 || help)
    for (const auto& command : commands) fitting.push_back(command.name);
  if (words.size() == 1) fitting.insert(fitting.end(), {"help", "--help", "--version"});
  if (words.size() > 1)
    for (const auto& command : commands)
      if (command.name == words.front()) fitting = after(command, words);
  const auto& begun = words.back();
  fitting.erase(std::remove_if(fitting.begin(), fitting.end(),
                               [&](const auto& word) { return word[0] != ':' && !word.starts_with(begun); }),
                fitting.end());
  return fitting;
}

}  // namespace turnpoint::cli
