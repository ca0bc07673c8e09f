#include <algorithm>
#include <random>
#include <set>

#include "station/audio/device_stream.hpp"
#include "station/trial/machine.hpp"
#include "tests/audio/fake_pcm.hpp"
#include "tests/support/catch.hpp"

// These tests run the station's ALSA output, its stream and its trial machine step by step on a simulated
// sound card. Whether a trial must be void depends on what the card really played, not on what the program
// believes. Therefore the tests compare the card's samples with those of an uninterrupted synthesis.

using namespace turnpoint;
using namespace turnpoint::audio;

namespace {

constexpr std::int64_t kRamp = 300, kPause = 1000;
constexpr double kAmplitude = 0.5;

Burst burst_of(std::int64_t length_frames) {
  Burst burst;
  burst.length_frames = length_frames;
  burst.ramp.frames = kRamp;
  burst.tones.count = 1;
  burst.tones.tones[0] = {24000, kAmplitude, 0.4, 0};
  return burst;
}

/// Returns frames [first, end) of channel 0 as an uninterrupted synthesis renders them.
std::vector<std::int32_t> unbroken(std::span<const PreparedBurst> bursts, const Format& format,
                                   std::int64_t first, std::int64_t end) {
  Synth synth(format);
  for (const auto& burst : bursts) REQUIRE(synth.start(burst));
  std::vector<std::int32_t> block(static_cast<std::size_t>(format.channels * (end - first)));
  synth.skip_to(first);
  synth.render(first, std::span<std::int32_t>(block));
  std::vector<std::int32_t> channel;
  for (std::size_t n = 0; n < block.size(); n += static_cast<std::size_t>(format.channels))
    channel.push_back(block[n]);
  return channel;
}

/// Counts the places where the sound rises within 16 frames from silence to more than a twentieth of its
/// amplitude.
int abrupt_onsets(const std::vector<std::int32_t>& heard) {
  int abrupt = 0;
  std::size_t silent = 0;
  for (std::size_t n = 0; n < heard.size(); ++n) {
    if (heard[n] == 0) {
      ++silent;
      continue;
    }
    if (silent >= 16)
      abrupt += std::any_of(heard.begin() + static_cast<std::ptrdiff_t>(n),
                            heard.begin() + static_cast<std::ptrdiff_t>(std::min(n + 16, heard.size())),
                            [](std::int32_t s) { return std::abs(s * 0x1p-31) > 0.05 * kAmplitude; })
                    ? 1
                    : 0;
    silent = 0;
  }
  return abrupt;
}

enum class Mishap { stall, stall_in_write, xrun, suspend, unplug };

/// One run: two bursts with a pause on a card that has mishaps, and what the stream reported about the
/// bursts.
struct Run {
  std::vector<Scheduled> scheduled;
  std::vector<PreparedBurst> bursts;
  std::int64_t predicted_ns = 0;
  std::set<std::uint32_t> heard;
  std::vector<Event> losses;
  bool restarted = false;
  trial::Result result;
  bool told_after_answer = false;  ///< true if a loss reported after the answer made the trial void
  /// True if time passed between a write and the check whether the device had already played past the written
  /// frames. The stream cannot know whether the device had passed them before the write, so it counts the
  /// block as lost.
  bool doubtful = false;

  bool both_heard() const { return heard.size() == 2; }
  bool answered() const { return result.outcome == core::Outcome::answered; }
};

constexpr std::int64_t kLengths[] = {3000, 2500}, kAnswerAfter = 400;

std::int64_t ns_of(std::int64_t frames) { return frames * 1'000'000'000 / 192'000; }

trial::Timing trial_timing() {
  trial::Timing plan;
  plan.intervals = {{ns_of(kLengths[0]), {}}, {ns_of(kLengths[1]), {}, ns_of(kPause)}};
  plan.response_zero = core::ResponseZero::interval_off;
  plan.deadline_ns = 1'000'000'000;
  plan.iti_ns = ns_of(2000);
  return plan;
}

class Bench {
 public:
  explicit Bench(std::uint64_t seed) : random_(seed) {
    reset_fake_pcm();
    config_.output.uri = "alsa:fake";
    config_.output.period_frames = pick({64, 128, 384});
    config_.output.periods = pick({2, 3, 4, 8});
  }

