// Tests that the proof follows tones whose frequency and amplitude move within an interval. The surface is a
// set of resonators in the time domain, so it reacts to a glide as a plate does; its exact response at each
// frequency is the calibration.
#include <array>
#include <complex>

#include "tests/sensing/proofs.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::sensing;
using core::Proof;
using core::ProofCause;

namespace {

constexpr int kRate_Hz = 192000;
constexpr audio::Format kFormat{kRate_Hz, 1, 24};

/// Resonances every 1.5 kHz.
struct Plate {
  double quality = 60;
  std::vector<std::complex<double>> poles, weights, states;

  explicit Plate(double q) : quality(q) {
    for (int k = 0; k < 18; ++k) {
      const double f = 20'000 + 1'500 * k;
      poles.push_back(std::polar(std::exp(-M_PI * f / q / kRate_Hz), 2 * M_PI * f / kRate_Hz));
      weights.push_back(std::polar(0.4 * M_PI * f / q / kRate_Hz, 0.9 * k));
    }
    states.resize(poles.size());
  }

  double step(double drive) {
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < poles.size(); ++k) {
      states[k] = poles[k] * states[k] + drive;
      sum += weights[k] * states[k];
    }
    return sum.real();
  }

  std::complex<double> response(double frequency_Hz) const {
    const auto back = std::polar(1.0, -2 * M_PI * frequency_Hz / kRate_Hz);
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < poles.size(); ++k)
      sum += 0.5 * (weights[k] / (1.0 - poles[k] * back) +
                    std::conj(weights[k]) / (1.0 - std::conj(poles[k]) * back));
    return sum;
  }
};

struct Lab {
  double quality = 60;
  int delay_frames = 700;
  std::function<double(std::int64_t)> gain_at = [](std::int64_t) { return 1.0; };  ///< by frame of the burst
  std::optional<audio::Burst> played = {};  ///< what is really played, if it is not what was planned
  std::vector<std::pair<std::int64_t, audio::Change>> live = {};  ///< when each live change is sent
  std::int64_t told_late_frames = 0;  ///< by how much later the proof learns of it
};

IntervalPlan plan_of(const Lab& lab, const audio::Burst& burst) {
  IntervalPlan plan;
  plan.burst = audio::prepare(burst, kFormat);
  plan.capture_channels = 1;
  plan.delay_frames = lab.delay_frames;
  Transfer transfer{0, {}, {}};
  const Plate plate(lab.quality);
  for (double f = 20e3; f <= 46e3; f += 20) {
    transfer.frequency_Hz.push_back(f);
    transfer.response.push_back(plate.response(f));
  }
  plan.pick_ups = {{0, {transfer}}};
  return plan;
}

/// Plays the burst in the laboratory and proves it, block by block.
IntervalResult proven_in(const Lab& lab, const audio::Burst& burst, std::optional<bool> in_contact = false) {
  audio::Synth synth(kFormat);
  auto played = audio::prepare(lab.played.value_or(burst), kFormat);
  played.id = 1;
  auto control = played;
  REQUIRE(synth.start(played));
  Plate plate(lab.quality);
  IntervalProof proof(plan_of(lab, burst));
  constexpr std::int64_t block = 384;
  std::vector<double> out(block), late(static_cast<std::size_t>(lab.delay_frames));
  std::vector<std::int32_t> captured(block);
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 3e-5);
  std::size_t sent = 0, told = 0, place = 0;
  for (std::int64_t frame = 0; !proof.complete(); frame += block) {
    while (sent < lab.live.size() && lab.live[sent].first < frame + block) {
      REQUIRE(synth.change(1, audio::prepare_change(lab.live[sent].second, control, kFormat)));
      ++sent;
    }
    for (; told < lab.live.size() && lab.live[told].first + lab.told_late_frames < frame + block; ++told)
      proof.changed(lab.live[told].second, kFormat);
    synth.render(frame, std::span(out));
    for (std::int64_t n = 0; n < block; ++n) {
      const double drive = out[static_cast<std::size_t>(n)] * lab.gain_at(frame + n - burst.start_frame);
      captured[static_cast<std::size_t>(n)] = converted(plate.step(late[place]) + noise(random));
      late[place] = drive;
      place = (place + 1) % late.size();
    }
    proof.push({captured, 1, frame, kRate_Hz});
  }
  return proof.result(in_contact);
}

