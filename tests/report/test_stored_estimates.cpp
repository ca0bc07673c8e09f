#include "station/report/stored_estimates.hpp"

#include "tests/report/simulated_report.hpp"

// Tests what the report says of the procedures' own estimates.

using namespace turnpoint;

TEST_CASE("a report has each procedure's own estimate, as it was at the end of the session", "[report]") {
  for (const std::string name :
       {"friction-2ifc", "friction-staircase", "boundary-adaptive", "two-spots-oddity"}) {
    INFO(name);
    const auto protocol = protocol::parse(shipped(name), "p.toml");
    const auto rehearsal = rehearsal::rehearse(
        protocol, 0, 5, rehearsal::rehearser(simulation::Observer(simulation::parse("sim"))));
    report::SessionData data;
    report::add_trials(rehearsal.blocks, protocol, data);
    report::add_estimates(rehearsal.blocks, protocol, 5, {}, data);
    data.replicates = 40;
    REQUIRE_FALSE(data.estimates.empty());
    const auto html = report::to_html(report::summarise(data));
    CHECK(html.find("The procedure\u2019s own estimate") != std::string::npos);
    CHECK((html.find("staircase settles where") != std::string::npos) ==
          (name == "friction-staircase" || name == "boundary-adaptive"));
    CHECK((html.find("a posterior estimates") != std::string::npos) == (name != "friction-staircase"));
    std::size_t same = 0;
    for (const auto& mine : data.estimates)
      for (const auto& theirs : rehearsal.estimates)
        if (mine.procedure == theirs.procedure && mine.parameter == theirs.parameter &&
            mine.mean == theirs.mean && mine.sd == theirs.sd)
          ++same;
    CHECK(same == data.estimates.size());
  }
}

TEST_CASE("a report has the ids of answers, and the reversals that a staircase averaged", "[report]") {
  const auto source = replaced(shipped("friction-staircase"), "initial_down = 1 ",
                               "discard_reversals = 4\ninitial_down = 1 ");
  const auto data = data_of(source, "sim:threshold=-16");
  CHECK(data.choices == std::vector<std::string>{"first", "second"});
  CHECK(core::say(data.level_label, "en") == "Contrast (dB)");
  REQUIRE(data.estimates.size() == 2);
  CHECK(data.estimates[0].basis == "reversals 5 to 10 of 10");
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("reversals 5 to 10 of 10") != std::string::npos);
  CHECK(html.find("Threshold (dB)") != std::string::npos);
  CHECK(html.find("BIS") == std::string::npos);  // the balanced integration score needs two conditions
  const auto demo =
      data_of(replaced(shipped("demo"), "[\"en\", \"de\", \"ja\"]", "[\"en\", \"de\", \"ja\"]"));
  CHECK(demo.choices == std::vector<std::string>{"left", "right"});
}

TEST_CASE("a report says that a staircase ended early, and why", "[report]") {
  const auto always_right = data_of(shipped("friction-staircase"), "sim:threshold=-200,lapse=0");
  REQUIRE_FALSE(always_right.early_ends.empty());
  CHECK(always_right.early_ends.front().block == "main");
  const auto summary = report::summarise(always_right);
  CHECK(report::to_html(summary).find("Ended early in main: ") != std::string::npos);
  CHECK(report::to_html(summary).find("10 steps in a row at the end of its range") != std::string::npos);
  CHECK(report::to_json(summary).find("10 steps in a row at the end of its range") != std::string::npos);
  // one that meets its rules says nothing
  const auto ordinary = data_of(shipped("friction-staircase"), "sim:threshold=-16");
  CHECK(ordinary.early_ends.empty());
  CHECK(report::to_html(report::summarise(ordinary)).find("Ended early") == std::string::npos);
}