  /// Runs a trial with this number of mishaps of the given kinds. Each happens at a random moment, from
  /// shortly before the first onset to shortly after the last end. A void trial continues to play here, so
  /// that the test can judge all of it.
  Run run(int mishaps, const std::vector<Mishap>& kinds) {
    DeviceStream stream(config_);
    for (int k = 0; k < 4 || stream.clock().pairs < 2; ++k) stream.step();
    trial::Machine machine(trial_timing());
    machine.start(fake_pcm().now_ns());
    Run run = schedule(stream, machine);
    const auto answer_ns = run.predicted_ns + ns_of(kLengths[0] + kPause + kLengths[1] + kAnswerAfter);
    const auto frames =
        run.scheduled.back().start_frame + kLengths[1] - stream.counters().frames + 4 * buffer();
    plan(mishaps, kinds, frames);
    const auto last = fake_pcm().now + frames + 3 * buffer() + lasting_;
    const auto one_in = pick({1, 3, 40});  // the session polls once in this many steps of the stream
    bool answered = false;
    while (fake_pcm().now < last || !machine.done()) {
      stream.step();
      const auto now_ns = fake_pcm().now_ns();
      if (!answered && now_ns > answer_ns) {
        machine.handle({answer_ns, trial::EventKind::answer, 0});
        answered = true;
      }
      if (below(one_in) == 0) listen(stream, run, machine);
      if (const auto wake = machine.wake_ns(); wake && *wake <= now_ns)
        machine.handle({*wake, trial::EventKind::tick, 0});
      if (fake_pcm().now > last) fake_pcm().before_call = fake_pcm().before_write = nullptr;
    }
    run.result = machine.result();
    run.doubtful = doubtful_;
    return run;
  }

  const OutputConfig& output() const { return config_.output; }

 private:
  struct Planned {
    std::int64_t at = 0, lasts = 0;
    Mishap kind = Mishap::stall;
  };

  std::int64_t below(std::int64_t n) {
    return static_cast<std::int64_t>(random_() % static_cast<std::uint64_t>(n));
  }
  int pick(std::initializer_list<int> from) {
    return *(from.begin() + below(static_cast<std::int64_t>(from.size())));
  }
  std::int64_t buffer() const { return std::int64_t{config_.output.period_frames} * config_.output.periods; }

  Run schedule(DeviceStream& stream, trial::Machine& machine) {
    Run run;
    const auto format = format_of(config_.output);
    for (const std::int64_t length : kLengths) run.bursts.push_back(prepare(burst_of(length), format));
    run.bursts[0].start_frame = stream.earliest_frame() + below(2000);
    run.bursts[1].start_frame = run.bursts[0].start_frame + kLengths[0] + kPause;
    run.scheduled = stream.schedule_together(run.bursts);
    run.predicted_ns = stream.time_of(run.scheduled.front().start_frame).value();
    for (int i = 0; i < 2; ++i)
      machine.handle({stream.time_of(run.scheduled[static_cast<std::size_t>(i)].start_frame).value(),
                      trial::EventKind::onset, i});
    return run;
  }

  void plan(int mishaps, const std::vector<Mishap>& kinds, std::int64_t frames) {
    for (int k = 0; k < mishaps; ++k) {
      Planned one;
      one.at = fake_pcm().now + below(frames);
      one.kind = kinds[static_cast<std::size_t>(below(static_cast<std::int64_t>(kinds.size())))];
      one.lasts = one.kind == Mishap::unplug ? 60'000 : 1 + below(3 * buffer());
      lasting_ += one.lasts;
      planned_.push_back(one);
    }
    std::sort(planned_.begin(), planned_.end(), [](const auto& a, const auto& b) { return a.at > b.at; });
    fake_pcm().before_call = [this] { happen(false); };
    fake_pcm().before_write = [this] { happen(true); };
  }

  void happen(bool in_write) {
    if (planned_.empty() || planned_.back().at > fake_pcm().now) return;
    if ((planned_.back().kind == Mishap::stall_in_write) != in_write) return;
    doubtful_ |= fake_pcm().just_wrote;
    const Planned one = planned_.back();
    planned_.pop_back();
    FakePcm& card = fake_pcm();
    if (one.kind == Mishap::xrun) card.fail(FakePcm::State::xrun);
    if (one.kind == Mishap::suspend) card.fail(FakePcm::State::suspended);
    if (one.kind == Mishap::unplug) card.fail(FakePcm::State::gone);
    card.pass(one.lasts);
  }

  void listen(DeviceStream& stream, Run& run, trial::Machine& machine) {
    const auto now_ns = fake_pcm().now_ns();
    while (const auto event = stream.poll()) {
      const bool had_answer = machine.result().response.has_value();
      switch (event->kind) {
        case EventKind::burst_heard:
          run.heard.insert(event->burst);
          machine.handle({now_ns, trial::EventKind::heard, event->burst == run.scheduled[0].burst ? 0 : 1});
          break;
        case EventKind::underrun:
          run.losses.push_back(*event);
          machine.handle({now_ns, trial::EventKind::xrun, event->burst != 0 ? 1 : 0});
          break;
        case EventKind::device_lost:
        case EventKind::burst_missed:
          run.losses.push_back(*event);
          machine.handle({now_ns, trial::EventKind::fault, 0});
          break;
        default:
          break;
      }
      run.restarted |= event->retimed || event->kind == EventKind::device_lost;
      run.told_after_answer |= had_answer && machine.result().outcome == core::Outcome::fault;
    }
  }