audio::Change change_to(const audio::Burst& burst, std::int64_t at, std::int64_t frames) {
  return {at, frames, burst.tones};
}

audio::Burst gliding(const audio::Burst& from, const audio::Burst& to, std::int64_t frames) {
  auto burst = from;
  burst.start_frame = 10'000;
  burst.length_frames = 96'000;
  burst.change_count = 1;
  burst.changes[0] = change_to(to, 40'000, frames);
  return burst;
}

double worst_glide_dB(const IntervalResult& result) {
  double worst = 0;
  for (const auto& tone : result.glides)
    if (std::fabs(tone.worst_ratio_dB) > std::fabs(worst)) worst = tone.worst_ratio_dB;
  return worst;
}

const auto kBefore = burst_of({{25000.5, 0.3, 0.2, 0}, {28321.7, 0.25, 1.9, 0}, {31543.2, 0.2, -2.5, 0}});
const auto kAfter = burst_of({{26800.5, 0.2, 0, 0}, {30021.7, 0.3, 0, 0}, {33043.2, 0.25, 0, 0}});
const auto kWeaker = burst_of({{25000.5, 0.12, 0, 0}, {28321.7, 0.08, 0, 0}, {31543.2, 0.1, 0, 0}});
const auto kOneMore =
    burst_of({{24000.5, 0.2, 0, 0}, {26321.7, 0.2, 0, 0}, {29043.2, 0.2, 0, 0}, {32000.1, 0.2, 1, 0}});

/// Gain of 1, except for `length` frames from the frame `first` on.
auto dip(double gain, std::int64_t first, std::int64_t length) {
  return [=](std::int64_t frame) { return frame >= first && frame < first + length ? gain : 1.0; };
}

}  // namespace

TEST_CASE("tones are proven while they glide, whatever the length of the glide and the surface's resonances",
          "[sensing][proof][glide]") {
  const auto& to = GENERATE_REF(kAfter, kWeaker, kOneMore);
  const auto frames = GENERATE(1'920, 3'840, 9'600, 38'400);
  Lab lab;
  lab.quality = GENERATE(20, 60, 120);
  CAPTURE(frames, lab.quality, to.tones.count, to.tones.tones[0].frequency_Hz);
  const auto result = proven_in(lab, gliding(kBefore, to, frames));
  CAPTURE(name(result.cause), worst_glide_dB(result), result.residual_dB);
  CHECK(result.verdict == Proof::ok);
  REQUIRE(result.glides.size() == static_cast<std::size_t>(to.tones.count));
  for (const auto& tone : result.glides) {
    CAPTURE(tone.tone, tone.worst_ratio_dB, tone.phase_error_deg);
    CHECK(tone.seen);
    CHECK(std::fabs(tone.worst_ratio_dB) < 0.15);  // a third of the smallest deviation that is flagged
    CHECK(std::fabs(tone.phase_error_deg) < 1);
  }
}