TEST_CASE("the report recomputes the estimates of the method of limits from the stored trials", "[report]") {
  auto source = replaced(shipped("limits-boundary"), "procedures = [\"series\"]",
                         "procedures = [\"series\", \"drawn\"]\ninterleave = \"random\"");
  source = replaced(source, "[[block]]",
                    "[[procedure]]\nname = \"drawn\"\ncopy = \"series\"\n"
                    "start_ascending = { uniform = [-30.0, -20.0] }\n\n[[block]]");
  const auto protocol = protocol::parse(source, "p.toml");
  // many trials without an answer: some series end without a midpoint
  const simulation::Observer observer(simulation::parse("sim:threshold=5,anticipation=0.4"));
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto rehearsal = rehearsal::rehearse(protocol, 0, seed, rehearsal::rehearser(observer));
    report::SessionData data;
    report::add_trials(rehearsal.blocks, protocol, data);
    report::add_estimates(rehearsal.blocks, protocol, seed, {}, data);
    REQUIRE(rehearsal.estimates.size() == 8);
    REQUIRE(data.estimates.size() == 8);
    for (std::size_t i = 0; i < 8; ++i) {
      const auto& stored = data.estimates[i];
      const auto& made = rehearsal.estimates[i];
      CHECK(stored.procedure == made.procedure);
      CHECK(stored.parameter == made.parameter);
      CHECK(stored.mean == made.mean);
      CHECK(stored.sd == made.sd);
      CHECK(stored.basis == made.basis);
    }
    const auto html = report::to_html(report::summarise(data));
    CHECK(html.find("habituation") != std::string::npos);
    CHECK(html.find("threshold ascending (mm)") != std::string::npos);
    CHECK(html.find("A staircase") == std::string::npos);
  }
}

TEST_CASE("the threshold along the second dimension is reported, and no curve over all trials", "[report]") {
  const auto source = shipped("friction-boundary-2d");
  const auto data = data_of(source, "sim:threshold=-16,gradient=0.1,lapse=0");
  CHECK(data.thresholds_differ);
  REQUIRE(data.threshold_curves.size() == 1);
  const auto& curve = data.threshold_curves[0];
  CHECK(core::say(curve.label, "en") == "End (mm)");
  CHECK(curve.trials.size() == 96);
  REQUIRE(curve.points.size() == 7);
  CHECK(curve.points.front().second == 120);
  const double rise = curve.points.back().threshold - curve.points.front().threshold;
  for (const auto& point : curve.points)
    CHECK((point.interval.low < point.threshold && point.threshold < point.interval.high));
  const auto json = report_of(data);
  CHECK(json["fits"].empty());
  CHECK(json["threshold_curves"][0]["points"].size() == 7);
  bool gradient = false;
  for (const auto& estimate : json["estimates"])
    if (estimate["parameter"] == "gradient") {
      gradient = true;
      CHECK(estimate["unit"] == "dB/mm");
      CHECK(estimate["interval"]["low"] < estimate["mean"]);
      CHECK(estimate["interval"]["high"] > estimate["mean"]);
      // without a floor, the mean threshold rises by the mean gradient, over 60 mm
      CHECK(rise == Approx(60 * estimate["mean"].get<double>()).margin(1e-9));
    }
  CHECK(gradient);
  const auto html = report::to_html(report::summarise(data));
  CHECK(html.find("Threshold along the second dimension") != std::string::npos);
  CHECK(html.find("change of the threshold (dB/mm)") != std::string::npos);
  CHECK(html.find("<h2>Psychometric function</h2>") == std::string::npos);
  // by the levels of the second factor there is one curve for each of them
  const auto by = data_of(source + "\n[analysis]\nby = \"end_mm\"\n");
  CHECK_FALSE(by.thresholds_differ);
  CHECK(report_of(by)["fits"].size() > 1);
}

TEST_CASE("a procedure with a criterion is reported with it, beside the analysis of yes and no", "[report]") {
  const auto data = data_of(shipped("friction-yes-no"), "sim:threshold=0.1,criterion=1,lapse=0");
  CHECK(data.design == report::Design::yes_no);
  CHECK(data.function == core::Function::weibull);
  const auto json = report_of(data);
  REQUIRE(json["fits"].size() == 1);
  double criterion = -10;
  for (const auto& estimate : json["estimates"])
    if (estimate["parameter"] == "criterion") criterion = estimate["mean"];
  CHECK(criterion == Approx(1).margin(0.6));
  CHECK_FALSE(json["detection"].empty());
}
