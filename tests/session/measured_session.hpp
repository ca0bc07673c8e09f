#pragma once
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "station/session/prepare.hpp"
#include "station/session/session.hpp"
#include "station/session/simulated_room.hpp"
#include "station/store/read.hpp"
#include "station/store/stored_signals.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

// Helpers for tests: simulated sessions on a rig with capture channels, and faults in the simulated room.
namespace measured {

using namespace turnpoint;

inline const std::string kSource = TURNPOINT_SOURCE_DIR;

inline const char* const kPickUps = "uri = \"sim:\"\nchannels = 4\npickups = [1, 2]\n";
inline const char* const kCells =
    "uri = \"sim:\"\nchannels = 8\npickups = [5, 6]\nreference = 0\nexcitation_channel = 3\nbridges = [1, 2, "
    "3]\n";

/// Writes the rig with the thin plate to a file, with this [capture] table added.
inline std::string with_capture(const TemporaryFolder& folder, const std::string& capture) {
  std::ostringstream rig;
  rig << std::ifstream(kSource + "/tests/support/thin_plate.toml").rdbuf() << "\n[capture]\n" << capture;
  const auto path = folder / "measured.toml";
  std::ofstream(path) << rig.str();
  return path;
}

/// Adds faults to the room when a trial begins, and repairs them when it ends.
struct Saboteur : session::Monitor {
  std::function<void(int trial)> before, after;
  int trials = 0;
  void trial_begins(const trial::TrialSpec&, const protocol::Block&,
                    const session::PlanAhead::Plans&) override {
    before(trials);
  }
  void trial_ended(const trial::TrialSpec&, const core::TrialRow&) override { after(trials++); }
};

/// Remembers the fault pages of a session.
struct Pages : session::Display {
  std::vector<std::string> faults, messages;
  void show(const session::Page& page) override {
    if (page.kind == session::PageKind::fault) faults.push_back(page.fault.detail);
    if (page.kind == session::PageKind::feedback && !page.correct && !page.text.empty())
      messages.push_back(page.text);
  }
};

struct Ran {
  session::Summary summary;
  std::vector<core::TrialRow> trials;
  std::vector<std::string> faults;
  /// texts of the pages after a trial, except for those that say whether an answer was right
  std::vector<std::string> messages;
  std::vector<core::EventRow> events;
  std::vector<store::StoredSignal> raw;  ///< what was captured in void trials
};

/// A function that changes the simulated laboratory before each trial, for example by adding faults.
using Sabotage = std::function<void(int trial, simulation::Plant& plant)>;

struct How {
  std::string capture = kPickUps;
  bool repaired = true;  ///< true if each fault is repaired after one trial
  std::string observer = "sim";
  std::function<void(simulation::Setup&)> room = {};  ///< changes the simulated laboratory before the session
};

/// Asks for a simulated session of a protocol file on a rig with these capture channels.
inline session::RunRequest request_in(const TemporaryFolder& folder, const std::string& protocol,
                                      const std::string& capture = kCells,
                                      const std::string& observer = "sim") {
  auto request = simulated_run(protocol, folder / "a.sqlite", 7);
  request.rig = with_capture(folder, capture);
  request.observer = observer;
  return request;
}

/// Runs a session of a protocol file in a simulated room, in which `sabotage` causes faults.
inline Ran run(const std::string& protocol, const Sabotage& sabotage, const How& how = {}) {
  TemporaryFolder folder;
  const auto request = request_in(folder, protocol, how.capture, how.observer);
  const auto setup = session::prepare(request);
  auto room = std::make_unique<session::SimulatedRoom>(setup.rig, how.room);
  Saboteur saboteur;
  auto& plant = room->plant();
  saboteur.before = [&](int trial) { sabotage(trial, plant); };
  saboteur.after = [&](int) {
    if (how.repaired) plant.repair();
  };
  Pages pages;
  session::Inputs inputs;
  Ran ran;
  ran.summary = session::run(setup, &pages, inputs, std::move(room), &saboteur);
  const auto stored = store::read_session(request.database, ran.summary.session_id);
  ran.events = stored.events;
  store::Database database(request.database, store::Database::Access::read_only);
  store::SignalReader reader(database, ran.summary.session_id, core::kRawStream);
  while (const auto signal = reader.next()) ran.raw.push_back(*signal);
  for (const auto& block : stored.blocks)
    ran.trials.insert(ran.trials.end(), block.trials.begin(), block.trials.end());
  ran.faults = pages.faults;
  ran.messages = pages.messages;
  return ran;
}

inline std::string shipped(const std::string& name) { return kSource + "/protocols/" + name + ".toml"; }

}  // namespace measured
