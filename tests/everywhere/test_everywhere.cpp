#include <fstream>
#include <sstream>

#include "station/app/prepare.hpp"
#include "station/drive/synth.hpp"
#include "station/store/read.hpp"
#include "station/text/number.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

// What must not depend on the machine, as hashes of its bits. They were recorded on amd64 with g++ 12 and
// hold on arm64 and with g++ 14; a change of what is presented, drawn or rendered changes them, and is made
// on purpose.

using namespace turnpoint;

namespace {

template <class Value>
std::string hash_of(const std::vector<Value>& values) {
  return text::sha256({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)})
      .substr(0, 16);
}

/// Two tones that glide to two others, ramped, over a second; a pulse marks onset and change.
drive::Burst burst() {
  drive::Burst burst;
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
  burst.marker = {drive::MarkerKind::pulse, 1, 0.5, 1000, 192};
  return burst;
}

template <class Sample>
std::string rendered(const drive::Burst& burst) {
  const drive::Format format;
  drive::Synth synth(format, drive::Precision::exact);
  REQUIRE(synth.start(drive::prepare(burst, format)));
  std::vector<Sample> all, block(2 * 384);
  for (std::int64_t frame = 0; frame < 200064; frame += 384) {
    synth.render(frame, std::span<Sample>(block));
    all.insert(all.end(), block.begin(), block.end());
  }
  return hash_of(all);
}

/// A simulated session of a shipped protocol into the folder.
std::vector<store::TrialRow> session_of(const std::string& protocol, const TemporaryFolder& folder,
                                        const std::string& output) {
  app::RunRequest request;
  request.protocol = std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + protocol + ".toml";
  request.rig = std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/simulated.toml";
  request.participant = "P01";
  request.database = folder / "a.sqlite";
  request.observer = "sim";
  request.seed = 20240229;
  request.headless = true;
  auto setup = app::prepare(request);
  setup.rig.output.uri = output;
  session::Inputs nobody;
  const auto summary = session::run(setup, nullptr, nobody);
  std::vector<store::TrialRow> trials;
  for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
    trials.insert(trials.end(), block.trials.begin(), block.trials.end());
  return trials;
}

/// What was asked and answered, to the last bit.
std::string decided(const std::vector<store::TrialRow>& trials) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const auto& trial : trials) {
    text << trial.trial_in_block << ' ' << store::name(trial.type) << ' ' << trial.procedure << ' '
         << trial.level.value_or(0) << ' ' << trial.correct_response.value_or("-") << ' '
         << trial.response.value_or("-") << ' ' << store::name(trial.outcome) << ' ' << trial.state_hash;
    for (const auto& [name, value] : trial.factors)
      if (const auto* number = std::get_if<double>(&value)) text << ' ' << name << ' ' << *number;
    text << '\n';
  }
  return text::sha256(text.str()).substr(0, 16);
}

/// What was felt and when, to the last bit.
std::string driven(const std::vector<store::TrialRow>& trials) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const auto& trial : trials) {
    text << trial.onset_ns << ' ' << trial.response_time_s.value_or(-1);
    for (const auto& tone : trial.tones)
      text << ' ' << tone.frequency_Hz << ' ' << tone.amplitude_um << ' ' << tone.onset_frame;
    text << '\n';
  }
  return text::sha256(text.str()).substr(0, 16);
}

struct Recorded {
  const char *protocol, *decided, *driven;
};

constexpr Recorded kSessions[] = {
    {"demo", "1e7a102947754027", "5837e23d81de6d01"},
    {"boundary-constant", "68a347a734337f8d", "4eeb18b66441baf5"},
    {"boundary-adaptive", "837e5ba18b7aca9e", "0958f128a86192c1"},
    {"boundary-adjustment", "20488ee64d19916e", "3d1339a75b68e038"},
    {"friction-2ifc", "84d0794ec6f78435", "0845a0b496dda7b4"},
    {"friction-staircase", "71a6528bb8dfa6be", "479b4a9fed888891"},
    {"friction-same-different", "52e5a933555ec9fd", "79a6075248e623b0"},
    {"speed-accuracy", "f504e3ad3c70600d", "8c7c6da66c40ae05"},
    {"two-spots-oddity", "611e24eaf282e1d8", "5b847c594efe0f73"},
};

}  // namespace

TEST_CASE("a burst has the same samples on every machine, bit for bit", "[everywhere]") {
  CHECK(rendered<double>(burst()) == "a63dd0d74bfd91b0");
  CHECK(rendered<std::int32_t>(burst()) == "485448f497561d34");  // dithered and quantised
  auto other = burst();
  other.tones.tones[0].frequency_Hz += 1e-9;  // the hash sees the last digit
  CHECK(rendered<double>(other) != rendered<double>(burst()));
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
  CHECK(hash_of(bytes) == "4751be3e7d5b18bf");
}
