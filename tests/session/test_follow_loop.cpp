#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "station/session/follow_loop.hpp"
#include "tests/follow/lab.hpp"
#include "tests/follow/plant.hpp"
#include "tests/support/catch.hpp"

// These tests close the whole loop on a virtual clock: the station's synthesiser renders samples, a simulated
// plate and finger (tests/follow/plant.hpp), which share no code with the station, feel them, their force
// cells become captured frames, and the station computes gains from these. Only the samples count: the gain
// is measured in them.

using namespace turnpoint;
using session::FollowLoop;

namespace {

constexpr double kTone_Hz = 32000, kAmplitude = 0.5, kPer_N = 0.08, kReference = 0.5;
constexpr std::int64_t kPeriod = 96, kEighth = 12;

sensing::FingerSetup cells_of(const plant::Setup& s) {
  sensing::FingerSetup finger;
  finger.bridges.reference_amplitude = kReference;
  finger.calibration = sensing::ForceCalibration(
      {{{1 / kPer_N, 0, 0}, {1 / kPer_N, 0, 1e3 * s.span_m / kPer_N}, {0, 1 / kPer_N, 0}}}, {});
  return finger;
}

/// The plan of a tone on channel 0 with ramps of 10 ms.
audio::Burst burst_of(const follow::Plan& plan, double seconds) {
  audio::Burst burst;
  burst.length_frames = static_cast<std::int64_t>(seconds * 192000);
  burst.ramp.frames = 1920;
  burst.tones.count = 1;
  burst.tones.tones[0] = {kTone_Hz, kAmplitude, 0, 0};
  burst.following = {plan.map.most_gain(), plan.resting_gain, static_cast<std::int64_t>(192000 * plan.ramp_s),
                     static_cast<std::int64_t>(192000 * plan.steady_s),
                     static_cast<std::int64_t>(192000 * plan.resume_s)};
  return burst;
}

/// What happens in one eighth of a period.
struct Moment {
  std::int64_t frame = 0;  ///< the first frame of the eighth
  double gain = 0;         ///< measured in the samples
  double place_m = 0, friction = 0, normal_N = 0;
};

class Bench {
 public:
  Bench(const plant::Setup& setup, const follow::Plan& plan, double seconds)
      : plant_(setup),
        span_m_(setup.span_m),
        stream_(audio::open_synchronous([] {
          audio::StreamConfig config;
          config.output.period_frames = kPeriod;
          config.output.periods = 2;
          return config;
        }())),
        loop_(*stream_, 4) {
    stream_->listen(
        [this](std::int64_t first, std::span<const std::int32_t> played) { hear(first, played); });
    plan_ = std::make_shared<const follow::Plan>(plan);
    auto prepared = audio::prepare(burst_of(plan, seconds), {192000, 2, 24});
    loop_.prepare({plan_}, {&prepared, 1}, cells_of(setup));
    prepared.start_frame = 4800;
    const auto scheduled = stream_->schedule_together({&prepared, 1});
    start_ = scheduled[0].start_frame;
    loop_.begin(std::vector<FollowLoop::Burst>{{scheduled[0].burst, start_, start_ + prepared.length_frames}},
                sensing::Readings{}, {0, 0});
  }

  /// Plays so many seconds, period by period.
  void run(double seconds) {
    for (auto n = static_cast<std::int64_t>(seconds * 192000); n > 0; n -= kPeriod) {
      stream_->advance(std::min<std::int64_t>(n, kPeriod));
      while (const auto event = stream_->poll()) loop_.note(*event);
      loop_.gather();
    }
  }

  session::Followed followed() { return loop_.take(); }
  std::int64_t start() const { return start_; }
  plant::Plant& plant() { return plant_; }

  bool captures = true;          ///< false: nothing is captured
  std::int64_t late_frames = 0;  ///< captured frames come so much later
  std::uint32_t numbering = 0;
  double reference = 1;  ///< of the excitation
  std::vector<Moment> moments;

