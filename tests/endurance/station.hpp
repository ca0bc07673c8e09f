#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "station/session/session.hpp"
#include "tests/endurance/room.hpp"
#include "tests/store/failing_disk.hpp"
#include "tests/store/lossy_disk.hpp"
#include "tests/support/temporary_folder.hpp"

namespace endurance {

/// A database and a participant's sessions in it. After each death of the station's process, the files that
/// it left are checked, and the sessions continue with these files. Uses the station's own session, store,
/// procedures, planner, drive and guard.
class Station {
 public:
  explicit Station(World& world);

  /// Runs a session of this protocol from beginning to end, in as many processes as it takes, and compares it
  /// with a session without faults. Stops early if the run's time is over. Returns false if the database can
  /// no longer be used.
  bool run_session(const std::string& protocol, std::uint64_t seed);

  int lives = 0, sessions = 0;

 private:
  enum class Ending { on_the_way, session_over, unusable };

  Ending live_and_die(const turnpoint::session::Setup& setup);
  Ending give_up(const std::string& why);
  bool live(turnpoint::session::Setup setup);
  void take_files(Fault how);
  void bury(const std::string& how);
  Disk disk();

  World& world_;
  TemporaryFolder folder_;
  FailingDisk full_;
  LossyDisk lossy_;
  std::string database_, session_id_;
  int deaths_ = 0, operations_left_ = 0;
  Fault death_ = Fault::kill;
  bool dead_ = false;
};

}  // namespace endurance
