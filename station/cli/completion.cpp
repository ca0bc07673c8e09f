#include "station/cli/completion.hpp"

#include <algorithm>
#include <filesystem>

#include "station/setup/places.hpp"

namespace turnpoint::cli {

namespace {

using Words = std::vector<std::string>;

/// Returns the names of the shipped files in a folder, such as protocols.
Words shipped_names(const std::string& folder) {
  Words names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(setup::shipped(folder), error))
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
