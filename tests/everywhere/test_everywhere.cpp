#include <fstream>
#include <sstream>

#include "station/audio/synth.hpp"
#include "station/core/number.hpp"
#include "station/procedure/posterior.hpp"
#include "station/session/prepare.hpp"
#include "station/store/read.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

// Hashes of everything that must not depend on the machine. They were recorded on amd64 with g++ 12, and
// arm64 and g++ 14 give the same ones. If a hash changes, the stimuli, draws or samples have changed: update
// the hash only if that was intended.

using namespace turnpoint;

namespace {

template <class Value>
std::string hash_of(const std::vector<Value>& values) {
  return core::sha256({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)})
      .substr(0, 16);
}

/// Returns a burst of one second with ramps. Two tones glide to two others, and a pulse marks onset and
/// change.
audio::Burst burst() {
  audio::Burst burst;
  burst.start_frame = 1000;
  burst.length_frames = 192000;
  burst.tones.count = 2;
  burst.tones.tones[0] = {31234.5678901234, 0.4, 0.3, 0};
  burst.tones.tones[1] = {27654.3210987654, 0.25, -2.1, 0};
  burst.change_count = 1;
  burst.changes[0].at_frame = 96000;
  burst.changes[0].to.count = 2;
  burst.changes[0].to.tones[0] = {29876.54321, 0.3, 0, 0};
  burst.changes[0].to.tones[1] = {33333.33333, 0.35, 0, 0};
  burst.marker = {audio::MarkerKind::pulse, 1, 0.5, 1000, 192};
  return burst;
}

template <class Sample>
std::string rendered(const audio::Burst& burst) {
  const audio::Format format;
  audio::Synth synth(format);
  REQUIRE(synth.start(audio::prepare(burst, format)));
  std::vector<Sample> all, block(2 * 384);
  for (std::int64_t frame = 0; frame < 200064; frame += 384) {
    synth.render(frame, std::span<Sample>(block));
    all.insert(all.end(), block.begin(), block.end());
  }
  return hash_of(all);
}

/// Runs a simulated session of a shipped protocol, with its files in `folder`, and returns its trials.
std::vector<core::TrialRow> session_of(const std::string& protocol, const TemporaryFolder& folder,
                                       const std::string& output) {
  auto request =
      simulated_run(TURNPOINT_SOURCE_DIR "/protocols/" + protocol + ".toml", folder / "a.sqlite", 20240229);
  request.headless = true;
  auto setup = session::prepare(request);
  setup.rig.output.uri = output;
  session::Inputs nobody;
  const auto summary = session::run(setup, nullptr, nobody);
  std::vector<core::TrialRow> trials;
  for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
    trials.insert(trials.end(), block.trials.begin(), block.trials.end());
  return trials;
}

/// Returns a hash of the questions and answers, to the last bit.
std::string decided(const std::vector<core::TrialRow>& trials) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const auto& trial : trials) {
    text << trial.trial_in_block << ' ' << store::name(trial.type) << ' ' << trial.procedure << ' '
         << trial.level.value_or(0) << ' ' << trial.correct_response.value_or("-") << ' '
         << trial.given.response.value_or("-") << ' ' << store::name(trial.outcome) << ' '
         << trial.learned.state_hash;
    for (const auto& [name, value] : trial.factors)
      if (const auto* number = std::get_if<double>(&value)) text << ' ' << name << ' ' << *number;
    if (trial.given.confidence) text << " confidence " << *trial.given.confidence;
    text << '\n';
  }
  return core::sha256(text.str()).substr(0, 16);
}

/// Returns a hash of the stimuli and their times, to the last bit.
std::string driven(const std::vector<core::TrialRow>& trials) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const auto& trial : trials) {
    text << trial.timing.onset_ns << ' ' << trial.timing.response_time_s.value_or(-1);
    for (const auto& tone : trial.tones)
      text << ' ' << tone.frequency_Hz << ' ' << tone.amplitude_um << ' ' << tone.onset_frame;
    text << '\n';
  }
  return core::sha256(text.str()).substr(0, 16);
}

/// Returns a hash of the mutual information of every stimulus over 20 answers, to the last bit. The
/// parameters in `nuisance` count as nuisance parameters.
std::string informed(const std::vector<std::string>& nuisance) {
  procedure::Spec spec;
  spec.kind = procedure::Kind::psi_marginal;
  spec.nuisance = nuisance;
  for (int i = 0; i < 7; ++i) spec.stimuli.values.push_back(-30 + 5 * i);
  for (int i = 0; i < 21; ++i) spec.threshold.values.push_back(-35 + 2 * i);
  spec.slope.values = {0.5, 1, 1.5, 2, 3, 4, 5};
  spec.guess.values = {0, 0.25, 0.5};
  spec.lapse.values = {0, 0.01, 0.02, 0.04};
  procedure::Posterior posterior(spec);
  std::vector<double> all;
  for (int trial = 0; trial < 20; ++trial) {
    const auto information = posterior.information();
    all.insert(all.end(), information.begin(), information.end());
    posterior.update(posterior.best_stimulus(), trial % 3 != 1);
  }
  return hash_of(all);
}

