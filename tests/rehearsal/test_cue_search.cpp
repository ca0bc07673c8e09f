// Tests the search for an observer's best rule in sessions of its own, with random protocols of the kind
// yes/no.
#include "station/rehearsal/cue_search.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "tests/rehearsal/random_protocol.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;
using rehearsal::CueKind;

namespace {

std::string text_of(unsigned seed) {
  std::map<std::string, int> features;
  return tests::random_protocol(seed, features);
}

const CueKind& kind_of(std::string_view name) {
  return *std::find_if(std::begin(rehearsal::cue_kinds), std::end(rehearsal::cue_kinds),
                       [name](const CueKind& kind) { return kind.name == name; });
}

struct Setting {
  explicit Setting(const std::string& text) : protocol(protocol::parse(text, "p.toml")) {}

  std::optional<rehearsal::Strategy> best(const CueKind& kind) {
    return rehearsal::CueSearch(observer).best(kind, {1e-9, 1e-3}, all);
  }

  protocol::Protocol protocol;
  rig::Rig rig = quick_rig();
  protocol::Survey survey = protocol::survey(protocol, rig);
  std::stop_token stop;
  rehearsal::Steps steps;
  rehearsal::CueObserver observer{protocol, rig, survey, stop, steps};
  rehearsal::Cells all = observer.cells_of(rehearsal::census_of(protocol));
};

}  // namespace

TEST_CASE("sessions in which chance plays no part are simulated only twice", "[cues]") {
  const auto& amplitude = kind_of("amplitude at the wide end");
  const auto sessions = [&](const std::string& text, const procedure::Spec* other = nullptr) {
    Setting setting(text);
    if (other) setting.protocol.procedures.push_back(*other);
    rehearsal::OwnSessions own;
    const auto rule = setting.observer.best_strategy(amplitude, {1e-9, 1e-3}, setting.all);
    setting.observer.run_sessions(amplitude, rule, 10, own, 0);
    return own.done.size();
  };
  const auto roved = text_of(7);
  const auto plain =
      replaced(replaced(roved, "rove_dB = 1.0", "rove_dB = 0.0"), "rove_dB = 1.0", "rove_dB = 0.0");
  CHECK(sessions(roved) == 10);
  CHECK(sessions(plain) == 2);
  procedure::Spec other;  // starts its series at random
  other.kind = procedure::Kind::limits;
  CHECK(sessions(plain, &other) == 10);
}

TEST_CASE("a rule is found that works only because the cue does not change without a signal", "[cues]") {
  // The strength roves, but not within an interval, in which it changes only if there is a signal.
  Setting setting(text_of(65));
  const auto& amplitude = kind_of("amplitude at the wide end");
  const auto found = setting.best(amplitude);
  REQUIRE(found);
  CHECK(found->feature == rehearsal::Feature::change);
  CHECK(setting.observer.by_itself(amplitude, *found, setting.all).gain() == Approx(0.45).margin(0.01));
}

TEST_CASE("no rule is found for a cue that is the same in all trials", "[cues]") {
  CHECK_FALSE(Setting(text_of(65)).best(kind_of("duration")));
}
