#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "station/session/prepare.hpp"
#include "station/session/session.hpp"
#include "station/session/simulated_room.hpp"
#include "station/session/stage.hpp"
#include "station/session/triggers.hpp"
#include "station/store/read.hpp"
#include "station/view/report_data.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

const std::string kSource = TURNPOINT_SOURCE_DIR;
const std::string kCodes = "\n[marker]\nchannel = 1\nkind = \"code\"\n";
const std::string kReadBack =
    kCodes + "[capture]\nuri = \"sim:\"\nchannels = 4\npickups = [1, 2]\nmarker_channel = 3\n";

struct Ran {
  session::Summary summary;
  std::vector<core::TrialRow> trials;
  std::map<std::string, std::vector<core::EventRow>> events;
  std::string report;  ///< what the report says about the trigger codes
};

/// Runs a shipped protocol. `rig_tables` are added to the file of the simulated rig, and the wire of the
/// marker may be broken during some trials.
Ran run(const std::string& protocol, const std::string& rig_tables,
        const std::function<bool(int trial)>& wire_broken = {}) {
  TemporaryFolder folder;
  std::ostringstream rig;
  rig << std::ifstream(kSource + "/deploy/rigs/simulated.toml").rdbuf() << rig_tables;
  session::RunRequest request;
  request.rig = folder / "rig.toml";
  std::ofstream(request.rig) << rig.str();
  request.protocol = kSource + "/protocols/" + protocol + ".toml";
  request.participant = "P01";
  request.database = folder / "a.sqlite";
  request.observer = "sim";
  request.seed = 7;
  const auto setup = session::prepare(request);
  session::Inputs inputs;
  Ran ran;
  if (!wire_broken) {
    ran.summary = session::run(setup, nullptr, inputs);
  } else {
    struct Breaker : session::Monitor {
      void trial_begins(const trial::TrialSpec&, const protocol::Block&,
                        const session::PlanAhead::Plans&) override {
        room->break_marker_wire(broken(trial));
      }
      void trial_ended(const trial::TrialSpec&, const core::TrialRow&) override { ++trial; }
      session::SimulatedRoom* room = nullptr;
      std::function<bool(int trial)> broken;
      int trial = 0;
    } breaker;
    auto room = std::make_unique<session::SimulatedRoom>(setup.rig);
    breaker.room = room.get(), breaker.broken = wire_broken;
    ran.summary = session::run(setup, nullptr, inputs, std::move(room), &breaker);
  }
  const auto stored = store::read_session(request.database, ran.summary.session_id);
  for (const auto& block : stored.blocks)
    ran.trials.insert(ran.trials.end(), block.trials.begin(), block.trials.end());
  for (const auto& event : stored.events) ran.events[event.kind].push_back(event);
  const auto reports = view::report_data(request.database, ran.summary.session_id);
  for (const auto& [name, text] : reports.front().health)
    if (core::say(name, "en") == "Trigger codes") ran.report = core::say(text, "en");
  return ran;
}

bool contains(const std::string& all, const std::string& part) { return all.find(part) != std::string::npos; }

int count(const std::vector<core::EventRow>& events, const std::string& part) {
  return static_cast<int>(std::count_if(events.begin(), events.end(),
                                        [&](const auto& event) { return contains(event.value, part); }));
}

}  // namespace

TEST_CASE("every event of a session has a row with its code, its frame and its time", "[session][trigger]") {
  auto ran = run("demo", kCodes);
  const auto trials = static_cast<int>(ran.trials.size());
  REQUIRE(trials == 10);
  const auto& rows = ran.events["trigger"];
  CHECK(count(rows, "trial frame") == trials);
  CHECK(count(rows, "onset frame") == trials);
  CHECK(count(rows, "response frame") == trials);
  CHECK(ran.summary.triggers == static_cast<int>(rows.size()));
  CHECK(ran.events["trigger_missed"].empty());
  for (const auto& trial : ran.trials) {
    const auto frame = trial.tones.front().onset_frame;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& event) {
      return contains(event.value, "onset frame " + std::to_string(frame));
    });
    REQUIRE(row != rows.end());
    CHECK(row->trial_index == trial.trial_index);
    CHECK(row->time_ns == Approx(1e9 * static_cast<double>(frame) / 192000).margin(10));
  }
}

