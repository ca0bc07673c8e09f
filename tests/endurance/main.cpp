// endurance [--hours H] [--seed N] [--every S] [--plant NAME]: runs sessions for hours on the virtual clock.
// A fault, drawn from the seed, happens about every S seconds. Exits with 1 if a trial that was reported as
// stored is lost, if the amplifier was on when it must not be, if the memory use grew, or if a session
// differed from one without faults.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>

#include "tests/endurance/station.hpp"

namespace {

using namespace endurance;

constexpr const char* kProtocols[] = {
    "demo.toml",           "boundary-adaptive.toml", "boundary-adjustment.toml",
    "speed-accuracy.toml", "friction-2ifc.toml",     "two-spots-oddity.toml"};
constexpr double kGrowthAllowed_MiB = 4;

struct Request {
  double hours = 1, every_s = 40;
  std::uint64_t seed = 1;
  Plant plant = Plant::none;
};

Plant plant_of(const std::string& text) {
  static const std::map<std::string, Plant> kPlants = {{"none", Plant::none},
                                                       {"deaf-guard", Plant::deaf_guard},
                                                       {"never-off", Plant::never_off},
                                                       {"lost-trial", Plant::lost_trial},
                                                       {"careless-disk", Plant::careless_disk},
                                                       {"leak", Plant::leak}};
  const auto found = kPlants.find(text);
  if (found == kPlants.end()) throw std::invalid_argument("--plant " + text);
  return found->second;
}

Request parse(int argc, char** argv) {
  Request request;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--hours")
      request.hours = std::stod(value);
    else if (key == "--every")
      request.every_s = std::stod(value);
    else if (key == "--seed")
      request.seed = std::stoull(value);
    else if (key == "--plant")
      request.plant = plant_of(value);
    else
      throw std::invalid_argument(key + "; allowed --hours, --every, --seed, --plant");
  }
  return request;
}

struct Tally {
  int sessions = 0, lives = 0, days = 0;
};

/// Each round of protocols has a new database, so that memory does not grow just because the database does.
Tally run(World& world, const Request& request) {
  Tally tally;
  world.end_ns = static_cast<std::int64_t>(request.hours * 3600e9);
  while (world.session_ns < world.end_ns) {
    Station station(world);
    for (const auto* protocol : kProtocols) {
      if (world.session_ns >= world.end_ns) break;
      if (!station.run_session(protocol, request.seed * 1000 + static_cast<std::uint64_t>(tally.days))) break;
    }
    tally.sessions += station.sessions;
    tally.lives += station.lives;
    ++tally.days;
  }
  return tally;
}

void print(const World& world, const Tally& tally, double spent_s) {
  int faults = 0;
  for (int i = 0; i < kFaults; ++i) {
    const auto count = world.course.count[static_cast<std::size_t>(i)];
    std::cout << fmt::format("  {:<22}{:5}\n", name(static_cast<Fault>(i)), count);
    faults += count;
  }
  std::cout << fmt::format(
      "{} faults in {:.1f} h of session ({:.0f} s): {} sessions in {} lives, {} trials acknowledged, {} "
      "lost;\n"
      "amplifier switched {} times, on for {:.0f} s; memory {:.1f} MiB, grown by {:.1f} in {} samples\n",
      faults, 1e-9 / 3600 * static_cast<double>(world.session_ns), spent_s, tally.sessions, tally.lives,
      world.trials.total(), world.trials.lost(), world.amplifier.changes(), world.amplifier.high_s(),
      world.memory.last_MiB(), world.memory.growth_MiB(), world.memory.samples());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto request = parse(argc, argv);
    World world(Course(request.seed, request.every_s), request.plant);
    world.next_fault_ns = world.course.until_next_ns();
    const auto begin = std::chrono::steady_clock::now();
    const auto tally = run(world, request);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    print(world, tally, spent.count());
    if (const auto growth = world.memory.growth_MiB(); growth > kGrowthAllowed_MiB)
      world.violations.push_back(fmt::format("memory: grown by {:.1f} MiB in the second half", growth));
    for (std::size_t i = 0; i < world.violations.size() && i < 20; ++i)
      std::cout << "VIOLATION " << world.violations[i] << '\n';
    std::cout << fmt::format("{} violations\n", world.violations.size());
    return world.violations.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "endurance: " << error.what() << '\n';
    return 2;
  }
}
