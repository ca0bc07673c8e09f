#include "tests/endurance/station.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include "station/core/canonical.hpp"
#include "station/session/prepare.hpp"
#include "station/session/programs.hpp"
#include "station/session/replay.hpp"
#include "station/session/session_run.hpp"
#include "station/store/error.hpp"
#include "station/store/read.hpp"
#include "station/store/sqlite.hpp"
#include "tests/support/simulated_run.hpp"

namespace endurance {

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

// A session that needs more processes than this counts as one that cannot be completed.
constexpr int kLivesAtMost = 400;
constexpr std::int64_t kRest_ns =
    2'400'000'000'000;  // longer than the half hour without stimuli that ends a period of exposure

session::Setup prepare(const std::string& protocol, const std::string& database, std::uint64_t seed) {
  auto request = simulated_run(TURNPOINT_SOURCE_DIR "/protocols/" + protocol, database, seed);
  request.headless = true;
  return session::prepare(request);
}

/// Makes the setup behave like a live session: an operator must arm, and the finger's limits apply.
session::Setup as_live(session::Setup setup) {
  setup.observer.clear();
  setup.run_mode = core::RunMode::live;
  setup.sound = {{1000, 60}, {80000, 60}};
  return setup;
}

core::SessionStart start_of(const session::Setup& setup) {
  core::SessionStart start;
  start.participant = setup.participant;
  start.run_mode = setup.run_mode;
  start.protocol_id = setup.protocol.id;
  start.protocol_version = setup.protocol.version;
  start.protocol_path = setup.protocol.path;
  start.protocol_text = setup.protocol.source;
  start.protocol_sha256 = setup.protocol.sha256;
  start.protocol_canonical = core::canonical(core::parse_toml(setup.protocol.source, setup.protocol.path));
  for (const auto& factor : setup.protocol.factors) start.factor_columns.push_back(factor.name);
  start.rig_name = setup.rig.name;
  start.rig_text = setup.rig.source;
  start.rig_sha256 = setup.rig.sha256;
  start.seed = *setup.seed;
  start.language = setup.language;
  start.software_version = TURNPOINT_VERSION;
  start.columns_version = "1";
  start.station_id = "endurance";
  return start;
}

/// Remembers each trial that the session reports as stored.
struct Acknowledgements : session::Monitor {
  World& world;
  const Room& room;
  std::string session_id;
  const bool& dead;

  Acknowledgements(World& w, const Room& r, std::string id, const bool& d)
      : world(w), room(r), session_id(std::move(id)), dead(d) {}
  void trial_ended(const trial::TrialSpec&, const core::TrialRow& row) override {
    if (dead) return;  // the simulated process is dead, so ignore its reports
    world.trials.acknowledged(session_id, row);
    const auto answered_ns =
        row.timing.onset_ns + static_cast<std::int64_t>(row.timing.response_time_s.value_or(0) * 1e9);
    world.amplifier.trial_ended(room.world_ns(), row.outcome == core::Outcome::answered,
                                room.world_ns() - room.age_ns() + answered_ns);
  }
};

}  // namespace

Station::Station(World& world)
    : world_(world),
      lossy_(world.plant == Plant::careless_disk ? LossyDisk::Syncs::ignored : LossyDisk::Syncs::kept),
      database_(folder_ / "0/a.sqlite") {
  fs::create_directory(folder_ / "0");
  world_.trials.new_database();
  lossy_.at_each_operation([this] {
    if (operations_left_ > 0 && --operations_left_ == 0) take_files(death_);
  });
}

Disk Station::disk() {
  return {[this](Fault how) { take_files(how); },
          [this](Fault how, int operations) { death_ = how, operations_left_ = operations; },
          [this](std::int64_t bytes) { bytes < 0 ? full_.space_again() : full_.bytes_left(bytes); },
          [this] { return dead_; }};
}

/// Copies the database's files to a separate folder, unchanged or as a power cut leaves them.
void Station::take_files(Fault how) {
  if (std::exchange(dead_, true)) return;
  const auto into = folder_ / std::to_string(deaths_ + 1);
  fs::create_directory(into);
  if (how == Fault::power_cut || how == Fault::power_cut_in_write)
    return lossy_.cut(database_, into, static_cast<std::uint64_t>(world_.course.between(0, INT32_MAX)));
  for (const char* suffix : {"", "-wal"})
    if (fs::exists(database_ + suffix)) fs::copy_file(database_ + suffix, into + "/a.sqlite" + suffix);
}