  std::mt19937_64 random_;
  StreamConfig config_;
  std::vector<Planned> planned_;
  std::int64_t lasting_ = 0;
  bool doubtful_ = false;
};

struct Truth {
  bool whole = false;    ///< the card played every sample of both bursts and of the pause between them
  bool on_time = false;  ///< both bursts began at the predicted time
};

Truth truth_of(const Run& run, const OutputConfig& output) {
  auto bursts = run.bursts;
  for (std::size_t k = 0; k < bursts.size(); ++k) bursts[k].start_frame = run.scheduled[k].start_frame;
  const auto wanted = unbroken(bursts, format_of(output), bursts.front().start_frame,
                               bursts.back().start_frame + bursts.back().length_frames);
  const auto& heard = fake_pcm().heard;
  const auto found = std::search(heard.begin(), heard.end(), wanted.begin(), wanted.end());
  if (found == heard.end()) return {};
  const auto at_ns = 1'000'000'000 + (found - heard.begin()) * 1'000'000'000 / output.rate_Hz;
  return {true, std::abs(at_ns - run.predicted_ns) < 1'000'000'000 / output.rate_Hz};
}

struct Tally {
  int whole = 0, broken = 0, late = 0, gaps = 0, told_after_answer = 0, void_in_doubt = 0;
};

/// Checks for many runs that a trial is void exactly if the card did not play all of it in time.
Tally judge(int runs, std::uint64_t seed, const std::vector<Mishap>& kinds) {
  Tally tally;
  for (int k = 0; k < runs; ++k) {
    Bench bench(seed + static_cast<std::uint64_t>(k));
    const Run run = bench.run(k % 4, kinds);
    const Truth truth = truth_of(run, bench.output());
    INFO("seed " << seed + static_cast<std::uint64_t>(k));
    const bool good = truth.whole && truth.on_time;
    if (run.both_heard() && !good)
      FAIL("the stream reported both bursts as heard, but the card did not play them in time");
    if (run.answered() && !good)
      FAIL("the trial counts as answered, but the card did not play all of it in time");
    // A restart makes earlier predictions invalid, even if they happen to be right.
    const bool may_be_void = run.restarted || run.doubtful;
    if (!run.both_heard() && good && !may_be_void)
      FAIL("the stream reported lost frames, but the card played all of them in time");
    if (!run.answered() && good && !may_be_void)
      FAIL("the trial is void, but the card played all of it in time");
    if (kinds.front() != Mishap::stall_in_write && abrupt_onsets(fake_pcm().heard) != 0)
      FAIL("a block of sound started abruptly");
    tally.void_in_doubt += good && !run.answered() ? 1 : 0;
    ++(good ? tally.whole : truth.whole ? tally.late : tally.broken);
    tally.gaps += static_cast<int>(run.losses.size());
    tally.told_after_answer += run.told_after_answer ? 1 : 0;
  }
  return tally;
}

}  // namespace

TEST_CASE(
    "wherever the program stalls, a trial is void exactly if its frames were lost, and no sound starts "
    "abruptly",
    "[drive][gaps]") {
  const auto tally = judge(4000, 1, {Mishap::stall});
  CHECK(tally.whole > 800);
  CHECK(tally.broken > 800);
  CHECK(tally.gaps > 1500);
  CHECK(tally.told_after_answer > 20);
  CHECK(tally.void_in_doubt < 5);
}

TEST_CASE("a stall in the middle of a write is detected afterwards", "[drive][gaps]") {
  const auto tally = judge(1000, 100'000, {Mishap::stall_in_write, Mishap::stall});
  CHECK(tally.broken > 300);
}

TEST_CASE("a burst interrupted by a restart or by the loss of the device does not count as completely played",
          "[drive][gaps]") {
  const auto tally = judge(1500, 200'000, {Mishap::xrun, Mishap::suspend, Mishap::stall});
  CHECK(tally.broken > 400);
  CHECK(tally.late > 20);
  const auto away = judge(150, 300'000, {Mishap::unplug, Mishap::stall});
  CHECK(away.broken + away.late > 50);
}

TEST_CASE("negative control: the comparison detects one wrong sample, one shifted frame and an abrupt onset",
          "[drive][gaps]") {
  Bench bench(7);
  const Run run = bench.run(0, {});
  REQUIRE(run.both_heard());
  REQUIRE(truth_of(run, bench.output()).on_time);
  auto& heard = fake_pcm().heard;
  REQUIRE(abrupt_onsets(heard) == 0);
  const auto last = std::find_if(heard.rbegin(), heard.rend(), [](auto s) { return s != 0; }).base() - 1;
  const auto kept = *last;
  *last = 0;
  CHECK_FALSE(truth_of(run, bench.output()).whole);
  *last = kept;
  heard.insert(heard.begin(), 1, 0);
  CHECK(truth_of(run, bench.output()).whole);
  CHECK_FALSE(truth_of(run, bench.output()).on_time);
  const auto middle = std::find_if(heard.begin(), heard.end(), [](auto s) { return s != 0; }) + 1500;
  std::fill(middle, middle + 100, 0);
  CHECK(abrupt_onsets(heard) == 1);
}
