#include "station/report/study.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "station/report/words.hpp"

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

namespace {

report::Study study_of(const std::string& protocol, int people) {
  report::Study study;
  for (int i = 0; i < people; ++i) {
    auto data = data_of(shipped(protocol), "sim", i);
    data.participant = "P0" + std::to_string(i + 1), data.title = "Study of friction";
    study.persons.push_back(report::study_person(data, {}, false));
    data.trials.clear();
    study.settings = data;
  }
  report::finish_study(study);
  return study;
}

bool shows(const report::Axis& axis, double value) { return value >= axis.low && value <= axis.high; }

}  // namespace

TEST_CASE("No figure of a study leaves a marker, an estimate or a proportion's interval outside its axes",
          "[report]") {
  for (const char* protocol : {"friction-weber", "speed-accuracy"}) {
    const auto study = study_of(protocol, 3);
    const auto figures = figures_of(document(study));
    CHECK(figures.size() >= 4);
    for (const auto& [name, figure] : figures) {
      INFO(protocol << ", " << name << ": " << figure.caption);
      CHECK(figure.caption.starts_with("Study of friction. Participants: 3. Trials: "));
      CHECK(figure.caption.find("Student") != std::string::npos);
      for (const auto& chart : figure.charts) {
        const bool proportion = chart.y.label.starts_with("Proportion");
        for (const auto& layer : chart.layers)
          if (const auto* dots = std::get_if<report::Points>(&layer)) {
            for (const double y : dots->y) CHECK(shows(chart.y, y));
            for (const auto* ends : {&dots->low, &dots->high})
              for (const double end : *ends)
                if (proportion) {
                  CHECK(shows(chart.y, end));
                  CHECK((end >= 0 && end <= 1));
                }
          } else if (const auto* line = std::get_if<report::Line>(&layer)) {
            for (const double y : line->y) CHECK(shows(chart.y, y));
          }
      }
    }
  }
}

TEST_CASE("The figures of a group name the criterion of the threshold and the chance level", "[report]") {
  const auto study = study_of("friction-weber", 3);
  const auto group = *report::group_curve_figure(study);
  REQUIRE(group.charts.size() == 3);
  const auto svg = render(group);
  CHECK(group.caption.find("Horizontal, dashed: chance.") != std::string::npos);
  for (std::size_t i = 0; i < group.charts.size(); ++i) {
    const auto& fit = *study.groups[i].result.fit;
    const auto label =
        "threshold " + report::in_digits(fit.threshold->value, &fit.threshold->interval) + " (81.6 %)";
    CHECK(svg.find(label) != std::string::npos);
    const auto& layers = group.charts[i].layers;
    CHECK(std::any_of(layers.begin(), layers.end(), [](const report::Layer& layer) {
      const auto* rule = std::get_if<report::Rule>(&layer);
      return rule != nullptr && rule->direction == report::Rule::Direction::horizontal && rule->at == 0.5;
    }));
    CHECK(group.charts[i].x == group.charts[0].x);
    CHECK(group.charts[i].y == group.charts[0].y);
  }
  const auto people = *report::shrinkage_figure(study);
  for (const auto& chart : people.charts) {
    CHECK(chart.y.label == "Threshold at 81.6 % correct");
    CHECK(chart.y == people.charts[0].y);
    CHECK(chart.y.scale == report::AxisScale::log10);  // as the fit
    bool band = false;
    for (const auto& layer : chart.layers) {
      if (const auto* dots = std::get_if<report::Points>(&layer))
        for (std::size_t i = 0; i < dots->low.size(); ++i) CHECK(dots->low[i] < dots->high[i]);
      band = band || std::holds_alternative<report::Band>(layer);
    }
    CHECK(band);  // the interval of the group
  }
  auto fewer = study;
  const auto missing = fewer.persons[2].person;
  for (auto& one : fewer.groups)
    std::erase_if(one.result.fit->persons, [&](const auto& person) { return person.person == missing; });
  CHECK(report::group_curve_figure(fewer)->caption.find("Participants: 2. ") != std::string::npos);
  for (auto& named : fewer.persons[0].fits) named.intervals.threshold.reset();
  const auto open_ended = *report::shrinkage_figure(fewer);
  for (const auto& chart : open_ended.charts)
    CHECK(std::any_of(chart.layers.begin(), chart.layers.end(), [](const report::Layer& layer) {
      const auto* dots = std::get_if<report::Points>(&layer);
      return dots != nullptr && dots->low.empty() && dots->x.size() == 1;
    }));
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
