#include <cmath>
#include <filesystem>
#include <fstream>

#include "station/analysis/psychometric_posterior.hpp"
#include "station/rehearsal/parallel.hpp"
#include "tests/coverage/table.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace coverage;
namespace analysis = turnpoint::analysis;

namespace {

std::vector<Session> sessions_of(const std::string& procedure, const Source& source, int count, int trials,
                                 int references) {
  const Design design(procedure);
  std::vector<Session> sessions(static_cast<std::size_t>(count));
  turnpoint::rehearsal::in_parallel(count, 2, {}, [&](int i) {
    sessions[static_cast<std::size_t>(i)] =
        design.run(source, static_cast<std::uint64_t>(i + 1), i < references, {trials});
  });
  return sessions;
}

}  // namespace

TEST_CASE("Printed 95 % intervals after 96 trials of QUEST+ hold true values drawn from the prior",
          "[coverage]") {
  // Tests one cell of the table that build/release/bin/coverage makes. Three standard errors of 2000 sessions
  // are 1.5 %.
  const auto sessions = sessions_of("quest-plus", sources()[0], 2000, 96, 40);
  for (const auto quantity : {threshold, slope, level_75}) {
    const auto found = tally(sessions, 1, quantity);
    CAPTURE(kQuantities[quantity], found.coverage(), found.abstained());
    CHECK(found.coverage() >= 0.935);
    CHECK(found.coverage() <= 0.965);
    REQUIRE(found.width_ratio);
    CHECK(*found.width_ratio < 1.3);
    CHECK(*found.width_ratio > 0.8);
    // Negative control: intervals a fifth narrower, or twice as wide, would be detected.
    CHECK(tally(sessions, 1, quantity, 0.8).coverage() < 0.935);
    CHECK(broken_promise(tally(sessions, 1, quantity, 2), sources()[0], quantity, 96) != "");
  }
  CHECK(tally(sessions, 1, threshold).abstained() <= 0.05);
}

TEST_CASE("Intervals after 200 trials of QUEST+ hold the slope of a shallow function off the prior's centre",
          "[coverage]") {
  // With a prior that is flat up to its ends, the coverage would be 92 %. Two standard errors of 800 sessions
  // are 1.4 %.
  const auto sessions = sessions_of("quest-plus", sources()[3], 800, 200, 0);
  CHECK(tally(sessions, 2, slope).coverage() >= 0.945);
  CHECK(tally(sessions, 2, threshold).coverage() >= 0.93);
}

TEST_CASE("A cell keeps its promise only if the observed share does, without an allowance for chance",
          "[coverage]") {
  const auto broken = [](int held, std::size_t source, Quantity quantity) {
    Tally found;
    found.sessions = found.printed = 2000, found.held = held;
    return !broken_promise(found, sources()[source], quantity, 200).empty();
  };
  CHECK(broken(1859, 1, threshold));
  CHECK(broken(1859, 1, level_75));
  CHECK_FALSE(broken(1860, 1, threshold));
  CHECK(broken(1899, 1, slope));
  CHECK_FALSE(broken(1900, 1, slope));
  CHECK(broken(1869, 0, slope));
  CHECK(broken(1931, 0, slope));
  CHECK_FALSE(broken(1930, 0, slope));
  Tally found;
  found.sessions = found.printed = 2000, found.held = 1850;
  CHECK(found.standard_error() == Approx(0.0059).margin(0.0001));
}

TEST_CASE("Fixed true values of the coverage table lie in the middle half of the prior, off its centre",
          "[coverage]") {
  const auto prior =
      analysis::prior_around(analysis::Function::weibull, analysis::Scale::linear, {-30, -3}, {});
  const auto share = [](double value, double low, double high) { return (value - low) / (high - low); };
  int off_centre = 0;
  for (const auto& source : sources()) {
    if (!source.fixed) continue;
    const double threshold = share(source.fixed->threshold_dB, prior.threshold_low, prior.threshold_high),
                 slope = share(std::log(source.fixed->slope), std::log(prior.slope_low),
                               std::log(prior.slope_high));
    CHECK((threshold > 0.25 && threshold < 0.75 && slope > 0.25 && slope < 0.75));
    off_centre += std::abs(threshold - 0.5) > 0.1 ? 1 : 0;
  }
  CHECK(off_centre >= 6);
}

TEST_CASE("A session of the coverage table depends only on its seed, not on the other sessions",
          "[coverage]") {
  const Design design("staircase");
  const auto one = design.run(sources()[1], 7, false), again = design.run(sources()[1], 7, false),
             other = design.run(sources()[1], 8, false);
  for (std::size_t i = 0; i < kTrials.size(); ++i) {
    CHECK(one.after[i].interval == again.after[i].interval);
    CHECK(one.after[i].interval != other.after[i].interval);
  }
}

TEST_CASE("An interrupted run of the coverage table continues where it stopped", "[coverage]") {
  const TemporaryFolder folder;
  const auto path = folder / "cell.csv";
  const auto sessions = sessions_of("psi", sources()[0], 3, 48, 1);
  append(path, sessions);
  std::ofstream(path, std::ios::app) << "4,-12.5,1";  // an incomplete line, as after an interruption
  const auto found = read(path);
  REQUIRE(found.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(found[i].seed == sessions[i].seed);
    CHECK(found[i].truth.slope == sessions[i].truth.slope);
    CHECK(found[i].after[0].interval == sessions[i].after[0].interval);
    CHECK(found[i].after[0].reference == sessions[i].after[0].reference);
  }
  CHECK(missing_seeds(found, 5) == std::vector<std::uint64_t>{4, 5});
}

TEST_CASE("Parts of a coverage table are joined in any order, but no seed counts twice", "[coverage]") {
  const TemporaryFolder folder;
  const auto path = folder / "cell.csv";
  const auto sessions = sessions_of("psi", sources()[0], 3, 48, 0);
  append(path, {sessions[2]});
  append(path, {sessions[0]});
  CHECK(missing_seeds(read(path), 3) == std::vector<std::uint64_t>{2});
  append(path, {sessions[2]});
  CHECK_THROWS_WITH(read(path), path + ": seed 3 is there twice");
}
