#include "station/view/scene_figures.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "physics/surface.hpp"
#include "station/core/number.hpp"
#include "station/report/palette.hpp"
#include "station/report/svg.hpp"
#include "station/report/words.hpp"

namespace turnpoint::view {

namespace {

using report::Words;

const std::string kInk = "#16202a", kQuiet = "#3f4a54", kAccent = "#b3400a", kPaper = "#ffffff";

report::Paint stroke(const std::string& colour, double width, const std::string& dash = "") {
  return {colour, "", width, dash, 1};
}
report::Paint fill(const std::string& colour, double opacity = 1) { return {"", colour, 1, "", opacity}; }

// text size of the label with the boundary's position, and the label's distance from the strip
constexpr double kName_px = 14, kNameAbove_px = 20;

/// The drawing of a surface has a caption only if it is at least this high.
constexpr double kCaptionFrom_px = 165;

void require_plan(const SceneLook& look) {
  if (!look.problem.empty() || look.profile.x_m.size() < 2)
    throw std::invalid_argument("scene " + look.scene +
                                " cannot be drawn, because it has no plan: " + look.problem);
}

std::optional<double> mark_of(const SceneLook& look) {
  const auto found = look.factors.find("mark_mm");
  if (found == look.factors.end()) return std::nullopt;
  const auto* value = std::get_if<double>(&found->second);
  return value ? std::optional(1e-3 * *value) : std::nullopt;
}

/// Where the strip is drawn on the page. x is the distance from the wide end, whether that end is drawn on
/// the left or on the right. A slim strip is drawn wider than to scale, so that it can be seen.
struct Place {
  double left, right, middle_y, across, length_m;
  bool wide_left;
  physics::Surface surface;

