#include "station/report/study.hpp"

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
