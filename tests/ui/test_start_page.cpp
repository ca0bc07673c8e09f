#include <QCoreApplication>
#include <QDate>
#include <QTimer>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "station/session/planned_session.hpp"
#include "station/session/prepare.hpp"
#include "station/store/backup.hpp"
#include "station/store/open.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/system/clocks.hpp"
#include "station/ui/operator/operator_controller.hpp"
#include "station/ui/shared/operator_screen.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/small_disk.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/ui/event_loop.hpp"

using namespace turnpoint;
using ui::OperatorController;

namespace {

const std::string kSource = TURNPOINT_SOURCE_DIR;
/// The longest time that a test waits. It is long enough for a busy machine, and only ends a test that hangs.
constexpr std::chrono::seconds kPatience{20};

/// Simulates checks of protocols. Each takes until the test ends it, even if its result is no longer needed.
class HeldChecks {
 public:
  rehearsal::Check operator()(const std::string& protocol, const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    begun_.push_back(std::filesystem::path(protocol).filename());
    running_ = stop;
    changed_.notify_all();
    changed_.wait_for(lock, kPatience, [this] { return open_; });
    ++ended_;
    rehearsal::Check check;
    check.rig_name = begun_.back();
    return check;
  }

  void let_go() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  std::vector<std::string> begun() {
    const std::lock_guard lock(mutex_);
    return begun_;
  }
  int ended() {
    const std::lock_guard lock(mutex_);
    return ended_;
  }
  bool running_is_abandoned() {
    const std::lock_guard lock(mutex_);
    return running_.stop_requested();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> begun_;
  std::stop_token running_;
  int ended_ = 0;
  bool open_ = false;
};

/// The start page without its window. It has three protocols, of which one cannot be used.
struct StartPage {
  EventLoop<> loop;
  TemporaryFolder folder;
  HeldChecks checks;
  int events = 0;
  QTimer ticks;
  std::unique_ptr<OperatorController> page;

  StartPage() {
    for (const auto* file : {"a.toml", "b.toml"})
      std::filesystem::copy_file(kSource + "/protocols/demo.toml", folder / file);
    std::ofstream(folder / "c.toml") << "format = 3\n";
    QObject::connect(&ticks, &QTimer::timeout, [this] { ++events; });
    ticks.start(0);
  }
  ~StartPage() { checks.let_go(); }

  void open() { open(folder / "lab.sqlite"); }
  void open(const std::string& database) {
    page = std::make_unique<OperatorController>(
        session::StationRequest{folder.path, kSource + "/tests/support/thin_plate.toml", database},
        [this](const std::string& protocol, const std::string&, const std::stop_token& stop) {
          return checks(protocol, stop);
        });
  }

  template <typename Condition>
  bool comes(Condition condition) {
    const auto until = std::chrono::steady_clock::now() + kPatience;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > until) return false;
      QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
    }
    return true;
  }

  std::string shown() const {
    for (const auto& fact : page->facts())
      if (fact.toMap()["label"].toMap()["key"] == "operator.rig")
        return fact.toMap()["value"].toString().toStdString();
    return "";
  }
};

/// The words of phrases as the pages get them.
std::string to_text(const QVariant& phrases) {
  std::string all;
  if (phrases.typeId() == QMetaType::QString) return phrases.toString().toStdString();
  for (const auto& one : phrases.toList()) all += to_text(one) + " ";
  if (const auto map = phrases.toMap(); map.contains("key")) {
    if (const auto key = map["key"].toString().toStdString(); !key.empty())
      all += core::text(key, "en") + " ";
    all += to_text(map["values"]);
  }
  return all;
}

}  // namespace

TEST_CASE("choosing another protocol abandons the running check, and the page never waits for it",
          "[start]") {
  StartPage start;
  start.open();
  REQUIRE(start.comes([&] { return start.checks.begun().size() == 1; }));
  start.page->select(1);
  start.page->select(0);
  start.page->select(1);
  CHECK(start.checks.ended() == 0);  // select() returned although the first check is still running
  CHECK(start.checks.running_is_abandoned());
  const int before = start.events;
  CHECK(start.comes([&] { return start.events >= before + 1000; }));
  CHECK(start.checks.ended() == 0);
  CHECK(start.page->checking());

  start.checks.let_go();
  REQUIRE(start.comes([&] { return !start.page->checking(); }));
  CHECK(start.shown() == "b.toml");
  CHECK(start.checks.begun() ==
        std::vector<std::string>{"a.toml",
                                 "b.toml"});  // checks that were replaced while they waited never began
}

TEST_CASE("the result of a check that ends late is not shown for a protocol that was chosen later",
          "[start]") {
  StartPage start;
  start.open();
  REQUIRE(start.comes([&] { return start.checks.begun().size() == 1; }));
  start.page->select(2);
  CHECK_FALSE(start.page->checking());
  start.checks.let_go();
  REQUIRE(start.comes([&] { return start.checks.ended() == 1; }));
  const int before = start.events;
  REQUIRE(start.comes([&] { return start.events >= before + 10; }));
  CHECK(start.shown().empty());
  CHECK_FALSE(start.page->problems().empty());
  for (const auto& problem : start.page->problems())
    CHECK(problem.toMap()["values"].toList().first().toString().contains("c.toml:"));
}

