// Runs the fuzz target if libFuzzer is not available: fuzz_protocol RUNS FOLDER... It is deterministic: run N
// with the same folders always uses the same bytes, so a failure can be repeated by its number.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "station/core/draws.hpp"
#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"

using turnpoint::core::Draws;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

const char* const tokens[] = {"nan",  "-inf", "[",   "]",      "{",     "}",
                              "\"",   "=",    "0",   "-1",     "1e308", "9223372036854775807",
                              "[[",   "]]",   "# ",  "\n",     "base",  "copy",
                              "true", "[]",   "{}",  "levels", "range", "values = []\n",
                              "\xff", "\x00", "''",  ".",      "grid.", "abs(",
                              "*",    "/ 0",  "1_0", "0x7f",   "\t",    "[scene.a]\n"};

// Makes one to eight small changes: inserts a token, cuts bytes out, changes a byte, moves or duplicates a
// line.
std::string mutated(std::string text, const std::string& other, Draws& draws) {
  const auto position = [&] { return static_cast<std::size_t>(draws.below(text.size() + 1)); };
  const auto changes = 1 + draws.below(8);
  for (std::uint64_t i = 0; i < changes; ++i) {
    const auto at = position();
    switch (draws.below(5)) {
      case 0:
        text.insert(at, tokens[draws.below(std::size(tokens))]);
        break;
      case 1:
        text.erase(at, 1 + draws.below(20));
        break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(draws.below(256));
        break;
      case 3: {
        const auto end = std::min(text.size(), text.find('\n', at));
        text.insert(position(), text.substr(at, end - at) + "\n");
        break;
      }
      default: {
        const auto from = draws.below(other.size() + 1);
        text.insert(at, other.substr(from, 1 + draws.below(200)));
      }
    }
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  const auto runs = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 0;
  std::vector<std::string> paths, seeds;
  for (int i = 2; i < argc; ++i)
    for (const auto& entry : std::filesystem::directory_iterator(argv[i]))
      if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) seeds.push_back(turnpoint::core::read_file(path));
  if (runs == 0 || seeds.empty()) return std::fprintf(stderr, "usage: fuzz_protocol RUNS FOLDER...\n"), 2;
  for (unsigned long run = 0; run < runs; ++run) {
    Draws draws({run});
    const auto& seed = seeds[draws.below(seeds.size())];
    const auto text = mutated(seed, seeds[draws.below(seeds.size())], draws);
    std::fprintf(stderr, "\rrun %lu", run);
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  std::fprintf(stderr, "\n%lu runs from %zu files\n", runs, seeds.size());
}
