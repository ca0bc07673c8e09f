#include "tests/benchmark/scripts.hpp"

#include <array>
#include <cstdio>
#include <memory>
#include <sstream>

namespace turnpoint::benchmark {

std::vector<std::string> run_peer(const std::string& script, const std::vector<std::string>& arguments) {
  std::string command = script.ends_with(".js") ? "node" : "python3 -W ignore";
  command += " '" TURNPOINT_SOURCE_DIR "/tests/benchmark/peers/" + script + "'";
  for (const auto& argument : arguments) command += " '" + argument + "'";
  command += " 2>/dev/null";
  std::string output;
  {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    if (!pipe) return {};
    std::array<char, 4096> part{};
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe.get()))
      output.append(part.data(), n);
  }
  std::vector<std::string> lines;
  std::istringstream stream(output);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace turnpoint::benchmark