struct Recorded {
  const char *protocol, *decided, *driven;
};

constexpr Recorded kSessions[] = {
    {"demo", "bda7b44a5a1ce1ab", "99a930b8032aed3f"},
    {"boundary-constant", "b00ab55acb68f700", "c331b39a801ae9c4"},
    {"boundary-adaptive", "60c35b42c44ba56d", "264b19625d990d7b"},
    {"boundary-adjustment", "20488ee64d19916e", "57e1e850803a6273"},
    {"friction-2ifc", "f254fac43e67db5f", "9eea4be7ac753c59"},
    {"friction-staircase", "73be2a4b407a38ee", "59166cc9296dd387"},
    {"friction-same-different", "6cf59207376ed713", "db60992d42e78ad8"},
    {"speed-accuracy", "ab11b2008b1dfe51", "6df765de11f2a4fd"},
    {"smoothness-points", "97853ee09d67fb8a", "5820a77bdc8728a7"},
    {"smoothness-line", "50117bb6c419b5e1", "5820a77bdc8728a7"},
    {"magnitude-free", "e896a54b91f9083a", "5820a77bdc8728a7"},
    {"magnitude-standard", "e896a54b91f9083a", "20f24ce4e08d1d1d"},
    {"friction-confidence", "d9bac3caf1dcf808", "6dfc0cdffeb0ca19"},
    {"friction-detection", "d23c74f732cff1ab", "5242a5137d095406"},
    {"friction-identification", "159c20d40d282069", "e21434fc588e8d9e"},
    {"friction-3ifc", "12249024c7cd68c7", "ddb1edda9eb2a2eb"},
    {"friction-4ifc", "3ede10aa7ad28604", "64d5c3c1dddfe0b2"},
    {"friction-time-limit", "f69f132afbca3235", "edf57a000a356226"},
    {"friction-abx", "c95786baf94d2faf", "81a6d1b7adaa8862"},
    {"limits-boundary", "f095f41207962b6a", "66498d619f44db92"},
    {"response-signal", "ef371dbbfaebe6ce", "5d99f9739e94ada6"},
    {"response-signal-buzz", "ef371dbbfaebe6ce", "ea2cd51dacda0434"},
    {"response-signal-flash", "ef371dbbfaebe6ce", "5d99f9739e94ada6"},
    {"friction-rating", "293a46da12ce06a1", "4932411790c12386"},
    {"two-spots-oddity", "d84ae5fc63983e76", "b2d2fee42b03d1aa"},
    {"bisection", "ae550ca70047cc3d", "5d4c6fea31190aa4"},
    {"matching", "671daafb56301337", "6b2912f4e02cfe2d"},
    {"cross-modal-matching", "0c39d187fabe8c6d", "58ae8ed91a523391"},
    {"magnitude-production", "1d495d0acb183b2d", "91e68fcc91fcfc60"},
    {"friction-pairs", "e4d6b80016ae1b00", "60a2bf2c17115175"},
    {"friction-triads", "2368bf91a31b0e4f", "5c3f0893736e40b5"},
};

}  // namespace

TEST_CASE("a burst has the same samples on every machine, bit for bit", "[everywhere]") {
  CHECK(rendered<double>(burst()) == "a63dd0d74bfd91b0");
  CHECK(rendered<std::int32_t>(burst()) == "485448f497561d34");  // samples with dither and quantisation
  auto other = burst();
  other.tones.tones[0].frequency_Hz += 1e-9;  // negative control: the hash detects a change of the last digit
  CHECK(rendered<double>(other) != rendered<double>(burst()));
}

TEST_CASE("the information of a stimulus is the same on every machine, bit for bit", "[everywhere]") {
  CHECK(informed({}) == "7e61a1b162de7732");
  CHECK(informed({"lapse"}) == "5a163edd989ec276");
  CHECK(informed({"guess", "lapse"}) == "4cca3d50ab4d6231");
  CHECK(informed({"slope", "guess"}) == "e8e5f1bdc0cd250d");
  CHECK(informed({"threshold"}) == "25837370ab8fb0eb");
}

TEST_CASE("the same seed gives the same session on every machine", "[everywhere]") {
  for (const auto& recorded : kSessions) {
    const TemporaryFolder folder;
    const auto trials = session_of(recorded.protocol, folder, "null:");
    INFO(recorded.protocol);
    CHECK(decided(trials) == recorded.decided);
    CHECK(driven(trials) == recorded.driven);
  }
}

TEST_CASE("a session's rendered file is the same on every machine, bit for bit", "[everywhere]") {
  const TemporaryFolder folder;
  session_of("demo", folder, "wav:" + (folder / "out.wav"));
  std::ifstream file(folder / "out.wav", std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  CHECK(bytes.size() > 1000000);
  CHECK(hash_of(bytes) == "fafeeaee1d1f3335");
}
