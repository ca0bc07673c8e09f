#include <algorithm>
#include <cmath>

#include "station/audio/device_stream.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/session/presented.hpp"
#include "tests/session/card_session.hpp"
#include "tests/session/many_tones.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

// These tests run the station's real stream and output on a simulated sound card. Some find out when
// intervals are really played, by a marker on the second channel; others run whole sessions on the card's
// clock.

using namespace turnpoint;
using namespace turnpoint::card_session;

namespace {

const std::string source = TURNPOINT_SOURCE_DIR;

constexpr Buffer kBuffers[] = {{64, 2}, {384, 4}, {1920, 4}, {4096, 16}};

rig::Rig marked_rig(int period_frames, int periods) {
  auto rig = rig::load(source + "/tests/support/thin_plate.toml");
  use_card(rig, {period_frames, periods});
  return rig;
}

void steps(audio::DeviceStream& stream, int count) {
  for (int k = 0; k < count; ++k) stream.step();
}

/// Returns the frames at which the card played a pulse of the marker.
std::vector<std::int64_t> pulses() {
  std::vector<std::int64_t> found;
  const auto& heard = fake_pcm().heard;
  for (std::size_t n = 1; n < heard.size(); ++n)
    if (heard[n - 1] == 0 && heard[n] != 0) found.push_back(static_cast<std::int64_t>(n));
  return found;
}

/// The next trial of a protocol, planned and checked as in a session.
struct Trial {
  Trial(const rig::Rig& rig, const protocol::Protocol& protocol)
      : director(protocol, 0, 3), plans(rig, protocol, 3), spec(*director.next()) {}
  trial::Director director;
  session::PlanAhead plans;
  trial::TrialSpec spec;
};

}  // namespace

