#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/session/inputs.hpp"
#include "station/session/monitor.hpp"
#include "station/session/page.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::session {

/// Where an interrupted session goes on. What was done stays in the log, whatever is chosen.
enum class ResumeAt { next_trial, block_start, session_start };

/// Everything a sitting needs, already loaded and checked.
struct Setup {
  rig::Rig rig;
  protocol::Protocol protocol;
  std::string participant;
  std::string database;
  store::RunMode run_mode = store::RunMode::pilot;
  std::string language;
  std::string observer;  ///< "" for a person; else the text after `sim` ("sim", "sim:threshold=...")
  std::optional<std::uint64_t> seed;
  std::string resume_session;  ///< session to go on with; "" begins a new one
  ResumeAt resume_at = ResumeAt::next_trial;
  std::string consent_version;  ///< of the consent form that the participant signed; "" where none was asked
  double response_offset_s =
      0;  ///< the response device's own latency, stored with each answer, never subtracted
};

/// How a sitting ended, for people and for --json.
struct Summary {
  std::string session_id, participant, protocol_id, database, run_mode;
  store::SessionStatus status = store::SessionStatus::running;
  std::string reason;
  std::uint64_t seed = 0;
  int blocks = 0, trials = 0, answered = 0, timeouts = 0, anticipations = 0, voided = 0;
  std::optional<double> accuracy;  ///< of scored, answered, experimental trials
  double duration_s = 0;           ///< on the session's own clock
  int xruns = 0;
  struct Estimate {
    std::string procedure, parameter;
    double mean = 0, sd = 0;
  };
  std::vector<Estimate> estimates;
};

/// Runs one sitting to its end on the calling thread: real clock, pages to `display`, input from `inputs`.
/// With an observer in the setup it runs on the virtual clock and `display` may be null. `monitor` may be
/// null. Throws text::BadInput for a setup that cannot run, store::StoreError, std::system_error for devices.
Summary run(const Setup& setup, Display* display, Inputs& inputs, Monitor* monitor = nullptr);

}  // namespace turnpoint::session
