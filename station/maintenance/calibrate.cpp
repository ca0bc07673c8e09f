#include "station/maintenance/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "station/audio/engine.hpp"
#include "station/core/problem.hpp"
#include "station/core/texts.hpp"
#include "station/core/usage_error.hpp"
#include "station/maintenance/play_armed.hpp"
#include "station/rig/apply.hpp"
#include "station/rig/csv.hpp"
#include "station/scene/planner.hpp"
#include "station/session/self_test.hpp"
#include "station/session/stage.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::maintenance {
namespace {

using report::fitted;
using report::Line;
using report::Points;
using rig::BoundaryFit;
using rig::Calibration;
using rig::Measurements;

std::vector<std::vector<double>> rows_of(const std::string& path, const std::vector<std::string>& columns) {
  core::Findings findings;
  auto rows = rig::read_table(path, columns, {path, 0, 0}, findings);
  findings.throw_if_any();
  return rows;
}

/// The data of a figure: measured values, fitted values, and their difference.
struct Comparison {
  std::string title, x_label, y_label, residual_label;
  std::vector<double> x, measured, fit_x, fit_y, residuals;
};

void add(report::Figure& figure, const Comparison& c) {
  auto range = c.measured;
  range.insert(range.end(), c.fit_y.begin(), c.fit_y.end());
  report::Chart fit{c.title, fitted(c.x_label, c.x), fitted(c.y_label, range), {}};
  Line line;
  line.x = c.fit_x, line.y = c.fit_y, line.series = 0, line.name = "fit";
  Points points;
  points.x = c.x, points.y = c.measured, points.series = 1, points.name = "measured";
  fit.layers = {line, points};
  report::Chart rest{"Residuals", fitted(c.x_label, c.x), fitted(c.residual_label, c.residuals), {}};
  Points residuals;
  residuals.x = c.x, residuals.y = c.residuals, residuals.series = 1;
  rest.layers = {report::Rule{report::Rule::Direction::horizontal, 0, ""}, residuals};
  figure.charts.push_back(std::move(fit));
  figure.charts.push_back(std::move(rest));
}

void add_response(report::Figure& figure, const Calibration::Transducer& transducer,
                  const Measurements::Sweep& sweep) {
  Comparison level, phase;
  level.title = transducer.name + ": response";
  phase.title = transducer.name + ": phase";
  level.x_label = phase.x_label = "Frequency (kHz)";
  level.y_label = "Displacement at full scale (dB re 1 um)", level.residual_label = "Residual (dB)";
  phase.y_label = "Phase (degrees)", phase.residual_label = "Residual (degrees)";
  const auto rows = rows_of(sweep.csv, {"frequency_Hz", "displacement_um", "phase_deg"});
  const auto& points = transducer.response.points;
  const auto degrees = [](double rad) { return rad * 180 / std::numbers::pi; };
  for (std::size_t k = 0; k < rows.size() && k < points.size(); ++k) {
    const double fit_dB = 20 * std::log10(points[k].m_per_full_scale * 1e6);
    const double measured_dB = 20 * std::log10(rows[k][1] / sweep.full_scale);
    const double fit_deg = degrees(points[k].phase_rad);
    // The phase of the fit is continuous. Shift the measured phase by whole turns to the value nearest to the
    // fit.
    const double measured_deg = rows[k][2] + 360 * std::round((fit_deg - rows[k][2]) / 360);
    for (auto* c : {&level, &phase}) c->x.push_back(rows[k][0] * 1e-3), c->fit_x.push_back(rows[k][0] * 1e-3);
    level.measured.push_back(measured_dB), level.fit_y.push_back(fit_dB);
    level.residuals.push_back(measured_dB - fit_dB);
    phase.measured.push_back(measured_deg), phase.fit_y.push_back(fit_deg);
    phase.residuals.push_back(measured_deg - fit_deg);
  }
  add(figure, level);
  add(figure, phase);
}

void add_boundary(report::Figure& figure, const BoundaryFit& fit) {
  Comparison c;
  c.title = "Boundary: " + fit.edge;
  c.x_label = "Frequency (kHz)", c.y_label = "Boundary (mm)", c.residual_label = "Residual (mm)";
  for (const auto& point : fit.points) {
    c.x.push_back(point.frequency_Hz * 1e-3);
    c.measured.push_back(point.boundary_m * 1e3);
    c.residuals.push_back(point.residual_m * 1e3);
    c.fit_x.push_back(c.x.back());
  }
  std::sort(c.fit_x.begin(), c.fit_x.end());
  for (const double f_kHz : c.fit_x) {
    const auto same = [&](const auto& point) { return point.frequency_Hz * 1e-3 == f_kHz; };
    const auto point = *std::find_if(fit.points.begin(), fit.points.end(), same);
    c.fit_y.push_back((point.boundary_m - point.residual_m) * 1e3);
  }
  add(figure, c);
}

double friction_at(const rig::FrictionFit& fit, double displacement_m) {
  const auto& points = fit.points;
  const auto above = std::find_if(points.begin(), points.end(),
                                  [=](const auto& p) { return p.displacement_m >= displacement_m; });
  if (above == points.end()) return points.back().relative_friction;
  if (above == points.begin()) return above->relative_friction;
  const auto below = above - 1;
  const double u = (displacement_m - below->displacement_m) / (above->displacement_m - below->displacement_m);
  return below->relative_friction + u * (above->relative_friction - below->relative_friction);
}

void add_friction(report::Figure& figure, const rig::FrictionFit& fit, const std::string& csv) {
  Comparison c;
  c.title = "Friction";
  c.x_label = "Displacement (um)", c.y_label = "Relative friction", c.residual_label = "Residual";
  for (const auto& row : rows_of(csv, {"displacement_um", "relative_friction"})) {
    c.x.push_back(row[0]);
    c.measured.push_back(row[1]);
    c.residuals.push_back(row[1] - friction_at(fit, row[0] * 1e-6));
  }
  for (const auto& point : fit.points) {
    c.fit_x.push_back(point.displacement_m * 1e6);
    c.fit_y.push_back(point.relative_friction);
  }
  add(figure, c);
}

void add_sound(report::Figure& figure, const std::vector<rig::SoundPoint>& sound) {
  Line line;
  for (const auto& point : sound) {
    line.x.push_back(point.frequency_Hz * 1e-3);
    line.y.push_back(point.level_dB);
  }
  report::Chart panel{
      "Sound level at full scale", fitted("Frequency (kHz)", line.x), fitted("Level (dB SPL)", line.y), {}};
  panel.layers = {line};
  figure.charts.push_back(std::move(panel));
}

/// Calls `work`. If something in it says that numbers cannot be used, throws a UsageError that says so.
template <class Work>
auto as_unusable(Work work) {
  const auto refuse = [](const std::string& why) -> core::Refusal {
    return core::Refusal(core::phrase("series.unusable", {core::plain(why)}));
  };
  try {
    return work();
  } catch (const core::BadInput& error) {
    if (error.problems().front().place.file != "calibration") throw;
    throw refuse(error.what());
  } catch (const std::invalid_argument& error) {
    throw refuse(error.what());
  } catch (const std::domain_error& error) {
    throw refuse(error.what());
  } catch (const std::out_of_range& error) {
    throw refuse(error.what());
  }
}

bool can_plan(const rig::Rig& rig) try {
  scene::Planner planner(rig);
  return true;
} catch (const std::exception&) {
  return false;
}

}  // namespace