TEST_CASE(
    "intervals are played at their predicted times and at the protocol's distances, for any buffer and scene",
    "[session][card]") {
  for (const auto* name : {"friction-2ifc", "two-spots-oddity"})
    for (const auto& buffer : kBuffers) {
      INFO(name << ", " << buffer.periods << " periods of " << buffer.period_frames);
      audio::reset_fake_pcm();
      fake_pcm().recorded_channel = 1;
      const auto rig = marked_rig(buffer.period_frames, buffer.periods);
      const auto protocol = protocol::load(source + "/protocols/" + name + ".toml");
      Trial trial(rig, protocol);
      audio::DeviceStream stream(session::stream_of(rig));
      steps(stream, 4);
      const auto& bursts = trial.plans.take(trial.spec).bursts;
      std::vector<session::Presented> presented;
      const auto onsets = session::schedule(stream, bursts, fake_pcm().now_ns() + 123'456'789, presented);
      REQUIRE(onsets.size() == trial.spec.intervals.size());
      while (stream.counters().heard < presented.back().end_frame) stream.step();
      const auto played = pulses();
      REQUIRE(played.size() == onsets.size());
      const double apart_s = protocol.task.duration_s->constant + protocol.task.gap_s->constant;
      for (std::size_t i = 0; i < played.size(); ++i) {
        const auto played_ns = 1'000'000'000 + played[i] * 1'000'000'000 / rig.output.rate_Hz;
        CHECK(std::abs(played_ns - onsets[i].time_ns) <= 1'000'000'000 / rig.output.rate_Hz);
        if (i > 0) CHECK(played[i] - played[i - 1] == std::llround(apart_s * rig.output.rate_Hz));
      }
    }
}

TEST_CASE(
    "a scene of twenty tones, whose peak must be rendered first, follows a scene of one tone at the right "
    "distance",
    "[session][card]") {
  for (const auto& buffer : kBuffers) {
    INFO(buffer.periods << " periods of " << buffer.period_frames);
    audio::reset_fake_pcm();
    fake_pcm().recorded_channel = 1;
    auto rig = rig::parse(many_tones::rig_text(), "rig.toml");
    use_card(rig, buffer);
    const auto protocol = protocol::parse(many_tones::protocol_text(), "many.toml");
    Trial trial(rig, protocol);
    audio::DeviceStream stream(session::stream_of(rig));
    steps(stream, 4);
    const auto& bursts = trial.plans.take(trial.spec).bursts;
    REQUIRE(bursts.size() == 2);
    CHECK(std::max(bursts[0].tone_count, bursts[1].tone_count) == many_tones::kTones);
    CHECK(std::min(bursts[0].tone_count, bursts[1].tone_count) == 1);
    for (const auto& burst : bursts) CHECK(many_tones::peak_was_rendered(burst));
    std::vector<session::Presented> presented;
    const auto onsets = session::schedule(stream, bursts, fake_pcm().now_ns() + 123'456'789, presented);
    REQUIRE(onsets.size() == 2);
    while (stream.counters().heard < presented.back().end_frame) stream.step();
    const auto played = pulses();
    REQUIRE(played.size() == 2);
    CHECK(played[1] - played[0] ==
          std::llround((many_tones::kDuration_s + many_tones::kGap_s) * rig.output.rate_Hz));
  }
}

TEST_CASE("a stop between two intervals cancels the second, so that nothing of it is played",
          "[session][card]") {
  audio::reset_fake_pcm();
  fake_pcm().recorded_channel = 1;
  const auto rig = marked_rig(384, 4);
  const auto protocol = protocol::load(source + "/protocols/friction-2ifc.toml");
  Trial trial(rig, protocol);
  audio::DeviceStream stream(session::stream_of(rig));
  steps(stream, 4);
  std::vector<session::Presented> presented;
  session::schedule(stream, trial.plans.take(trial.spec).bursts, 0, presented);
  while (stream.counters().heard < presented.front().end_frame + 1000) stream.step();
  session::ramp_down(stream, presented, fake_pcm().now_ns());
  while (stream.counters().heard < presented.back().end_frame) stream.step();
  CHECK(pulses().size() == 1);
}

TEST_CASE(
    "if the converter is lost, nothing is scheduled, and the surface counts as silent from now at the "
    "earliest",
    "[session][card]") {
  audio::reset_fake_pcm();
  const auto rig = marked_rig(384, 4);
  const auto protocol = protocol::load(source + "/protocols/friction-2ifc.toml");
  Trial trial(rig, protocol);
  audio::DeviceStream stream(session::stream_of(rig));
  steps(stream, 4);
  const auto& bursts = trial.plans.take(trial.spec).bursts;
  std::vector<session::Presented> presented;
  const auto onset = session::schedule(stream, bursts, 0, presented).front();
  while (stream.counters().heard < presented.front().start_frame + 20'000) stream.step();
  fake_pcm().fail(audio::FakePcm::State::gone);
  fake_pcm().present = false;
  steps(stream, 3);
  // The surface counts as silent only from now on, so that the trial's record includes the stimulus up to
  // now.
  const auto now_ns = fake_pcm().now_ns();
  const auto silent_ns = session::ramp_down(stream, presented, now_ns);
  CHECK(silent_ns > onset.time_ns);
  CHECK(silent_ns >= now_ns);
  CHECK(silent_ns < now_ns + 100'000'000);
  CHECK(session::schedule(stream, bursts, now_ns, presented).empty());
  CHECK_FALSE(session::fit_of(stream));
}

TEST_CASE(
    "if the converter is lost during a stimulus, exactly what was played until then is counted as exposure",
    "[session][card][fault]") {
  CardSession card;
  card.first_answered = false;
  card.repair_s = 2.5;
  std::int64_t lost_at = 0;
  const auto after = GENERATE(9'000, 100'000, 250'001);
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::stimulus && card.room.stimuli == 1)
      fake_pcm().before_call = [&, due = fake_pcm().now + after] {
        if (lost_at > 0 || fake_pcm().now < due) return;
        lost_at = fake_pcm().now;
        fake_pcm().fail(audio::FakePcm::State::gone);
        fake_pcm().present = false;
        card.later(2, [] { fake_pcm().present = true; });
      };
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  const auto stimuli = live_room::events_of(card.setup.database, card.summary, "stimulus");
  REQUIRE(stimuli.size() == 3);
  // Compare the recorded duration of stimulation, in frames from the onset, with what the card really played.
  const auto onset = (stimuli[0].time_ns - 1'000'000'000) * kRate_Hz / 1'000'000'000;
  const auto booked = std::stod(stimuli[0].value) * static_cast<double>(kRate_Hz);
  const auto& heard = fake_pcm().heard;
  const auto end = heard.begin() + static_cast<std::ptrdiff_t>(lost_at);
  const auto sounds = [](std::int32_t sample) { return sample != 0; };
  const auto first = std::find_if(heard.begin(), end, sounds) - heard.begin();
  CHECK(std::abs(first - onset) <= 4);  // the first samples of the ramp are 0
  const auto played = static_cast<double>(lost_at - onset);
  CHECK(std::any_of(end - 20, end, sounds));
  CHECK(std::abs(booked - played) <= 384);  // the station reads the converter's position once per period
  // There is one fault page before the first arming. All further fault pages are for this fault, however long
  // the repair takes.
  REQUIRE(card.faults.size() >= 2);
  CHECK(card.faults.front() == FaultKind::disarmed);
  CHECK(std::count(card.faults.begin() + 1, card.faults.end(), FaultKind::converter_gone) ==
        static_cast<std::ptrdiff_t>(card.faults.size()) - 1);
}

TEST_CASE(
    "if the converter does not report that a stimulus was played, the trial becomes void after a second",
    "[session][card][fault]") {
  CardSession card;
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::stimulus && card.room.stimuli == 2) fake_pcm().stamps = false;
    if (page.kind == PageKind::fault) fake_pcm().stamps = true;
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::answered);
  CHECK(trials[1].outcome == core::Outcome::fault);
  CHECK(trials[2].level == trials[1].level);
  CHECK(card.details.back() == "the converter does not report whether a stimulus was played");
  const auto stimuli = live_room::events_of(card.setup.database, card.summary, "stimulus");
  const auto faults = live_room::events_of(card.setup.database, card.summary, "fault");
  REQUIRE(stimuli.size() == 3);
  REQUIRE(faults.size() == 1);
  const auto silent_ns = stimuli[1].time_ns + static_cast<std::int64_t>(1e9 * std::stod(stimuli[1].value));
  CHECK(faults[0].time_ns - silent_ns == Approx(1e9).margin(2e7));
}

TEST_CASE("a converter that does not report its position gets no stimulus", "[session][card][fault]") {
  CardSession card;
  card.reacts = [&](const session::Page& page) {
    // After the restart the station needs new positions of the card, but the card reports none.
    if (page.kind == PageKind::instructions) fake_pcm().fail(audio::FakePcm::State::xrun);
    if (page.kind == PageKind::instructions) fake_pcm().stamps = false;
    if (page.kind == PageKind::fault) fake_pcm().stamps = true;
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 3);
  CHECK(trials[0].outcome == core::Outcome::fault);
  CHECK(card.details.back() == "the converter does not report which frame it is playing");
  CHECK(live_room::events_of(card.setup.database, card.summary, "stimulus").size() == 2);
}

TEST_CASE("late reports about a repeated trial do not count for the next one", "[session][card][fault]") {
  CardSession card;
  card.first_answered = false;
  card.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::stimulus && card.room.stimuli == 1) {
      card.holding = true;
      card.room.push(input::Repeat{});
    }
    if (page.kind == PageKind::cue && card.room.stimuli == 1) card.holding = false;
    // From the second stimulus on, the card no longer reports its playback position, so the station cannot
    // know what was played.
    if (page.kind == PageKind::stimulus && card.room.stimuli == 2) fake_pcm().stamps = false;
    if (page.kind == PageKind::fault) fake_pcm().stamps = true;
  };
  const auto trials = card.runs();
  REQUIRE(trials.size() == 4);
  CHECK(trials[0].outcome == core::Outcome::aborted);
  CHECK(trials[1].outcome == core::Outcome::fault);
  CHECK(trials[2].outcome == core::Outcome::answered);
}
