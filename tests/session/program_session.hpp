#pragma once
#include <string>
#include <vector>

#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "tests/session/live_room.hpp"
#include "tests/session/written_program.hpp"
#include "tests/support/quick_rig.hpp"

/// A session of a few quick trials, whose levels come from the program `p` in a temporary folder.
struct ProgramSession {
  static constexpr int trials = 8;
  TemporaryFolder folder;
  turnpoint::session::Setup setup;

  explicit ProgramSession(const std::string& program = shell_procedure(), const std::string& limit_s = "30") {
    using namespace turnpoint;
    write(program);
    setup = live_room::live_setup(folder / "a.sqlite");
    setup.rig = quick_rig();
    auto text =
        replaced(live_room::protocol_text("buttons"), R"(kind = "constant-stimuli"
level = "offset_mm"
values = [-20.0, 20.0]
repeats = 1
)",
                 "kind = \"program\"\nprogram = \"p\"\nlevel = \"offset_mm\"\nmin = -24.0\nmax = 24.0\n"
                 "stop = { trials = " +
                     std::to_string(trials) + " }\nlimit_s = " + limit_s + "\n");
    setup.protocol = protocol::parse(text, folder / "study.toml");
    setup.observer = "sim";
    setup.run_mode = core::RunMode::simulated;
  }

  void write(const std::string& program) const { written_program(folder / "p", program); }

  turnpoint::session::Summary run() const {
    turnpoint::session::Inputs inputs;
    return turnpoint::session::run(setup, nullptr, inputs);
  }
  /// Continues the interrupted session.
  turnpoint::session::Summary resume(const std::string& session) const {
    auto again = setup;
    again.resume_session = session;
    turnpoint::session::Inputs inputs;
    return turnpoint::session::run(again, nullptr, inputs);
  }
  turnpoint::store::StoredSession stored(const std::string& session) const {
    return turnpoint::store::read_session(setup.database, session);
  }
  /// What is stored about each trial that counts, without the times, which a pause changes.
  std::vector<std::string> rows(const std::string& session) const {
    std::vector<std::string> rows;
    for (const auto& block : stored(session).blocks)
      for (const auto& row : block.trials)
        if (row.outcome != turnpoint::core::Outcome::aborted)
          rows.push_back(std::to_string(row.trial_in_block) + " " + std::to_string(row.level.value_or(0)) +
                         " " + row.given.response.value_or("-") + " " +
                         std::to_string(row.timing.response_time_s.value_or(-1)) + " " +
                         std::to_string(row.learned.state_hash) + " " +
                         std::to_string(row.learned.threshold_est.value_or(99)));
    return rows;
  }
};