TEST_CASE("trials of four intervals have room for the codes of their events", "[session][trigger]") {
  auto ran = run("friction-4ifc", kCodes);
  CHECK(ran.summary.status == core::SessionStatus::completed);
  const auto& rows = ran.events["trigger"];
  CHECK(count(rows, "trial frame") == static_cast<int>(ran.trials.size()));
  CHECK(count(rows, "onset frame") == 4 * static_cast<int>(ran.trials.size()));
}

TEST_CASE("a rig without outputs for codes gives out none", "[session][trigger]") {
  auto ran = run("demo", "");
  CHECK(ran.events["trigger"].empty());
  CHECK(ran.summary.triggers == 0);
  CHECK(ran.report == "none");
}

TEST_CASE("codes on lines are due at the times of their events", "[session][trigger]") {
  auto ran = run("demo", "\n[trigger_lines]\nuri = \"sim:\"\n");
  const auto& rows = ran.events["trigger"];
  CHECK(count(rows, "onset") == 10);
  CHECK(count(rows, "lines +0 us") == static_cast<int>(rows.size()));
}

TEST_CASE("every code that the marker channel carries is read back, at its frame", "[session][trigger]") {
  auto ran = run(GENERATE("demo", "speed-accuracy"), kReadBack);
  const auto& rows = ran.events["trigger"];
  CHECK(rows.size() >= 30);
  CHECK(count(rows, "read back +0.00 frames") == static_cast<int>(rows.size()));
  CHECK(ran.summary.triggers_missed == 0);
  CHECK(ran.summary.triggers_extra == 0);
  for (const auto& trial : ran.trials) CHECK(trial.surface.proof == core::Proof::ok);
}

TEST_CASE("codes that do not come back are missed, and named", "[session][trigger]") {
  auto ran = run("demo", kReadBack, [](int trial) { return trial == 3 || trial == 9; });
  const auto& missed = ran.events["trigger_missed"];
  CHECK(missed.size() == 6);
  for (const auto& row : missed) CHECK((row.trial_index == 3 || row.trial_index == 9));
  CHECK(count(missed, "onset frame") == 2);
  CHECK(ran.summary.triggers_missed == 6);
  CHECK(count(ran.events["trigger"], "read back") == 24);
  CHECK(ran.summary.triggers == 30);
  CHECK(ran.report == "30 sent, 24 read back, 6 missed, 0 that were not sent");
}

TEST_CASE("pulses of another device are stored with their frames and times", "[session][trigger]") {
  auto ran = run("demo", "\n[sync]\nuri = \"sim:\"\n");
  const auto& rows = ran.events["sync"];
  REQUIRE(rows.size() > 10);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK(rows[k].time_ns == static_cast<std::int64_t>(k) * 1'000'000'000);
    CHECK(rows[k].value == "frame " + std::to_string(192000 * k));
  }
  CHECK(ran.trials.size() == 10);
}

namespace {

/// A stream with a marker channel, whose output a TriggerCapture captures.
struct Bench {
  session::TriggerSetup setup;
  std::unique_ptr<audio::SynchronousStream> stream;
  std::unique_ptr<session::Triggers> triggers;
  static constexpr std::int64_t bit = 192, whole = rig::trigger_code_bits * bit;