TEST_CASE("a failed attempt to resume a session does not change the check of the chosen protocol",
          "[start]") {
  StartPage start;
  auto request = simulated_run(kSource + "/protocols/demo.toml", start.folder / "lab.sqlite");
  struct Cut : session::Monitor {
    void trial_ended(const trial::TrialSpec&, const core::TrialRow&) override {
      throw std::runtime_error("cut");
    }
  } cut;
  session::Inputs inputs;
  CHECK_THROWS(session::run(session::prepare(request), nullptr, inputs, &cut));
  start.open();
  REQUIRE_FALSE(start.page->interrupted().isEmpty());
  REQUIRE(start.comes([&] { return start.checks.begun().size() == 1; }));
  std::ofstream(request.database, std::ios::trunc) << "no database";
  start.page->resume();
  start.checks.let_go();
  REQUIRE(start.comes([&] { return !start.page->checking() && !start.page->preparing(); }));
  CHECK(start.shown() == "a.toml");
  CHECK_FALSE(start.page->problems().empty());
}

TEST_CASE("the start page says how old the last good backup is", "[start]") {
  StartPage start;
  const auto database = start.folder / "lab.sqlite", record = database + ".last-backup";
  core::SessionStart session;
  session.participant = "P01", session.station_id = "lab";
  store::SessionLog::begin(database, session, {}).finish(core::SessionStatus::stopped, "");
  start.open();
  CHECK(start.page->backup()["state"] == "none");

  store::backup(database, {start.folder / "backups"});
  std::string id, time, path;
  std::ifstream(record) >> id >> time >> path;
  const auto aged = [&](double days) {
    const auto at_ns = system::realtime_ns() - static_cast<std::int64_t>(days * 86'400e9);
    std::ofstream(record) << id << "\n" << at_ns << "\n" << path << "\n";
    start.page->refresh();
    return start.page->backup();
  };
  CHECK(aged(0.1)["state"] == "recent");
  CHECK(aged(6.9)["state"] == "recent");
  CHECK(aged(6.9)["hours"] == 165);
  CHECK(aged(7.1)["state"] == "old");
  CHECK(aged(-1)["state"] == "ahead");
}

TEST_CASE("a database of another machine is asked about, and either answer lets sessions begin", "[start]") {
  if (store::machine_identity().empty()) return;  // such a machine is never taken for another one
  StartPage start;
  std::filesystem::copy_file(kSource + "/protocols/friction-training.toml", start.folder / "0.toml");
  const auto path = start.folder / "lab.sqlite";
  core::SessionStart session;
  session.participant = "P01", session.station_id = "bench-1";
  store::SessionLog::begin(path, session, {}).finish(core::SessionStatus::stopped, "");
  const auto id = store::read_station(path).database_id;
  {
    auto writer = store::open_writer(path, store::IfMissing::fail);
    store::move_station(writer.database, "of another board");
  }
  start.open();
  start.checks.let_go();
  REQUIRE(start.comes([&] { return start.page->other_machine() && !start.page->checking(); }));
  CHECK(start.page->station() == "bench-1");
  CHECK_FALSE(start.page->may_begin());
  CHECK(start.page->problems().isEmpty());  // the page asks instead

  SECTION("a name that is not possible changes nothing and says why") {
    const auto before = start.page->problems().size();
    start.page->nameCopy("bench 2");
    REQUIRE(start.comes([&] { return start.page->problems().size() > before; }));
    CHECK(start.page->other_machine());
    CHECK(store::read_station(path).machine == "of another board");
  }
  SECTION("it was replaced") {
    start.page->replaceMachine();
    REQUIRE(start.comes([&] { return !start.page->other_machine(); }));
    CHECK(store::read_station(path).name == "bench-1");
    CHECK(store::read_station(path).database_id == id);
    CHECK(start.comes([&] { return start.page->may_begin(); }));
  }
  SECTION("it is a copy") {
    start.page->nameCopy(" bench-2 ");
    REQUIRE(start.comes([&] { return !start.page->other_machine(); }));
    CHECK(start.page->station() == "bench-2");
    CHECK(store::read_station(path).database_id != id);
    CHECK(start.comes([&] { return start.page->may_begin(); }));
  }
}

TEST_CASE("while the database can record nothing, Begin is disabled and the page says why", "[start]") {
  StartPage start;
  std::filesystem::copy_file(kSource + "/protocols/friction-training.toml", start.folder / "0.toml");
  SmallDisk disk(24);
  const auto database = disk / "lab.sqlite";
  core::SessionStart session;
  session.participant = "P01", session.station_id = store::suggested_station_name();
  store::SessionLog::begin(database, session, {}).finish(core::SessionStatus::completed, "");
  start.open(database);
  start.checks.let_go();
  REQUIRE(start.comes([&] { return start.page->may_begin(); }));
  const auto says = [&](const char* sign, const char* reason) {
    start.page->refresh();
    const auto shown = [&] {
      for (const auto& one : start.page->signs())
        if (const auto map = one.toMap(); map["name"] == "database")
          return map["says"].toMap()["key"].toString().toStdString();
      return std::string();
    };
    REQUIRE(start.comes([&] { return shown() == sign; }));
    CHECK_FALSE(start.page->may_begin());
    const auto problems = to_text(start.page->problems());
    CAPTURE(problems);
    CHECK(problems.find(reason) != std::string::npos);
    int chosen = 0;
    QObject::connect(start.page.get(), &OperatorController::chosen, [&](const auto&) { ++chosen; });
    start.page->begin();
    CHECK_FALSE(start.page->preparing());
    CHECK(chosen == 0);
  };
  const auto is_mended = [&] {
    start.page->refresh();
    return start.comes([&] { return start.page->may_begin(); });
  };
  SECTION("damaged") {
    std::filesystem::rename(database, database + ".good");
    std::ofstream(database) << "rubbish" << std::string(5000, 'x');
    says("state.database_damaged", "not a database");
    std::filesystem::rename(database + ".good", database);
    CHECK(is_mended());
  }
  if (!disk.mounted) {
    WARN("full and write-protected disks are not tested: needs the right to mount a file system");
    return;
  }
  SECTION("full") {
    SmallDisk::fill(disk / "filling");
    says("state.database_full", "free some space, then begin again");
    std::filesystem::remove(disk / "filling");
    CHECK(is_mended());
  }
  SECTION("write-protected") {
    REQUIRE(start.comes([&] { return disk.protect(); }));  // not while the page looks at the database
    says("state.database_read_only", "cannot be written");
  }
}

TEST_CASE("the operator begins a session that comes too early only with a reason, which the session gets",
          "[start]") {
  StartPage start;
  std::filesystem::copy_file(kSource + "/protocols/friction-training.toml", start.folder / "0.toml");
  core::SessionStart today;
  today.participant = "P01", today.protocol_id = "friction-training", today.planned_session = 1;
  today.run_mode = core::RunMode::pilot;
  today.station_id = store::suggested_station_name(), today.started_local = session::local_time();
  store::SessionLog::begin(start.folder / "lab.sqlite", today, {}).finish(core::SessionStatus::completed, "");
  start.open();
  start.checks.let_go();
  REQUIRE(start.comes([&] { return !start.page->checking(); }));
  std::vector<ui::ChosenSession> chosen;
  QObject::connect(start.page.get(), &OperatorController::chosen,
                   [&](const auto& session) { chosen.push_back(session); });
  const auto settled = [&] { return !start.page->preparing(); };
  CHECK(start.page->too_early().isEmpty());
  start.page->beginEarly("not asked for");  // nothing was refused yet
  CHECK(settled());

  start.page->enterParticipant("P01");
  start.page->begin();
  REQUIRE(start.comes(settled));
  const auto early = start.page->too_early();
  CHECK(early["participant"] == "P01");
  CHECK(early["session"] == 2);
  CHECK(early["last"] == 1);
  CHECK(early["minDays"] == 1);
  const auto last_day = QDate::fromString(early["lastDay"].toString(), Qt::ISODate);
  CHECK(last_day.toString(Qt::ISODate).toStdString() == today.started_local.substr(0, 10));
  CHECK(early["from"] == last_day.addDays(1).toString(Qt::ISODate));
  CHECK(start.page->problems().isEmpty());
  CHECK(chosen.empty());
  start.page->beginEarly("  ");  // no reason
  CHECK(settled());
  CHECK_FALSE(start.page->too_early().isEmpty());

  start.page->enterParticipant("P02");  // somebody else, to whom the refusal does not apply
  CHECK(start.page->too_early().isEmpty());
  start.page->beginEarly("leaves the country");
  CHECK(settled());
  start.page->enterParticipant("P01");
  start.page->begin();
  REQUIRE(start.comes(settled));
  start.page->beginEarly(" leaves the country ");
  REQUIRE(start.comes([&] { return !chosen.empty(); }));
  CHECK(chosen[0].setup.early == "leaves the country");
  CHECK(start.page->too_early().isEmpty());
}

TEST_CASE("the operator's pages are offered only in languages that a font can draw", "[start]") {
  const auto codes = [](const turnpoint::ui::OperatorScreen& screen) {
    QStringList list;
    for (const auto& language : screen.languages()) list += language.toMap()["code"].toString();
    return list;
  };
  turnpoint::ui::OperatorScreen latin([](char32_t) { return false; });
  CHECK(codes(latin) == QStringList{"de", "en", "es"});
  latin.set_language("ja");
  CHECK(latin.language() == "en");
  latin.set_language("de");
  CHECK(latin.language() == "de");
  turnpoint::ui::OperatorScreen all([](char32_t) { return true; });
  CHECK(codes(all).size() == 6);
  all.set_language("ja");
  CHECK(all.language() == "ja");
}
