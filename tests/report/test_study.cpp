#include "station/report/study.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "tests/report/simulated_report.hpp"
#include "tests/support/catch.hpp"

// Tests how the participants of a study become one report.

using namespace turnpoint;

TEST_CASE("in the figure of a study, an answer \"unsure\" counts as the guess that it stands for",
          "[report]") {
  report::Study study;
  for (const int threshold : {-20, -18, -16, -14}) {
    const auto observer = "sim:lapse=0,unsure=1,threshold=" + std::to_string(threshold);
    auto data = data_of(shipped("friction-unforced"), observer);
    data.participant = "P" + std::to_string(-threshold);
    study.persons.push_back(report::study_person(data, {}, false));
    data.trials.clear();
    study.settings = data;
  }
  report::finish_study(study);
  const auto figure = report::group_curve_figure(study);
  REQUIRE(figure);
  int markers = 0;
  for (const auto& layer : figure->charts.front().layers)
    if (const auto* points = std::get_if<report::Points>(&layer))
      for (const double share : points->y) {
        // these people are unsure exactly when they would guess, so no answer of theirs is wrong
        CHECK(share >= 0.5);
        ++markers;
      }
  CHECK(markers > 3);
}

TEST_CASE("a study says of how many participants the answers give no scale, and why", "[report]") {
  report::Study study;
  const auto add = [&study](const std::string& participant, const std::string& observer) {
    auto data = data_of(shipped("friction-triads"), observer);
    data.participant = participant;
    study.persons.push_back(report::study_person(data, {}, false));
    data.trials.clear();
    study.settings = data;
  };
  add("P1", "sim:threshold=3,lapse=0");
  add("P2", "sim:lapse=1");
  add("P3", "sim:lapse=1");
  add("P4", "sim:lapse=1");
  study.persons.back().excluded.emplace_back("fewer than 200 answered trials");
  report::finish_study(study);
  std::map<std::string, std::string> said;
  for (const auto& one : study.statements) said[one.code] = core::say(one.text, "en");
  REQUIRE(said.contains("no-range"));
  CHECK(said["no-range"].starts_with("2 of 3 participants: The answers do not determine a scale"));
  const auto json = nlohmann::json::parse(report::to_json(study));
  CHECK(json["participants"][0]["scale_remarks"].empty());
  CHECK(json["participants"][1]["scale_remarks"][0]["code"] == "no-range");
}
