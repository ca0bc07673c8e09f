#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "station/audio/prepared_burst.hpp"
#include "station/core/read_file.hpp"
#include "station/rig/rig.hpp"
#include "station/session/prepare.hpp"
#include "station/session/session.hpp"
#include "station/session/stage.hpp"
#include "station/store/read.hpp"
#include "tests/session/many_tones.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

// Tests when intervals reach the surface, for buffers of different lengths. The times come from the records
// of simulated sessions.

using namespace turnpoint;

namespace {

struct Buffer {
  int period_frames, periods;
};
constexpr Buffer kBuffers[] = {{64, 2}, {384, 4}, {1920, 4}, {4096, 16}};

std::string shipped(const std::string& protocol) {
  return std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + protocol + ".toml";
}

std::vector<core::TrialRow> session_of(const std::string& protocol, const Buffer& buffer, double delay_s,
                                       const std::string& rig = std::string(TURNPOINT_SOURCE_DIR) +
                                                                "/tests/support/thin_plate.toml") {
  const TemporaryFolder folder;
  auto request = simulated_run(protocol, folder / "a.sqlite", 5);
  request.rig = rig;
  request.headless = true;
  auto setup = session::prepare(request);
  setup.rig.output.period_frames = buffer.period_frames;
  setup.rig.output.periods = buffer.periods;
  setup.rig.output.converter_delay_s = delay_s;
  session::Inputs nobody;
  const auto summary = session::run(setup, nullptr, nobody);
  REQUIRE(summary.status == core::SessionStatus::completed);
  std::vector<core::TrialRow> trials;
  for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
    trials.insert(trials.end(), block.trials.begin(), block.trials.end());
  return trials;
}

/// Returns the first frame of each interval of a trial.
std::map<int, std::int64_t> onsets(const core::TrialRow& trial) {
  std::map<int, std::int64_t> first;
  for (const auto& tone : trial.tones) first.try_emplace(tone.interval_index, tone.onset_frame);
  return first;
}

}  // namespace

TEST_CASE("the pause between intervals is exactly the protocol's, to the frame, for any buffer and scene",
          "[session][intervals]") {
  for (const auto& buffer : kBuffers)
    for (const auto& [name, apart_s] :
         {std::pair{"friction-2ifc", 2.5}, std::pair{"two-spots-oddity", 2.5}}) {
      INFO(name << ", " << buffer.periods << " periods of " << buffer.period_frames);
      int pauses = 0;
      for (const auto& trial : session_of(shipped(name), buffer, 0)) {
        const auto first = onsets(trial);
        for (std::size_t i = 1; i < first.size(); ++i, ++pauses)
          CHECK(first.at(static_cast<int>(i)) - first.at(static_cast<int>(i) - 1) ==
                std::llround(apart_s * 192000));
      }
      CHECK(pauses > 40);
    }
}

TEST_CASE("a single interval with a length lasts so long in each trial, and the answer follows it",
          "[session][intervals]") {
  const auto trials = session_of(shipped("bisection"), kBuffers[1], 0);
  CHECK(trials.size() == 99);
  for (const auto& trial : trials) {
    CHECK(trial.tones.front().length_frames == std::llround(1.5 * 192000));
    CHECK(trial.timing.response_time_s.value_or(0) > 0);  // after the end
  }
}

TEST_CASE("a scene of twenty tones, whose peak must be rendered first, does not lengthen the pause",
          "[session][intervals]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "many.toml") << many_tones::protocol_text();
  std::ofstream(folder / "rig.toml") << many_tones::rig_text();
  for (const auto& buffer : kBuffers) {
    INFO(buffer.periods << " periods of " << buffer.period_frames);
    int many_first = 0, many_second = 0;
    for (const auto& trial : session_of(folder / "many.toml", buffer, 0, folder / "rig.toml")) {
      const auto first = onsets(trial);
      REQUIRE(first.size() == 2);
      CHECK(first.at(1) - first.at(0) ==
            std::llround((many_tones::kDuration_s + many_tones::kGap_s) * 192000));
      const auto in_first = std::count_if(trial.tones.begin(), trial.tones.end(),
                                          [](const auto& tone) { return tone.interval_index == 0; });
      ++(in_first == many_tones::kTones ? many_first : many_second);
    }
    CHECK(many_first > 0);
    CHECK(many_second > 0);
  }
}

