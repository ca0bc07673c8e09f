#include <cmath>

#include "station/drive/device_stream.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/session/schedule.hpp"
#include "tests/drive/fake_pcm.hpp"
#include "tests/support/catch.hpp"

// What a session schedules, on the station's real stream and output and a sound card in memory: when
// intervals are really played, as the marker on the second channel shows.

using namespace turnpoint;
using drive::fake_pcm;

namespace {

const std::string source = TURNPOINT_SOURCE_DIR;

rig::Rig marked_rig(int period_frames, int periods) {
  auto rig = rig::load(source + "/deploy/rigs/simulated.toml");
  rig.output.uri = "alsa:fake";
  rig.output.period_frames = period_frames;
  rig.output.periods = periods;
  rig.marker = rig::Marker{};
  return rig;
}

void steps(drive::DeviceStream& stream, int count) {
  for (int k = 0; k < count; ++k) stream.step();
}

/// The moments (frames of the card's time) at which a marker's pulse was played.
std::vector<std::int64_t> pulses() {
  std::vector<std::int64_t> found;
  const auto& heard = fake_pcm().heard;
  for (std::size_t n = 1; n < heard.size(); ++n)
    if (heard[n - 1] == 0 && heard[n] != 0) found.push_back(static_cast<std::int64_t>(n));
  return found;
}

/// The next trial of a protocol, planned and checked as a session does it.
struct Trial {
  Trial(const rig::Rig& rig, const protocol::Protocol& protocol)
      : director(protocol, 0, 3), plans(rig, protocol, 3), spec(*director.next()) {}
  session::Director director;
  session::PlanAhead plans;
  session::TrialSpec spec;
};

}  // namespace

TEST_CASE(
    "intervals are played when they were predicted, at the protocol's distances, whatever buffer and scene",
    "[session][card]") {
  struct {
    int period_frames, periods;
  } const buffers[] = {{64, 2}, {384, 4}, {1920, 4}, {4096, 16}};
  for (const auto* name : {"friction-2ifc", "two-spots-oddity"})
    for (const auto& buffer : buffers) {
      INFO(name << ", " << buffer.periods << " periods of " << buffer.period_frames);
      drive::reset_fake_pcm();
      fake_pcm().recorded_channel = 1;
      const auto rig = marked_rig(buffer.period_frames, buffer.periods);
      const auto protocol = protocol::load(source + "/protocols/" + name + ".toml");
      Trial trial(rig, protocol);
      drive::DeviceStream stream(session::stream_of(rig));
      steps(stream, 4);
      const auto& bursts = trial.plans.take(trial.spec).bursts;
      std::vector<session::Presented> presented;
      const auto onsets = session::schedule(stream, bursts, fake_pcm().now_ns() + 123'456'789, presented);
      REQUIRE(onsets.size() == trial.spec.intervals.size());
      while (stream.counters().heard < presented.back().end_frame) stream.step();
      const auto played = pulses();
      REQUIRE(played.size() == onsets.size());
      const double apart_s = *protocol.task.duration_s + *protocol.task.gap_s;
      for (std::size_t i = 0; i < played.size(); ++i) {
        const auto played_ns = 1'000'000'000 + played[i] * 1'000'000'000 / rig.output.rate_Hz;
        CHECK(std::abs(played_ns - onsets[i].time_ns) <= 1'000'000'000 / rig.output.rate_Hz);
        if (i > 0) CHECK(played[i] - played[i - 1] == std::llround(apart_s * rig.output.rate_Hz));
      }
    }
}

TEST_CASE("a stop between two intervals cancels the second, and nothing of it is played", "[session][card]") {
  drive::reset_fake_pcm();
  fake_pcm().recorded_channel = 1;
  const auto rig = marked_rig(384, 4);
  const auto protocol = protocol::load(source + "/protocols/friction-2ifc.toml");
  Trial trial(rig, protocol);
  drive::DeviceStream stream(session::stream_of(rig));
  steps(stream, 4);
  std::vector<session::Presented> presented;
  session::schedule(stream, trial.plans.take(trial.spec).bursts, 0, presented);
  while (stream.counters().heard < presented.front().end_frame + 1000) stream.step();
  session::ramp_down(stream, presented, fake_pcm().now_ns());
  while (stream.counters().heard < presented.back().end_frame) stream.step();
  CHECK(pulses().size() == 1);
}

TEST_CASE("on a converter that is gone nothing is scheduled, and silence is no earlier than now",
          "[session][card]") {
  drive::reset_fake_pcm();
  const auto rig = marked_rig(384, 4);
  const auto protocol = protocol::load(source + "/protocols/friction-2ifc.toml");
  Trial trial(rig, protocol);
  drive::DeviceStream stream(session::stream_of(rig));
  steps(stream, 4);
  const auto& bursts = trial.plans.take(trial.spec).bursts;
  std::vector<session::Presented> presented;
  const auto onset = session::schedule(stream, bursts, 0, presented).front();
  while (stream.counters().heard < presented.front().start_frame + 20'000) stream.step();
  fake_pcm().fail(drive::FakePcm::State::gone);
  fake_pcm().present = false;
  steps(stream, 3);
  // What was on the surface until now is booked: the time of silence lies after the onset.
  const auto now_ns = fake_pcm().now_ns();
  const auto silent_ns = session::ramp_down(stream, presented, now_ns);
  CHECK(silent_ns > onset.time_ns);
  CHECK(silent_ns >= now_ns);
  CHECK(silent_ns < now_ns + 100'000'000);
  CHECK(session::schedule(stream, bursts, now_ns, presented).empty());
  CHECK_FALSE(session::fit_of(stream));
}