  Bench() {
    setup.marker.emplace();
    setup.marker->kind = rig::Marker::Kind::code;
    setup.marker->amplitude = 0.45;
    setup.bit_frames = bit;
    setup.marker_channel = 0;
    audio::StreamConfig config;
    config.samples = audio::Samples::passed;
    config.output.uri = "null:";
    config.output.rate_Hz = 192000;
    stream = audio::open_synchronous(config);
    triggers = std::make_unique<session::Triggers>(setup, *stream, nullptr);
  }
  void scheduled(int code, std::int64_t frame) {
    session::Trigger trigger;
    trigger.code = code, trigger.frame = frame, trigger.time_ns = stream->time_of(frame).value();
    triggers->scheduled(trigger);
  }
  /// Returns the state of all trigger codes after these ranges of frames have been captured, in which these
  /// codes were found.
  std::vector<session::Trigger> after(const std::vector<std::pair<std::int64_t, std::int64_t>>& captured,
                                      const std::vector<sensing::DecodedTrigger>& heard = {}) {
    triggers->captured({heard, {}, captured});
    auto done = triggers->take(1'000'000'000);
    extra = std::move(done.extra);
    return done.triggers;
  }
  std::vector<sensing::DecodedTrigger> extra;
};

using ReadBack = session::Trigger::ReadBack;

}  // namespace

TEST_CASE("a code that is sent at once waits for the code before it", "[session][trigger]") {
  Bench bench;
  session::Trigger trigger;
  trigger.code = 5;
  bench.triggers->send(trigger, 0);
  trigger.code = 6;
  bench.triggers->send(trigger, 0);
  CHECK(bench.triggers->free_from() == 2 * Bench::whole);
  const auto done = bench.after({{0, 4 * Bench::whole}}, {{0.2, 5, 0.4}, {Bench::whole - 0.3, 6, 0.4}});
  REQUIRE(done.size() == 2);
  CHECK(done[0].frame == 0);
  CHECK(done[1].frame == Bench::whole);
  CHECK(done[1].read_back == ReadBack::right);
  CHECK(done[1].error_frames == Approx(-0.3));
}

TEST_CASE("the first interval of a trial waits for the code of the trial", "[session][trigger]") {
  Bench bench;
  session::Inputs inputs;
  audio::StreamConfig config = bench.stream->config();
  session::SimulatedParticipant participant(simulation::Observer(simulation::parse("sim")));
  const auto stage = session::virtual_stage(config, participant, inputs, nullptr, bench.setup);
  session::Trigger trigger;
  trigger.code = 5;
  stage->triggers().send(trigger, 0);
  audio::Burst burst;
  burst.length_frames = 9600, burst.ramp.frames = 100;
  const auto prepared = audio::prepare(burst, audio::format_of(config.output), config.limits);
  const auto onsets = stage->present({&prepared, 1}, 0);
  REQUIRE(onsets.size() == 1);
  CHECK(onsets[0].frame >= Bench::whole);
}

TEST_CASE("a code is missed if it was captured whole, and lost if it was not", "[session][trigger]") {
  Bench bench;
  for (const std::int64_t k : {1, 2, 3, 4}) bench.scheduled(static_cast<int>(k), k * 10'000);
  // There is a gap within the third code; the fourth has not been captured yet.
  const auto done =
      bench.after({{0, 21'000}, {21'000, 31'000}, {31'500, 40'500}}, {{10'000.1, 1, 0.4}, {15'000, 9, 0.4}});
  REQUIRE(done.size() == 3);
  CHECK(done[0].read_back == ReadBack::right);
  CHECK(done[1].read_back == ReadBack::missed);
  CHECK(done[2].read_back == ReadBack::lost);
  REQUIRE(bench.extra.size() == 1);
  CHECK(bench.extra[0].code == 9);
  CHECK(bench.triggers->pending());
  const auto last = bench.after({{40'500, 50'000}}, {{40'020, 4, 0.4}});
  REQUIRE(last.size() == 1);
  CHECK(last[0].read_back == ReadBack::right);
}

TEST_CASE("a stop drops the codes that have not begun, and cuts the one that has", "[session][trigger]") {
  Bench bench;
  for (const std::int64_t k : {1, 2, 3}) bench.scheduled(static_cast<int>(k), k * 10'000);
  bench.triggers->cut(20'100, 20'500, bench.stream->time_of(20'100).value());
  const auto done = bench.after({{0, 60'000}}, {{10'000, 1, 0.4}});
  REQUIRE(done.size() == 2);
  CHECK(done[0].read_back == ReadBack::right);
  CHECK_FALSE(done[0].cut);
  CHECK(done[1].code == 2);
  CHECK(done[1].cut);
  CHECK(session::rows_of(done[1]).front().value == "2 trial frame 20000; cut short");
}