 private:
  void hear(std::int64_t first, std::span<const std::int32_t> played) {
    std::vector<std::int32_t> frames;
    for (std::int64_t n = 0; n < static_cast<std::int64_t>(played.size()) / 2; n += kEighth) {
      // the amplitude of the tone, which has two cycles in an eighth, by its two quadratures
      std::complex<double> sum;
      for (std::int64_t i = 0; i < kEighth; ++i)
        sum += std::polar(0x1p-31 * played[static_cast<std::size_t>(2 * (n + i))],
                          -2 * std::numbers::pi * kTone_Hz / 192000 * static_cast<double>(first + n + i));
      const double gain = std::abs(sum) / 6 / kAmplitude;
      const auto before = plant_.now();
      plant_.step(gain);
      const auto after = plant_.now();
      moments.push_back({first + n, gain, plant_.place_m(), plant_.friction(), plant_.normal_N()});
      for (std::int64_t i = 0; i < kEighth; ++i) {
        const double t = (static_cast<double>(i) + 0.5) / kEighth;
        const double normal = before.normal_N + t * (after.normal_N - before.normal_N),
                     lateral = before.lateral_N + t * (after.lateral_N - before.lateral_N),
                     b = (before.moment_Nm + t * (after.moment_Nm - before.moment_Nm)) / span_m_;
        const double carrier =
            std::cos(2 * std::numbers::pi * 10525 / 192000 * static_cast<double>(first + n + i));
        for (const double volt : {reference, kPer_N * (normal - b), kPer_N * b, kPer_N * lateral})
          frames.push_back(static_cast<std::int32_t>(
              std::lround((kReference * volt * carrier + 1e-6 * dice_.bell()) * 0x1p31)));
      }
    }
    waiting_.insert(waiting_.end(), frames.begin(), frames.end());
    while (static_cast<std::int64_t>(waiting_.size()) / 4 >= late_frames + kPeriod) {
      if (captures) loop_.captured(next_, numbering, std::span(waiting_).first(4 * kPeriod));
      next_ += kPeriod;
      waiting_.erase(waiting_.begin(), waiting_.begin() + 4 * kPeriod);
    }
  }

  plant::Plant plant_;
  double span_m_;
  plant::Dice dice_{7};
  std::shared_ptr<const follow::Plan> plan_;
  std::unique_ptr<audio::SynchronousStream> stream_;
  FollowLoop loop_;
  std::int64_t start_ = 0, next_ = 0;
  std::vector<std::int32_t> waiting_;
};

/// The plant of these tests has the resonance of the tone.
plant::Setup finger() {
  plant::Setup s;
  s.resonance_Hz = kTone_Hz;
  return s;
}

follow::Part sine_of_4_mm() {
  follow::Part part;
  part.shape = follow::Shape::sine;
  part.from = 0.4, part.to = 0.8, part.cycles_per_m = 250;
  return part;
}

double gain_at(const Bench& bench, std::int64_t frame) {
  return bench.moments[static_cast<std::size_t>(frame / kEighth)].gain;
}

}  // namespace

TEST_CASE("a finger on a sine feels it, through samples and captured frames", "[session][follow]") {
  auto s = finger();
  s.friction = 0.9;
  const double speed = GENERATE(0.05, 0.1, 0.2);
  CAPTURE(speed);
  s.hand_m = [speed](double t) { return 0.03 + speed * std::max(0.0, t - 0.1); };
  auto plan = lab::plan_of(s);
  add(plan.pattern, sine_of_4_mm());
  Bench bench(s, plan, 0.8);
  bench.run(0.7);
  // the first cycle of friction over the place, against what is asked for
  std::complex<double> felt, asked;
  double count = 0;
  for (const auto& m : bench.moments) {
    if (m.place_m < 0.036 || m.place_m > 0.036 + 0.1 * speed * 4) continue;
    const auto turn = std::polar(1.0, -2 * std::numbers::pi * 250 * m.place_m);
    felt += m.friction * turn;
    asked += (0.6 + 0.2 * std::sin(2 * std::numbers::pi * 250 * m.place_m)) * turn;
    count += 1;
  }
  REQUIRE(count > 100);
  const auto ratio = felt / asked;
  CAPTURE(std::abs(ratio), std::arg(ratio) / (2 * std::numbers::pi));
  CHECK(std::abs(ratio) == Approx(1).margin(0.1));
  CHECK(std::abs(std::arg(ratio)) / (2 * std::numbers::pi) < 0.05);
  const auto followed = bench.followed();
  CHECK(followed.late.empty());
  CHECK(followed.not_recorded == 0);
  CHECK(followed.periods.back().update.interrupted == 0);
}