TEST_CASE("a level that drops in the middle of a glide is found, and the same drop as planned is not",
          "[sensing][proof][glide]") {
  const auto& to = GENERATE_REF(kAfter, kWeaker);
  Lab lab;
  const auto burst = gliding(kBefore, to, 9'600);
  SECTION("to a half, for 10 ms") {
    lab.gain_at = dip(0.5, 43'840, 1'920);
    const bool in_contact = GENERATE(true, false);
    const auto result = proven_in(lab, burst, in_contact);
    CHECK(result.verdict == (in_contact ? Proof::refused : Proof::stopped));
    CHECK(result.cause == ProofCause::level);
    CHECK(worst_glide_dB(result) < -4);
    for (const auto& tone : result.tones) CHECK(std::fabs(tone.ratio_dB) < 0.1);
  }
  SECTION("by 0.8 dB, for 15 ms") {
    lab.gain_at = dip(std::pow(10, -0.8 / 20), 43'000, 2'880);
    const auto result = proven_in(lab, burst);
    CHECK(result.verdict == Proof::flagged);
    CHECK(result.cause == ProofCause::level);
  }
  SECTION("silence for 10 ms") {
    lab.gain_at = dip(0, 43'840, 1'920);
    CHECK(proven_in(lab, burst, true).verdict == Proof::refused);
  }
  SECTION("not at all: the control") { CHECK(proven_in(lab, burst).verdict == Proof::ok); }
}

TEST_CASE("a glide that takes another way than planned is refused, even if it ends as planned",
          "[sensing][proof][glide]") {
  Lab lab;
  auto other = gliding(kBefore, kAfter, 9'600);
  const auto burst = other;
  const auto wrong = burst_of({{25900.5, 0.25, 0, 0}, {28321.7, 0.25, 0, 0}, {31543.2, 0.2, 0, 0}});
  other.change_count = 2;
  other.changes[0] = change_to(wrong, 40'000, 4'800);
  other.changes[1] = change_to(kAfter, 44'800, 4'800);
  lab.played = other;
  CHECK(proven_in(lab, burst, true).verdict == Proof::refused);
}

TEST_CASE("a stop during a glide leaves what was played before it proven", "[sensing][proof][glide]") {
  const auto burst = gliding(kBefore, kAfter, 9'600);
  Lab lab;
  IntervalProof proof(plan_of(lab, burst));
  audio::Synth synth(kFormat);
  REQUIRE(synth.start(audio::prepare(burst, kFormat)));
  Plate plate(lab.quality);
  std::vector<double> out(110'000);
  synth.render(0, std::span(out));
  std::vector<std::int32_t> captured(out.size());
  for (std::size_t n = 700; n < out.size(); ++n) captured[n] = converted(plate.step(out[n - 700]));
  proof.stopped(10'000 + 44'000);
  proof.push({captured, 1, 0, kRate_Hz});
  CHECK(proof.result(false).verdict == Proof::ok);
}

TEST_CASE("changes that are sent while a burst plays are proven", "[sensing][proof][glide]") {
  auto burst = kBefore;
  burst.start_frame = 10'000;
  burst.length_frames = 288'000;
  Lab lab;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  // a slider that moves for a second: a glide of 30 ms every 50 ms, and then it rests
  double place_Hz = 0;
  for (int k = 0; k < 20; ++k) {
    place_Hz += 800 * uniform(random) - 400;
    const auto to = burst_of(
        {{25000.5 + place_Hz, 0.3, 0, 0}, {28321.7 + place_Hz, 0.25, 0, 0}, {31543.2 + place_Hz, 0.2, 0, 0}});
    const std::int64_t at = 40'000 + 9'600 * k;
    lab.live.emplace_back(10'000 + at - 500, change_to(to, at, 5'760));
  }
  SECTION("as planned") {
    const auto result = proven_in(lab, burst);
    CAPTURE(name(result.cause), worst_glide_dB(result), result.residual_dB);
    CHECK(result.verdict == Proof::ok);
    CHECK(result.live_changes == 20);
    CHECK(result.glides.size() == 60);
    CHECK(std::fabs(worst_glide_dB(result)) < 0.2);
    CHECK(result.tones.back().stretch == 20);
  }
  SECTION("with a drop in one glide") {
    lab.gain_at = dip(0.5, 40'000 + 9'600 * 11 + 1'000, 1'920);
    const auto result = proven_in(lab, burst, true);
    CHECK(result.verdict == Proof::refused);
    CHECK(result.cause == ProofCause::level);
  }
  SECTION("a change of which the proof learns too late leaves the interval unproven") {
    lab.told_late_frames = 2'000;
    const auto result = proven_in(lab, burst);
    CHECK(result.verdict == Proof::unproven);
    CHECK(result.live_changes == 20);
  }
}