TEST_CASE("the converter's delay is part of every stored onset", "[session][intervals]") {
  const double delay_s = 7e-3;
  for (const auto& [delay, wanted_ns] : {std::pair{0.0, 0.0}, std::pair{delay_s, delay_s * 1e9}}) {
    int seen = 0;
    for (const auto& trial : session_of(shipped("demo"), kBuffers[1], delay)) {
      REQUIRE(trial.timing.response_zero == "go_cue");
      const auto frame_ns = static_cast<double>(onsets(trial).at(0)) * 1e9 / 192000;
      CHECK(static_cast<double>(trial.timing.onset_ns) - frame_ns == Approx(wanted_ns).margin(2));
      ++seen;
    }
    CHECK(seen > 5);
  }
}

TEST_CASE("simulated sessions include the latency of the rig's buffer", "[session][intervals]") {
  // A move of the slider reaches the surface one buffer later. With a longer buffer, the last onset is
  // therefore later by the difference between the buffers.
  const auto short_ = session_of(shipped("boundary-adjustment"), kBuffers[0], 0),
             long_ = session_of(shipped("boundary-adjustment"), kBuffers[2], 0);
  REQUIRE(short_.size() == long_.size());
  int later = 0;
  for (std::size_t i = 0; i < short_.size(); ++i) {
    REQUIRE(short_[i].tones.size() == long_[i].tones.size());
    const auto since = [](const core::TrialRow& trial) {
      return trial.tones.back().onset_frame - trial.tones.front().onset_frame;
    };
    if (short_[i].tones.back().scene_index == 0) continue;
    CHECK(since(long_[i]) - since(short_[i]) == 1920 * 4 - 64 * 2);
    ++later;
  }
  CHECK(later > 3);
}

TEST_CASE("on the virtual clock, a trial that follows an aborted one waits until the surface is silent",
          "[session][intervals]") {
  const auto stream =
      session::stream_of(rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml"));
  // Three intervals at almost full scale, so that nothing else can be played at the same time.
  audio::Burst interval;
  interval.length_frames = 192000;
  interval.ramp.frames = 3840;
  interval.tones.count = 1;
  interval.tones.tones[0] = {30000, 0.9, 0, 0};
  std::vector<audio::PreparedBurst> intervals;
  for (int i = 0; i < 3; ++i, interval.start_frame += 288000)
    intervals.push_back(audio::prepare(interval, audio::format_of(stream.output), stream.limits));
  for (const double aborted_after_s : {0.0, 0.001, 0.03, 0.5, 1.2, 1.6, 3.99, 4.2}) {
    INFO("aborted " << aborted_after_s << " s after the first onset");
    session::Inputs nobody;
    session::SimulatedParticipant participant(simulation::Observer(simulation::parse("sim")));
    const auto stage = session::virtual_stage(stream, participant, nobody);
    const auto first = stage->present(intervals, 0);
    REQUIRE(first.size() == 3);
    while (stage->wait_until(first[0].time_ns + static_cast<std::int64_t>(aborted_after_s * 1e9))) {
    }
    const auto silent_ns = stage->silence(false);
    const auto second = stage->present(intervals, 0);
    REQUIRE(second.size() == 3);
    CHECK(second[0].time_ns >= silent_ns);
    CHECK(second[2].frame - second[0].frame == 2 * 288000);
  }
}

TEST_CASE("pages of ABX and match-to-sample call the intervals by the letters of the question", "[session]") {
  struct Pages : session::Display {
    std::vector<std::string> names;
    void show(const session::Page& page) override {
      if (page.kind == session::PageKind::stimulus) names = page.interval.names;
    }
  };
  using Words = std::vector<std::string>;
  for (const auto& [kind, names] : {std::pair<std::string, Words>{"abx", {"A", "B", "X"}},
                                    {"match-to-sample", {"X", "A", "B"}},
                                    {"oddity", {}}}) {
    const TemporaryFolder folder;
    auto source = core::read_file(shipped("friction-abx"));
    source.replace(source.find("\"abx\""), 5, '"' + kind + '"');
    if (kind == "oddity")
      source.replace(source.find("{ id = \"second\""), 0,
                     "{ id = \"x\", label = { en = \"X\", de = \"X\", ja = \"X\" } },\n");
    std::ofstream(folder / "p.toml") << source;
    auto request = simulated_run(folder / "p.toml", folder / "a.sqlite");
    request.headless = true;
    const auto setup = session::prepare(request);
    Pages pages;
    session::Inputs nobody;
    session::run(setup, &pages, nobody);
    CHECK(pages.names == names);
  }
}