TEST_CASE("the samples have exactly the gains of the updates, from one period to the next",
          "[session][follow]") {
  auto s = finger();
  s.hand_m = lab::strokes(0.03, 0.1, 0.1);
  auto plan = lab::plan_of(s);
  add(plan.pattern, sine_of_4_mm());
  Bench bench(s, plan, 0.5);
  bench.run(0.4);
  const auto followed = bench.followed();
  REQUIRE(followed.periods.size() > 600);
  double before = plan.resting_gain, worst = 0;
  std::int64_t next = followed.periods.front().frame;
  CHECK(next <= bench.start());
  CHECK(next + kPeriod > bench.start());
  for (const auto& period : followed.periods) {
    REQUIRE(period.frame == next);
    next += kPeriod;
    CHECK(period.frame - period.sample_frame == 3 * kPeriod + 144 - kPeriod);
    for (std::size_t k = 0; k < follow::kGains; ++k) {
      const double gain = static_cast<double>(period.update.gain[k]), middle = (before + gain) / 2;
      before = gain;
      const auto frame = period.frame + static_cast<std::int64_t>(k) * kEighth;
      if (frame < bench.start() + 1920 || frame + kEighth > 74880) continue;
      worst = std::max(worst, std::abs(gain_at(bench, frame) - middle));
    }
  }
  CHECK(worst < 0.01);
}

TEST_CASE("from a force on the surface to the amplitude it takes less than 4 ms, and the same to one period",
          "[session][follow]") {
  // A click: friction falls when the force passes 0.75 N. The force jumps from 0.5 to 1 N at some frame.
  std::vector<std::int64_t> delays;
  for (std::int64_t phase = 0; phase < kPeriod; phase += kEighth) {
    auto s = finger();
    const std::int64_t jump = 48000 + phase;
    s.press_N = [jump](double t) { return t * 192000 > static_cast<double>(jump) ? 1.0 : 0.5; };
    auto plan = lab::plan_of(s);
    follow::Part click;
    click.shape = follow::Shape::constant;
    click.to = 0.4;
    click.trigger = {follow::Event::force, 0.75};
    add(plan.pattern, click);
    Bench bench(s, plan, 0.4);
    bench.run(0.35);
    CHECK(gain_at(bench, jump - 960) < 0.02);
    auto frame = jump;
    while (gain_at(bench, frame) < 0.05) {
      frame += kEighth;
      REQUIRE(frame < jump + 4 * 192);
    }
    delays.push_back(frame - jump);
  }
  const auto [least, most] = std::minmax_element(delays.begin(), delays.end());
  CAPTURE(*least, *most);
  CHECK(*most <= 4 * 192);
  CHECK(*most - *least <= kPeriod);
}

