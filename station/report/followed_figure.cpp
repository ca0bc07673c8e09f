#include <algorithm>
#include <limits>
#include <string>

#include "station/report/figures.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

using analysis::FollowedPlaces, analysis::Spread;

// Felt friction is solid, what was asked for is dashed upon it.
constexpr int kFelt = 0, kAsked = 1, kCommanded = 2;
constexpr int kNarrow = 0, kWide = 1;
/// Quartiles of what was asked that differ by more than this share of the median are those of different
/// scenes, not of places within a bin.
constexpr double kAskedDiffers = 0.1;

enum class Quartiles { drawn, left_out };

/// Adds one curve, with gaps where nothing was measured.
void add(Chart& chart, const std::vector<double>& place_mm, const std::vector<Spread>& spreads, double factor,
         int series, const std::string& name, Quartiles quartiles, std::vector<double>& extent) {
  Line line;
  line.series = series, line.name = name;
  Band band;
  band.series = series;
  const auto end_band = [&] {
    if (band.x.size() > 1) chart.layers.insert(chart.layers.begin(), band);
    band.x.clear(), band.low.clear(), band.high.clear();
  };
  for (std::size_t i = 0; i < place_mm.size(); ++i) {
    if (i > 0 && place_mm[i] - place_mm[i - 1] > 1.5 * analysis::kFollowedBin_mm) {
      end_band();
      line.x.push_back(0.5 * (place_mm[i] + place_mm[i - 1]));
      line.y.push_back(std::numeric_limits<double>::quiet_NaN());
    }
    const auto& [median, low, high] = spreads[i];
    line.x.push_back(place_mm[i]), line.y.push_back(factor * median);
    extent.push_back(factor * median);
    if (quartiles == Quartiles::left_out) continue;
    band.x.push_back(place_mm[i]);
    band.low.push_back(factor * low), band.high.push_back(factor * high);
    extent.insert(extent.end(), {factor * low, factor * high});
  }
  end_band();
  chart.layers.push_back(std::move(line));
}

std::string title_of(const FollowedPlaces& places) {
  return places.condition.empty() ? places.scene : places.scene + ", " + places.condition;
}

}  // namespace

bool asked_differs(const Summary& summary) {
  return std::ranges::any_of(summary.data.followed_places, [](const auto& places) {
    return std::ranges::any_of(places.asked, [](const auto& asked) {
      return asked.high - asked.low > kAskedDiffers * asked.median;
    });
  });
}

std::optional<Figure> followed_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Figure figure;
  figure.title = "Friction over place";
  std::vector<double> along, friction{0};
  for (const auto& places : summary.data.followed_places) {
    Chart chart;
    chart.title =
        title_of(places) + ", " + words(places.narrow ? "figure.towards_narrow" : "figure.towards_wide");
    add(chart, places.place_mm, places.felt, 1, kFelt, words("figure.felt_friction"), Quartiles::drawn,
        friction);
    add(chart, places.place_mm, places.commanded, 1, kCommanded, words("figure.commanded"),
        Quartiles::left_out, friction);
    add(chart, places.place_mm, places.asked, 1, kAsked, words("figure.asked"), Quartiles::drawn, friction);
    figure.charts.push_back(std::move(chart));
    along.insert(along.end(), places.place_mm.begin(), places.place_mm.end());
  }
  if (figure.charts.empty()) return std::nullopt;
  const auto x = report::fitted(words("figure.place"), along, 0.02);
  auto y = report::fitted(words("figure.coefficient"), friction, 0.06);
  y.low = 0;
  for (auto& chart : figure.charts) chart.x = x, chart.y = y;
  figure.caption =
      of_trials(summary.data, summary.data.followed.size()) + " " + words("figure.caption_followed");
  return on_page(std::move(figure), 260);
}

std::optional<Figure> deviation_figure(const Summary& summary) {
  const Words words(summary.data.language);
  Figure figure;
  figure.title = "Felt minus asked friction";
  std::vector<double> along, deviations{0};
  for (const auto& places : summary.data.followed_places) {
    const auto title = title_of(places);
    if (figure.charts.empty() || figure.charts.back().title != title) {
      figure.charts.emplace_back().title = title;
      figure.charts.back().layers.push_back(Rule{Rule::Direction::horizontal, 0, ""});
    }
    add(figure.charts.back(), places.place_mm, places.deviation, 100, places.narrow ? kNarrow : kWide,
        words(places.narrow ? "figure.towards_narrow" : "figure.towards_wide"), Quartiles::drawn, deviations);
    along.insert(along.end(), places.place_mm.begin(), places.place_mm.end());
  }
  if (figure.charts.empty()) return std::nullopt;
  const auto x = report::fitted(words("figure.place"), along, 0.02);
  const auto y = report::fitted(words("figure.felt_minus_asked"), deviations, 0.06);
  for (auto& chart : figure.charts) chart.x = x, chart.y = y;
  figure.caption =
      of_trials(summary.data, summary.data.followed.size()) + " " + words("figure.caption_deviation");
  return on_page(std::move(figure), 260);
}

}  // namespace turnpoint::report