Calibration calibrate(const rig::Rig& rig, const Measurements& measurements, int valid_days,
                      const std::string& note) {
  auto calibration = as_unusable([&] { return rig::fit_measurements(measurements, rig); });
  calibration.rig_name = rig.name;
  calibration.rig_sha256 = rig.sha256;
  calibration.made_on = rig::today();
  calibration.valid_days = valid_days;
  calibration.note = note;
  static_cast<void>(usable_toml(calibration, rig));
  return calibration;
}

std::string usable_toml(const Calibration& calibration, const rig::Rig& rig) {
  return as_unusable([&] {
    auto toml = rig::to_toml(calibration);
    const auto used = rig::applied(rig::parse_calibration(toml, "calibration"), rig);
    // A rig with which nothing can be planned is not the calibration's fault.
    if (can_plan(rig)) scene::Planner planner(used);
    return toml;
  });
}

void write_calibration(Calibration calibration, const rig::Rig& rig, const std::string& path) {
  if (auto now = session::mixer_levels(rig); !now.empty()) {
    auto earlier = rig;
    earlier.mixer = calibration.mixer;
    if (const auto reading = session::read_mixer(earlier); !reading.changes.empty())
      throw core::Refusal(core::phrase("series.other_mixer", {reading.changes.front()}));
    calibration.mixer = std::move(now);
  }
  system::write_file(path, usable_toml(calibration, rig), 0666, system::Replaces::input);
}