TEST_CASE("if the capture stops, or comes late, the gain rests within 10 ms and the trial names it",
          "[session][follow]") {
  auto s = finger();
  auto plan = lab::plan_of(s);
  plan.resting_gain = 0.1;
  follow::Part constant;
  constant.to = 0.4;
  add(plan.pattern, constant);
  const auto named = [](const session::Followed& followed, follow::Fault fault) {
    return (followed.periods.back().update.interrupted >> static_cast<unsigned>(fault) & 1u) != 0;
  };
  Bench bench(s, plan, 1.2);
  bench.run(0.3);
  const double followed_gain = gain_at(bench, 57000);
  CHECK(followed_gain > 0.3);
  // What happens is seen in the samples; the gains that were sent before it are still played.
  const auto rests_within = [&](std::int64_t from) {
    bench.run(0.012);
    const auto at = [&](std::int64_t frame) { return gain_at(bench, frame); };
    CHECK(at(from + 1920) == Approx(0.1).margin(0.002));
    for (std::int64_t frame = from + kEighth; frame < from + 2000; frame += kEighth)
      CHECK(std::abs(at(frame) - at(frame - kEighth)) < 0.03);
  };
  SECTION("the capture stops") {
    bench.captures = false;
    rests_within(57600);
    bench.run(0.1);
    const auto followed = bench.followed();
    REQUIRE(followed.late.size() == 1);
    CHECK(followed.late[0].from_frame > 57600);
    CHECK(followed.late[0].from_frame <= 57600 + 3 * kPeriod);
    SECTION("and comes again") {
      bench.captures = true;
      bench.run(0.1);
      CHECK(named(bench.followed(), follow::Fault::late));
      CHECK(gain_at(bench, bench.moments.back().frame - 960) == Approx(followed_gain).margin(0.02));
    }
  }
  SECTION("the capture comes 8 ms later") {
    bench.late_frames = 1536;
    rests_within(57600);
    bench.run(0.1);
    const auto followed = bench.followed();
    REQUIRE_FALSE(followed.late.empty());
    // what is recorded was played
    for (const auto& one : followed.periods) CHECK(one.frame + kPeriod <= followed.late[0].from_frame);
    CHECK(gain_at(bench, bench.moments.back().frame - 96) == Approx(0.1).margin(0.002));
  }
  SECTION("captured frames are lost") {
    bench.numbering = 1;
    rests_within(57600);
    CHECK(named(bench.followed(), follow::Fault::force));
  }
  SECTION("the excitation fails") {
    bench.reference = 0.9;
    rests_within(57600);
    CHECK(named(bench.followed(), follow::Fault::reference));
  }
}

TEST_CASE("a plan that cannot be followed is refused with its reason", "[session][follow]") {
  audio::StreamConfig config;
  config.output.period_frames = 96, config.output.periods = 2;
  const auto stream = audio::open_synchronous(config);
  FollowLoop loop(*stream, 4);
  const auto plan = lab::plan_of({});
  const auto refused = [&](const follow::Plan& with, std::optional<sensing::FingerSetup> cells,
                           double tone_Hz) {
    auto burst = burst_of(with, 0.2);
    burst.tones.tones[0].frequency_Hz = tone_Hz;
    const auto prepared = audio::prepare(burst, {192000, 2, 24});
    try {
      loop.prepare({std::make_shared<const follow::Plan>(with)}, {&prepared, 1}, cells);
    } catch (const audio::BurstRefused& problem) {
      return std::string(problem.what());
    }
    return std::string();
  };
  const auto contains = [](const std::string& text, const char* part) {
    CAPTURE(text);
    CHECK(text.find(part) != std::string::npos);
  };
  CHECK(refused(plan, cells_of({}), 30000).empty());
  CHECK(loop.prepared());
  contains(refused(plan, std::nullopt, 30000), "force cells");
  CHECK_FALSE(loop.prepared());
  auto own = cells_of({});
  own.own_clock = true;
  contains(refused(plan, own, 30000), "force cells");
  contains(refused(plan, cells_of({}), 12000), "carrier");
  auto slow = plan;
  slow.timing.buffer_periods = 7;
  contains(refused(slow, cells_of({}), 30000), "allowed: 4 ms");
  auto other = plan;
  other.timing = follow::timing_of(96000);
  contains(refused(other, cells_of({}), 30000), "96000 Hz");
  config.output.periods = 4;  // a device that buffers more than was planned
  const auto longer = audio::open_synchronous(config);
  FollowLoop on_longer(*longer, 4);
  const auto burst = audio::prepare(burst_of(plan, 0.2), {192000, 2, 24});
  CHECK_THROWS_AS(on_longer.prepare({std::make_shared<const follow::Plan>(plan)}, {&burst, 1}, cells_of({})),
                  audio::BurstRefused);
  loop.prepare({nullptr}, {}, std::nullopt);  // a trial that follows nothing needs no force cells
  CHECK_FALSE(loop.prepared());
}