  double x(double m) const {
    const double share = m / length_m;
    return wide_left ? left + share * (right - left) : right - share * (right - left);
  }
  double half(double m) const { return across * physics::half_width_m(surface, m); }
  std::pair<double, double> above(double m, double beyond = 0) const {
    return {x(m), middle_y - half(m) - beyond};
  }
  std::pair<double, double> below(double m, double beyond = 0) const {
    return {x(m), middle_y + half(m) + beyond};
  }
};

Place place_on(const rig::Rig& rig, double width_px, double height_px) {
  const bool low = height_px < kCaptionFrom_px;
  Place at{30,
           width_px - 30,
           low ? 0.5 * height_px : 0.46 * height_px,
           1,
           rig.surface.length_m,
           rig.surface.wide_end == rig::WideEnd::left,
           rig::surface_of(rig)};
  double widest = 0;
  for (int i = 0; i <= 20; ++i)
    widest = std::max(widest, physics::half_width_m(at.surface, at.length_m * i / 20));
  const double to_scale = (at.right - at.left) / at.length_m;
  // Leave room for labels above and below the strip, even if the strip becomes thin.
  const double most_px = std::min(0.24 * height_px, 0.5 * height_px - (low ? 33 : 46));
  at.across = std::clamp(to_scale, 0.75 * most_px / widest, most_px / widest);
  return at;
}

void draw_heat(report::Canvas& canvas, const SceneLook& look, const Place& at) {
  const auto& profile = look.profile;
  const double top = *std::max_element(profile.displacement_m.begin(), profile.displacement_m.end());
  for (std::size_t i = 0; i + 1 < profile.x_m.size(); ++i) {
    const double a = profile.x_m[i], b = profile.x_m[i + 1];
    const double value = 0.5 * (profile.displacement_m[i] + profile.displacement_m[i + 1]);
    const auto colour = report::shade(top > 0 ? value / top : 0);
    // Let each slice extend a little under the next one, so that no gap is visible between them.
    const double under = std::min(at.length_m, b + (b - a));
    canvas.polygon({at.above(a), at.above(under), at.below(under), at.below(a)}, fill(colour));
  }
  const double l = at.length_m;
  canvas.polygon({at.above(0), at.above(l), at.below(l), at.below(0)}, stroke(kInk, 1.2));
}

void draw_scale(report::Canvas& canvas, const Place& at) {
  const double y = at.middle_y + at.half(0) + 10;
  for (int mm = 0; 1e-3 * mm <= at.length_m + 1e-9; mm += 10) {
    const bool labelled = mm % 50 == 0;
    const double x = at.x(1e-3 * mm);
    canvas.line({x, y}, {x, y + (labelled ? 7 : 4)}, stroke(kQuiet, 1));
    if (labelled) canvas.text({x, y + 20}, std::to_string(mm), 12, report::Anchor::middle, kQuiet);
  }
}

void draw_transducer(report::Canvas& canvas, const Place& at) {
  const double width = 14, half = at.half(0) + 4;
  canvas.rectangle({at.wide_left ? at.left - width : at.right, at.middle_y - half}, width, 2 * half,
                   fill("#4d565e"));
}

/// Draws the mark beside the strip, to which a question can refer, where the participant sees it. Its name is
/// on the side away from the boundary.
void draw_mark(report::Canvas& canvas, const SceneLook& look, const Place& at, const std::string& name) {
  const auto mark = mark_of(look);
  if (!mark || *mark <= 0 || *mark >= at.length_m) return;
  const auto [x, y] = at.above(*mark, 3);
  canvas.polygon({{x, y}, {x - 6, y - 9}, {x + 6, y - 9}}, fill(kInk));
  const bool to_left = look.plan.boundary_m && at.x(*look.plan.boundary_m) >= x;
  canvas.text({to_left ? x - 10 : x + 10, y - 3}, name, 12,
              to_left ? report::Anchor::end : report::Anchor::start, kInk);
}

/// Returns the y coordinate of the boundary's name. If the name would overlap the mark (the place that a
/// question refers to) or the mark's name, it moves up above both.
double boundary_name_y(const SceneLook& look, const Place& at, const std::string& name,
                       const std::string& mark_name) {
  const double boundary = *look.plan.boundary_m, own = at.above(boundary).second;
  const auto mark = mark_of(look);
  if (!mark) return own - kNameAbove_px;
  const double reach = 0.5 * report::text_width(name, kName_px) + 10 + report::text_width(mark_name, 12);
  const bool near = std::abs(at.x(*mark) - at.x(boundary)) < reach;
  return (near ? std::min(own, at.above(*mark).second) : own) - kNameAbove_px;
}

void draw_boundary(report::Canvas& canvas, const SceneLook& look, const Place& at,
                   const std::string& mark_name) {
  for (const auto& tone : look.plan.tones)
    if (tone.turning_point_m)
      canvas.line(at.below(*tone.turning_point_m, -0.4 * at.half(*tone.turning_point_m)),
                  at.below(*tone.turning_point_m, 6), stroke(kQuiet, 1.2, "2 2"));
  if (!look.plan.boundary_m) return;
  const double b = *look.plan.boundary_m, e = look.plan.error_bound_m;
  if (2 * e * (at.right - at.left) / at.length_m > 2) {
    const double low = std::max(0.0, b - e), high = std::min(at.length_m, b + e);
    canvas.polygon({at.above(low, 6), at.above(high, 6), at.below(high, 6), at.below(low, 6)},
                   fill(kAccent, 0.25));
  }
  const auto name = core::number(1e3 * b, 5) + " mm";
  const double name_y = boundary_name_y(look, at, name, mark_name);
  canvas.line({at.x(b), name_y + 5}, at.below(b, 6), stroke(kAccent, 2.4));
  canvas.text({at.x(b), name_y}, name, kName_px, report::Anchor::middle, kAccent, 600);
}

void draw_surface(report::Canvas& canvas, const SceneLook& look, const rig::Rig& rig, double width_px,
                  double height_px, const Words& words) {
  canvas.begin(width_px, height_px, "Surface from above, scene " + look.scene);
  canvas.rectangle({0, 0}, width_px, height_px, fill(kPaper));
  const auto at = place_on(rig, width_px, height_px);
  draw_transducer(canvas, at);
  draw_heat(canvas, look, at);
  draw_scale(canvas, at);
  draw_mark(canvas, look, at, words("figure.mark"));
  draw_boundary(canvas, look, at, words("figure.mark"));
  if (height_px < kCaptionFrom_px) return;
  canvas.text({width_px / 2, height_px - 10}, words("figure.surface"), 12, report::Anchor::middle, kQuiet);
}

}  // namespace

Drawing drawing_of(report::Figure figure) {
  return [figure = std::move(figure)](report::Canvas& canvas, double width_px, double height_px) {
    try {
      report::draw(canvas, report::laid_out(figure, width_px, height_px));
    } catch (const std::invalid_argument&) {
      // If the legend does not fit into this width and height, use the original layout and scale it down.
      report::draw(canvas, figure);
    }
  };
}

Drawing drawing_of_surface(const SceneLook& look, const rig::Rig& rig, const std::string& language) {
  require_plan(look);
  return [look, rig, words = Words(language)](report::Canvas& canvas, double width_px, double height_px) {
    // Scale and labels need at least 240 x 84 px. For a smaller size, draw larger and scale down.
    const double larger = std::max({1.0, 240 / width_px, 84 / height_px});
    draw_surface(canvas, look, rig, larger * width_px, larger * height_px, words);
  };
}

std::string surface_svg(const SceneLook& look, const rig::Rig& rig, double width_px, double height_px) {
  require_plan(look);
  report::Svg svg;
  draw_surface(svg, look, rig, width_px, height_px, Words("en"));
  return svg.finish();
}

namespace {

bool is_displacement(const SceneLook& look) {
  return look.plan.scene.follow->unit == scene::FollowUnit::displacement;
}

/// Plots what a scene that follows the finger asks for (dashed) and what is reached, before and after its
/// events, in the chart of friction or of displacement. Friction is drawn relative to the surface at rest.
void add_followed(const SceneLook& look, report::Line line, const Words& words, report::Chart& chart) {
  if (!look.plan.follow) return;
  const auto unit = look.plan.scene.follow->unit;
  const double scale = unit == scene::FollowUnit::displacement  ? 1e6
                       : unit == scene::FollowUnit::coefficient ? 1 / look.plan.follow->resting_friction
                                                                : 1;
  for (const auto& curve : look.followed) {
    line.x.clear();
    for (const double x : curve.x_m) line.x.push_back(1e3 * x);
    for (const bool asked : {true, false}) {
      line.y.clear();
      for (const double value : asked ? curve.asked : curve.reached) line.y.push_back(scale * value);
      line.beyond = asked;
      line.name = words(asked ? "figure.asked" : "figure.reached");
      chart.y.high = std::max(chart.y.high, 1.1 * *std::max_element(line.y.begin(), line.y.end()));
      chart.layers.push_back(line);
    }
    line.series += 2;
  }
}

}  // namespace

report::Figure profile_figure(const std::vector<SceneLook>& looks, const std::string& language) {
  const Words words(language);
  if (looks.empty()) throw std::invalid_argument("there is no scene to draw");
  report::Figure figure;
  figure.title = "Displacement and friction";
  report::Chart displacement{words("figure.displacement_free"), {}, {words("figure.displacement"), 0, 1}, {}};
  report::Chart friction{words("figure.friction_under"), {}, {words("figure.friction"), 0, 1.2}, {}};
  const bool several = looks.size() > 1;
  double most_um = 0;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const auto& look = looks[i];
    require_plan(look);
    figure.title += (i == 0 ? ", scene " : " and ") + look.scene;
    report::Line line;
    line.series = static_cast<int>(i);
    line.name = several ? std::to_string(i + 1) + " " + look.scene : "";
    report::Line felt = line;
    for (const double x : look.under.profile_x_m) felt.x.push_back(1e3 * x);
    felt.y = look.under.profile_friction;
    for (const double x : look.profile.x_m) line.x.push_back(1e3 * x);
    for (const double a : look.profile.displacement_m) line.y.push_back(1e6 * a);
    most_um = std::max(most_um, *std::max_element(line.y.begin(), line.y.end()));
    // With a single scene, displacement and friction would get the same series number and look. Give the
    // friction curve another number.
    if (!several) felt.series = 1;
    add_followed(look, felt, words, look.plan.follow && is_displacement(look) ? displacement : friction);
    if (!look.plan.follow || is_displacement(look)) friction.layers.push_back(felt);
    displacement.layers.push_back(line);
  }
  if (most_um > 0) displacement.y.high = 1.15 * most_um;
  for (auto* panel : {&displacement, &friction}) {
    panel->x = {words("figure.from_wide"), 0, 1e3 * looks.front().profile.x_m.back()};
    for (const auto& look : looks)
      if (look.plan.boundary_m)
        panel->layers.push_back(report::Rule{report::Rule::Direction::vertical, 1e3 * *look.plan.boundary_m,
                                             several ? "" : words("figure.boundary")});
    figure.charts.push_back(std::move(*panel));
  }
  figure.columns = 2;
  figure.chart_width_px = 430, figure.chart_height_px = 260;
  return figure;
}

report::Figure spectrum_figure(const SceneLook& look, const std::string& language) {
  const Words words(language);
  require_plan(look);
  report::Points points;
  double most = 0;
  for (const auto& tone : look.plan.tones) {
    points.x.push_back(1e-3 * tone.frequency_Hz);
    points.y.push_back(1e6 * tone.amplitude_m);
    points.low.push_back(0);
    points.high.push_back(1e6 * tone.amplitude_m);
    most = std::max(most, 1e6 * tone.amplitude_m);
  }
  report::Chart panel;
  panel.title = words("figure.drive");
  panel.x = report::fitted(words("figure.frequency"), points.x, 0.3);
  panel.y = {words("figure.drive_edge"), 0, most > 0 ? 1.2 * most : 1};
  if (const double at = 1e-3 * look.nearest_resonance_Hz.value_or(0); at > panel.x.low && at < panel.x.high)
    panel.layers.push_back(report::Rule{report::Rule::Direction::vertical, at, words("figure.resonance")});
  panel.layers.push_back(points);
  report::Figure figure;
  figure.title = "Tones, scene " + look.scene;
  figure.charts.push_back(panel);
  figure.chart_width_px = 430, figure.chart_height_px = 260;
  return figure;
}

}  // namespace turnpoint::view
