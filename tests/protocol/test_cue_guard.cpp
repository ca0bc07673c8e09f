#include "station/protocol/cue_guard.hpp"

#include <algorithm>

#include "station/text/toml.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using protocol::CueReport;

namespace {

const std::string root = TURNPOINT_SOURCE_DIR;

std::string replaced(std::string where, const std::string& from, const std::string& to) {
  const auto at = where.find(from);
  REQUIRE(at != std::string::npos);
  return where.replace(at, from.size(), to);
}

std::string source(const std::string& name) { return text::read_file(root + "/protocols/" + name); }

/// In closed form, so that a survey is quick.
rig::Rig quick() {
  auto text = text::read_file(root + "/deploy/rigs/simulated.toml");
  text = replaced(text, "edges = \"clamped\"", "edges = \"supported\"");
  return rig::parse(replaced(text, "thickness_mm = 2.0", "thickness_mm = 4.2"), "r.toml");
}

double accuracy(const std::vector<CueReport>& reports, const std::string& cue) {
  for (const auto& report : reports)
    if (report.cue == cue) return report.accuracy;
  FAIL("no report of " + cue);
  return 0;
}

/// The target at three strengths beside a standard that is everywhere the same; `leak` changes the target.
protocol::Survey pair_survey(double scene::Cues::*leak, double factor) {
  protocol::Survey survey;
  scene::Cues plain;
  plain.pitch_Hz = 18'000, plain.loudness_dB = 4, plain.wide_end_amplitude_m = 1e-6;
  plain.stripe_pitch_m = 4e-3, plain.edge_width_m = 9e-3, plain.strip_width_m = 20e-3;
  protocol::Sight standard;
  standard.scene = "reference", standard.block = "main", standard.cues = plain;
  survey.sights.push_back(standard);
  for (const double level : {-20.0, -12.0, -6.0}) {
    auto target = standard;
    target.scene = "comparison";
    target.factors["contrast_dB"] = level;
    if (leak != nullptr) target.cues.*leak *= factor;
    survey.sights.push_back(target);
  }
  return survey;
}

struct Leak {
  const char* cue;
  double scene::Cues::*value;
};
const Leak leaks[] = {{"pitch", &scene::Cues::pitch_Hz},
                      {"loudness", &scene::Cues::loudness_dB},
                      {"amplitude at the wide end", &scene::Cues::wide_end_amplitude_m},
                      {"stripe pitch at the wide end", &scene::Cues::stripe_pitch_m},
                      {"edge sharpness", &scene::Cues::edge_width_m},
                      {"strip width", &scene::Cues::strip_width_m}};

}  // namespace

TEST_CASE("each cue that differs between target and standard tells the answer, and no other does",
          "[protocol][cues]") {
  const auto protocol = protocol::parse(source("friction-2ifc.toml"), "p.toml");
  for (const auto& leak : leaks) {
    const auto reports = protocol::cue_guard(protocol, pair_survey(leak.value, 1.1));
    for (const auto& report : reports) {
      INFO(leak.cue << " leaks, " << report.cue << " is asked");
      CHECK(report.accuracy == Approx(report.cue == leak.cue ? 1.0 : 0.5));
    }
  }
}

TEST_CASE("without a leak every one-cue observer stays at chance", "[protocol][cues]") {
  const auto protocol = protocol::parse(source("friction-2ifc.toml"), "p.toml");
  const auto reports = protocol::cue_guard(protocol, pair_survey(nullptr, 1));
  CHECK(reports.size() == 8);
  for (const auto& report : reports) CHECK(report.accuracy == Approx(0.5));
  // Less than a thousandth is no difference to anybody.
  const auto tiny = protocol::cue_guard(protocol, pair_survey(&scene::Cues::pitch_Hz, 1.0005));
  CHECK(accuracy(tiny, "pitch") == Approx(0.5));
}