report::Figure calibration_figure(const Calibration& calibration, const Measurements& measurements) {
  report::Figure figure;
  figure.title = "Calibration of " + calibration.rig_name + ", " + calibration.made_on;
  figure.columns = 2;
  for (std::size_t k = 0; k < calibration.transducers.size(); ++k)
    add_response(figure, calibration.transducers[k], measurements.sweeps[k]);
  if (calibration.boundary) add_boundary(figure, *calibration.boundary);
  if (calibration.friction) add_friction(figure, *calibration.friction, measurements.friction_csv);
  if (!calibration.sound.empty()) add_sound(figure, calibration.sound);
  return figure;
}

namespace {

audio::Burst burst_of(const SweepStep& step, int rate_Hz) {
  audio::Burst burst;
  burst.start_frame = std::llround(step.start_s * rate_Hz);
  burst.length_frames = std::llround(step.length_s * rate_Hz);
  burst.ramp.frames = std::min(std::llround(0.05 * rate_Hz), static_cast<long long>(burst.length_frames / 2));
  burst.tones.count = 1;
  burst.tones.tones[0] = {step.frequency_Hz, step.full_scale, 0, step.channel};
  return burst;
}

/// Renders each tone exactly at its planned frame, so that a vibrometer can find the tones by their times.
void render(audio::SynchronousStream& stream, const std::vector<audio::Burst>& bursts) {
  for (const auto& burst : bursts) {
    stream.schedule(burst);
    stream.advance(burst.start_frame + burst.length_frames - stream.frame());
    while (stream.poll()) {
    }
  }
  stream.advance(stream.config().output.rate_Hz / 2);
  stream.finish();
}

}  // namespace

std::vector<SweepStep> sweep_plan(const rig::Rig& rig, const SweepOptions& options) {
  if (options.points < 5) throw core::UsageError("sweep: there must be at least 5 points");
  if (!(options.full_scale > 0 && options.full_scale <= 1))
    throw core::UsageError(fmt::format(
        "sweep: the amplitude must be above 0 and at most 1 (full scale), not {}", options.full_scale));
  if (!(options.length_s >= 0.2 && options.pause_s >= 0.2))
    throw core::UsageError("sweep: tones and pauses must last 0.2 s or more");
  if (options.length_s > rig.limits.duty * (options.length_s + options.pause_s))
    throw core::UsageError(
        fmt::format("sweep: the pauses must be longer, because the rig's limit on the duty cycle is {}",
                    rig.limits.duty));
  std::vector<SweepStep> steps;
  for (const auto& transducer : rig.transducers)
    for (int k = 0; k < options.points; ++k) {
      const double f_Hz =
          transducer.low_Hz + (transducer.high_Hz - transducer.low_Hz) * k / (options.points - 1);
      steps.push_back({transducer.name, transducer.channel, f_Hz, options.full_scale,
                       static_cast<double>(steps.size()) * (options.length_s + options.pause_s),
                       options.length_s});
    }
  return steps;
}

std::string to_csv(const std::vector<SweepStep>& steps) {
  std::string csv = "transducer,frequency_Hz,full_scale,start_s,length_s\n";
  for (const auto& step : steps)
    csv += fmt::format("{},{:.3f},{},{:.3f},{:.3f}\n", step.transducer, step.frequency_Hz, step.full_scale,
                       step.start_s, step.length_s);
  return csv;
}

void play_sweep(const rig::Rig& rig, const std::vector<SweepStep>& steps, const std::string& uri) {
  auto config = session::stream_of(rig);
  config.output.uri = uri;
  std::vector<audio::Burst> bursts;
  for (const auto& step : steps) bursts.push_back(burst_of(step, config.output.rate_Hz));
  if (uri.starts_with("alsa:")) {
    play_armed(rig, uri, bursts);
  } else {
    render(*audio::open_synchronous(config), bursts);
  }
}

}  // namespace turnpoint::maintenance