/// Called after the process has died. Checks the files that it left, and continues with them.
void Station::bury(const std::string& how) {
  operations_left_ = 0;
  full_.space_again();
  if (std::exchange(dead_, false)) {
    lossy_.forget(database_);
    fs::remove_all(fs::path(database_).parent_path());
    database_ = folder_ / (std::to_string(++deaths_) + "/a.sqlite");
  }
  if (world_.plant == Plant::lost_trial && fs::exists(database_))
    store::Database(database_, store::Database::Access::read_write)
        .execute(
            "DROP TRIGGER IF EXISTS trial_is_never_deleted; DROP TRIGGER IF EXISTS tone_is_never_deleted;"
            "DELETE FROM tone WHERE trial_index = (SELECT max(trial_index) FROM trial);"
            "DELETE FROM trial WHERE trial_index = (SELECT max(trial_index) FROM trial)");
  world_.trials.check(database_, how);
  static std::vector<std::string> leaked;
  if (world_.plant == Plant::leak) leaked.emplace_back(1U << 20U, 'x');
  world_.memory.sample();
}

/// Runs the session in one process. Returns true if the session came to its end.
bool Station::live(session::Setup setup) {
  ++lives;
  setup.database = database_;
  const auto now_ns = world_.now_ns + world_.wall_offset_ns;
  const double now_s = 1e-9 * static_cast<double>(now_ns);
  const auto limits = session::limits_of(setup.rig, setup.run_mode);
  const auto interrupted = fs::exists(database_) ? store::interrupted_session(database_) : std::nullopt;
  const auto segment =
      core::SegmentStart{std::to_string(lives), interrupted ? "resume" : "start", 0, 0, now_ns};
  session::FingerAccount account(
      limits, session::read_finger_history(database_, setup.participant, segment, limits.continuous_s), 0,
      now_s);
  if (interrupted) setup.resume_session = interrupted->session.session_id;
  session::Programs programs(setup.protocol.path);  // this protocol names none
  std::optional<trial::Director> director;
  session::Earlier earlier;
  if (interrupted) {
    auto stored = store::read_session(database_, setup.resume_session);
    director.emplace(session::replayed(setup, stored, programs));
    earlier = {std::move(stored.events), std::move(stored.blocks)};
  }
  auto log = interrupted ? store::SessionLog::resume(database_, setup.resume_session, segment)
                         : store::SessionLog::begin(database_, start_of(setup), segment);
  if (!director) director.emplace(setup.protocol, log.session().sequence_index, *setup.seed);
  const auto id = session_id_ = log.session().session_id;
  const auto stream = session::stream_of(setup.rig);
  session::Inputs nobody;
  session::SimulatedParticipant participant(simulation::Observer(simulation::parse("sim")));
  auto owned = std::make_unique<Room>(world_, disk(), session::virtual_stage(stream, participant, nobody),
                                      stream.output.rate_Hz);
  Room& room = *owned;
  Acknowledgements monitor(world_, room, id, dead_);
  session::SessionRun run(setup, std::move(*director), std::move(log), earlier, std::move(owned),
                          std::move(account), &participant, &room, &monitor);
  const auto summary = run.run();
  if (summary.reason.find("session's time") != std::string::npos) world_.now_ns += kRest_ns;
  return !dead_ &&
         (summary.status == core::SessionStatus::completed || summary.status == core::SessionStatus::stopped);
}

Station::Ending Station::give_up(const std::string& why) {
  world_.violations.push_back("station: " + why);
  return Ending::unusable;
}

/// Runs the session until it, or the process that it runs in, has ended. Problems that the station's own
/// checks find also count as violations.
Station::Ending Station::live_and_die(const session::Setup& setup) {
  std::string how = "its end";
  auto ending = Ending::on_the_way;
  try {
    if (live(setup)) ending = Ending::session_over;
  } catch (const Died& death) {
    how = death.what();
  } catch (const store::StoreError& error) {
    how = error.what();
    if (error.kind() != store::ErrorKind::disk_full && !dead_) return give_up(how);
  } catch (const std::exception& error) {
    return give_up(error.what());
  }
  bury(how);
  world_.now_ns += world_.course.seconds(5, 120);  // the time until somebody notices the death
  return ending;
}

bool Station::run_session(const std::string& protocol, std::uint64_t seed) {
  const auto unbroken = folder_ / "unbroken.sqlite";
  auto setup = prepare(protocol, unbroken, seed);
  session::Inputs nobody;
  session::run(setup, nullptr, nobody);
  setup = as_live(std::move(setup));
  auto ending = Ending::on_the_way;
  for (int life = 0; ending == Ending::on_the_way && world_.session_ns < world_.end_ns; ++life) {
    ending = live_and_die(setup);
    if (life < kLivesAtMost) continue;
    ending = give_up(protocol + " does not come to its end");
  }
  if (ending == Ending::session_over) {
    ++sessions;
    world_.trials.compare(database_, session_id_, unbroken);
  }
  for (const char* suffix : {"", "-wal", "-shm", ".lock"}) fs::remove(unbroken + suffix);
  lossy_.forget(unbroken);
  return ending != Ending::unusable;
}

}  // namespace endurance
