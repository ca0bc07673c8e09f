// Compares the cue guard with a simulated observer in whole sessions (cue_brute_force.hpp).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/rehearsal/cue_guard.hpp"
#include "station/rehearsal/parallel.hpp"
#include "tests/rehearsal/cue_brute_force.hpp"
#include "tests/rehearsal/random_protocol.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;

namespace {

const rehearsal::CueReport& report_on(const rehearsal::CueGuard& guard, const std::string& cue) {
  const auto found = std::find_if(guard.reports.begin(), guard.reports.end(),
                                  [&](const auto& report) { return report.cue == cue; });
  return found == guard.reports.end() ? throw std::logic_error("no report of " + cue) : *found;
}

struct Compared {
  std::string text, faults;
  double worst = 0, error = 0;
};

Compared compare(unsigned seed, std::map<std::string, int>& features) {
  Compared compared{};
  compared.text = tests::random_protocol(seed, features);
  const auto protocol = protocol::parse(compared.text, "random.toml");
  const auto survey = protocol::survey(protocol, quick_rig());
  if (!survey.problems.empty())
    return {compared.text, "cannot run: " + format(survey.problems.front()), 0, 0};
  const auto guard = rehearsal::cue_guard(protocol, quick_rig(), survey);
  if (guard.reports.empty())
    return {compared.text, "no reports: " + guard.not_compared + guard.nothing_to_tell, 0, 0};
  for (const auto& expected : tests::cue_brute_force(protocol, quick_rig())) {
    const auto& stated = report_on(guard, expected.cue);
    const auto note = [&](const std::string& what, double said, double found, double error) {
      compared.worst = std::max(compared.worst, std::fabs(said - found));
      compared.error = std::max(compared.error, error);
      if (std::fabs(said - found) > 0.02)
        compared.faults += expected.cue + ", " + what + ": stated " + std::to_string(said) + ", found " +
                           std::to_string(found) + " +- " + std::to_string(error) + "\n";
    };
    const double gain = stated.accuracy - stated.chance, every_level = expected.accuracy - expected.chance;
    const double own_gain = expected.own_gain.value_or(every_level);
    const bool only_sessions = expected.own_gain && stated.cue == "always the same key";
    note("gain", gain, only_sessions ? own_gain : std::max(every_level, own_gain), expected.error);
    if (expected.own_gain.has_value() != stated.whole_sessions.has_value())
      compared.faults += stated.cue + ": sessions of its own, on one side only\n";
    else if (const auto& own = stated.whole_sessions)
      note("own sessions", own->accuracy - own->chance, own_gain, expected.own_error);
    else
      note("accuracy", stated.accuracy, expected.accuracy, expected.error);
  }
  return compared;
}

}  // namespace

// Four cases, because one would take too long for one test: of 8 protocols each, or of 50 with TURNPOINT_CUE_SEEDS.
TEMPLATE_TEST_CASE_SIG(
    "for random protocols, the cue guard's accuracy is within 2 % of that of an observer of one cue in whole "
    "sessions",
    "[cues]", ((int part), part), 0, 1, 2, 3) {
  const char* const asked = std::getenv("TURNPOINT_CUE_SEEDS");
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  constexpr int most = 1;  // with a sanitizer a few are enough
#else
  const int most = asked ? 50 : 8;
#endif
  const int first = (asked ? std::stoi(asked) : 0) + most * part;
  const char* const dash = asked ? std::strchr(asked, '-') : nullptr;
  const int count = dash ? std::clamp(std::stoi(dash + 1) - first + 1, 0, most) : most;
  std::vector<Compared> compared(static_cast<std::size_t>(count));
  rehearsal::in_parallel(count, rehearsal::processors(), {}, [&](int i) {
    std::map<std::string, int> features;
    compared[static_cast<std::size_t>(i)] = compare(static_cast<unsigned>(first + i), features);
  });
  int within = 0;
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    const auto& one = compared[static_cast<std::size_t>(i)];
    within += one.faults.empty() ? 1 : 0;
    worst = std::max(worst, one.worst);
    INFO("random protocol " << first + i << "\n" << one.text);
    CHECK(one.faults == "");
  }
  if (asked) WARN(within << " of " << count << " protocols within 2 %, worst difference " << worst);
}

TEST_CASE("each feature of a protocol occurs in at least 5 of the 200 random protocols", "[cues]") {
  std::map<std::string, int> coverage;
  for (unsigned seed = 0; seed < 200; ++seed) {
    std::map<std::string, int> features;
    tests::random_protocol(seed, features);
    for (const auto& [feature, n] : features) coverage[feature] += n;
  }
  for (const auto& [feature, n] : coverage) {
    INFO(feature << " in " << n << " protocols");
    CHECK(n >= 5);
  }
  CHECK(coverage.size() >= 22);
}
