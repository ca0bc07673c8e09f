#include "station/benchmark/scripts.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <unistd.h>

namespace turnpoint::benchmark {

namespace {

/// A file of its own for the program, gone at the end. Quoting a program for a shell would be worse.
struct Script {
  std::string path = (std::filesystem::temp_directory_path() / "turnpoint-bench-XXXXXX").string();
  explicit Script(const std::string& program) {
    const int file = mkstemp(path.data());
    if (file < 0) {
      path.clear();
      return;
    }
    close(file);
    std::ofstream(path) << program;
  }
  ~Script() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

std::vector<std::string> run(const std::string& interpreter, const std::string& program) {
  const Script script(program);
  if (script.path.empty()) return {};
  const auto command = interpreter + " '" + script.path + "' 2>/dev/null";
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

}  // namespace

std::vector<std::string> run_python(const std::string& program) { return run("python3 -W ignore", program); }

std::vector<std::string> run_node(const std::string& program) { return run("node", program); }

}  // namespace turnpoint::benchmark