TEST_CASE("a target with ramps of its own is told by its duration", "[protocol][cues]") {
  const auto text = source("friction-2ifc.toml");
  const auto leaking = protocol::parse(replaced(text, "friction_contrast_dB = \"contrast_dB\"",
                                                "friction_contrast_dB = \"contrast_dB\"\nramp_ms = 300"),
                                       "p.toml");
  CHECK(accuracy(protocol::cue_guard(leaking, pair_survey(nullptr, 1)), "duration") == Approx(1));
  const auto same = protocol::parse(text, "p.toml");
  CHECK(accuracy(protocol::cue_guard(same, pair_survey(nullptr, 1)), "duration") == Approx(0.5));
}

TEST_CASE("of three intervals a leak finds the odd one always, and chance is a third", "[protocol][cues]") {
  const auto protocol = protocol::parse(source("two-spots-oddity.toml"), "p.toml");
  auto survey = pair_survey(&scene::Cues::pitch_Hz, 1.1);
  for (auto& sight : survey.sights) {
    sight.scene = sight.scene == "reference" ? protocol.task.standard : protocol.task.target;
    sight.factors.clear();
  }
  const auto reports = protocol::cue_guard(protocol, survey);
  CHECK(accuracy(reports, "pitch") == Approx(1));
  CHECK(accuracy(reports, "strip width") == Approx(1.0 / 3));
}

TEST_CASE("a mark that stays in one place lets pitch tell the side, one that moves less so",
          "[protocol][cues]") {
  const auto guarded = [](const std::string& text) {
    const auto protocol = protocol::parse(text, "p.toml");
    return protocol::cue_guard(protocol, protocol::survey(protocol, quick()));
  };
  const auto text = source("boundary-constant.toml");
  const auto fixed = guarded(replaced(text, "levels = [152.0, 158.0, 164.0]", "levels = [158.0]"));
  const auto moving = guarded(text);
  CHECK(accuracy(fixed, "strip width") == Approx(1));
  CHECK(accuracy(moving, "strip width") < accuracy(fixed, "strip width"));
  CHECK(accuracy(moving, "always the same key") == Approx(0.5));
}

TEST_CASE("practice that runs the main blocks' procedure does not take its levels out of the guard",
          "[protocol][cues]") {
  const auto protocol = protocol::parse(source("speed-accuracy.toml"), "p.toml");
  const auto reports = protocol::cue_guard(protocol, protocol::survey(protocol, quick()));
  // Friction is made of amplitude, and it is what the task asks for: the guard must see it.
  CHECK(accuracy(reports, "amplitude at the wide end") > 0.9);
  CHECK(accuracy(reports, "always the same key") == Approx(0.5));
}

TEST_CASE("levels on one side only are answered by one key", "[protocol][cues]") {
  const auto text =
      replaced(source("boundary-constant.toml"), "values = [-28.0, -16.0, -8.0, -3.0, 3.0, 8.0, 16.0, 28.0]",
               "values = [-3.0, 3.0, 8.0, 16.0]");
  const auto protocol = protocol::parse(text, "p.toml");
  const auto reports = protocol::cue_guard(protocol, protocol::survey(protocol, quick()));
  CHECK(accuracy(reports, "always the same key") == Approx(0.75));
}

TEST_CASE("the best criterion is found in either direction, and one answer where nothing tells",
          "[protocol][cues]") {
  using protocol::best_criterion;
  const auto up = best_criterion({{1, 0}, {2, 0}, {3, 1}, {4, 1}});
  CHECK(up.accuracy == 1);
  CHECK((up.answer(2) == 0 && up.answer(3) == 1));
  const auto down = best_criterion({{1, 1}, {2, 1}, {3, 0}, {4, 0}});
  CHECK((down.accuracy == 1 && down.answer(2) == 1 && down.answer(3) == 0));
  const auto none = best_criterion({{5, 1}, {5, 1}, {5, 0}});
  CHECK(none.accuracy == Approx(2.0 / 3));
  CHECK(none.answer(5) == 1);
  CHECK(best_criterion({}).accuracy == 0.5);
}
