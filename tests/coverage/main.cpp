// coverage [--folder DIR] [--sessions N] [--procedure NAME] [--references N] [--threads N] [--table]:
// measures how often the report's 95 % intervals for adaptive data contain the true value. Saves each session
// in DIR and continues where it was stopped; prints the table of all saved sessions. Exits with 1 if an
// interval does not have the promised coverage or a cell has fewer sessions than requested.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "station/rehearsal/parallel.hpp"
#include "tests/coverage/table.hpp"

namespace {

using namespace coverage;

struct Request {
  std::string folder = "build/coverage";
  std::vector<std::string> procedures = kProcedures;
  int sessions = 2000, references = 60, threads = 1;
  bool table_only = false;
};

/// Sessions are saved each time this many are finished.
constexpr std::size_t kPart = 20;

std::string file_of(const Request& request, const std::string& procedure, std::size_t source) {
  return fmt::format("{}/{}-{}.csv", request.folder, procedure, source);
}

void simulate(const Request& request, const std::string& procedure, std::size_t source) {
  const auto path = file_of(request, procedure, source);
  const Design design(procedure);
  auto missing = missing_seeds(read(path), request.sessions);
  while (!missing.empty()) {
    const auto part = std::min(kPart, missing.size());
    std::vector<Session> sessions(part);
    turnpoint::rehearsal::in_parallel(static_cast<int>(part), request.threads, {}, [&](int i) {
      const auto seed = missing[static_cast<std::size_t>(i)];
      sessions[static_cast<std::size_t>(i)] =
          design.run(sources()[source], seed, seed <= static_cast<std::uint64_t>(request.references));
    });
    append(path, sessions);
    missing.erase(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(part));
    fmt::print(stderr, "\r{}, {}: {} of {}   ", procedure, sources()[source].name,
               request.sessions - static_cast<int>(missing.size()), request.sessions);
  }
}

std::string cell(const Tally& tally, const std::string& broken) {
  if (tally.printed == 0) return "none printed";
  auto text = fmt::format("{:.1f} ± {:.1f} % ({:.1f} %, {})", 100 * tally.coverage(),
                          100 * tally.standard_error(), 100 * tally.abstained(),
                          tally.width_ratio ? fmt::format("{:.2f}", *tally.width_ratio) : "-");
  return broken.empty() ? text : text + " BROKEN:" + broken;
}

/// Prints the table. Returns true if every cell keeps its promises and has the requested number of sessions.
bool print_table(const Request& request) {
  fmt::print("| procedure | true values | trials | sessions | threshold | slope | 75 % point |\n");
  fmt::print("|---|---|---|---|---|---|---|\n");
  bool kept = true;
  for (const auto& procedure : request.procedures)
    for (std::size_t source = 0; source < sources().size(); ++source) {
      const auto sessions = read(file_of(request, procedure, source));
      kept = kept && missing_seeds(sessions, request.sessions).empty();
      if (sessions.empty()) continue;
      for (std::size_t t = 0; t < kTrials.size(); ++t) {
        fmt::print("| {} | {} | {} | {} |", procedure, sources()[source].name, kTrials[t], sessions.size());
        for (const auto quantity : {threshold, slope, level_75}) {
          const auto found = tally(sessions, t, quantity);
          const auto broken = broken_promise(found, sources()[source], quantity, kTrials[t]);
          kept = kept && broken.empty();
          fmt::print(" {} |", cell(found, broken));
        }
        fmt::print("\n");
      }
    }
  return kept;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("How often the report's 95 % intervals of adaptive data hold the true value");
  app.add_option("--folder", request.folder,
                 "Folder of saved sessions; continues with those that it contains")
      ->capture_default_str();
  app.add_option("--procedure", request.procedures, "Only these")->check(CLI::IsMember(kProcedures));
  app.add_option("--sessions", request.sessions, "Of each cell")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--references", request.references,
                 "As many of them, the first, also have the width of the reference; takes most of the time")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--threads", request.threads, "At once")->capture_default_str()->check(CLI::PositiveNumber);
  app.add_flag("--table", request.table_only, "Only print what is there");
  CLI11_PARSE(app, argc, argv);
  try {
    std::filesystem::create_directories(request.folder);
    if (!request.table_only)
      for (const auto& procedure : request.procedures)
        for (std::size_t source = 0; source < sources().size(); ++source)
          simulate(request, procedure, source);
    return print_table(request) ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "coverage: " << error.what() << "\n";
    return 2;
  }
}
