// Calls every public function with every unusual value. Each call must end with an error within 0.1 s, or
// with a finite answer within 1 s and 200 MB, in processor time.
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "physics/airborne.hpp"
#include "physics/boundary_budget.hpp"
#include "physics/boundary_fit.hpp"
#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "physics/crest.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/finger.hpp"
#include "physics/friction.hpp"
#include "physics/planner.hpp"
#include "physics/plate_theory.hpp"
#include "physics/taper.hpp"
#include "physics/warning.hpp"
#include "physics/zone.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

using Numbers = std::vector<double>;

constexpr double inf = std::numeric_limits<double>::infinity();
const Numbers unusual{
    0,     std::numeric_limits<double>::denorm_min(), 1e-300, -1,
    1e300, std::numeric_limits<double>::max(),        inf,    std::numeric_limits<double>::quiet_NaN()};

// A sanitizer makes a program several times slower, and a busy machine halves the speed of its processors.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double patience = 40;
#else
constexpr double patience = 3;
#endif

double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double most_memory_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// Makes one call. Returns what is wrong with it, or nothing.
std::optional<std::string> fault(const std::function<Numbers()>& call) {
  const double start = processor_s(), before_MB = most_memory_MB();
  std::string error;
  bool finite = true;
  try {
    for (const double one : call()) finite = finite && std::isfinite(one);
  } catch (const std::exception& caught) {
    error = caught.what();
  }
  const double took = processor_s() - start;
  const double memory_MB = most_memory_MB() - before_MB;
  if (memory_MB > 200) return "takes " + std::to_string(memory_MB) + " MB";
  if (!finite) return "the answer is not finite";
  if (took > (error.empty() ? 1 : 0.1) * patience)
    return (error.empty() ? "an answer after " : "an error after ") + std::to_string(took) + " s";
  return std::nullopt;
}

// A collection of calls; the faults of all are shown together.
struct Calls {
  std::string faults;
  int count = 0;
  void operator()(const std::string& name, const std::function<Numbers()>& call) {
    ++count;
    if (const auto one = fault(call)) faults += name + ": " + *one + "\n";
  }
};

void add(Numbers& all, const std::optional<double>& one) {
  if (one) all.push_back(*one);
}
void add(Numbers& all, const MapAnswer& a) {
  add(all, a.boundary_m), add(all, a.frequency_Hz), add(all, a.shear_shift_m);
  for (const double one : {a.error_bound_m, a.uncertainty_m, a.m_per_Hz}) all.push_back(one);
}
void add(Numbers& all, const RungEstimate& e) {
  for (const double one : {e.boundary_bound_m, e.amplitude_bound, e.level_bound_dB, e.cost_s})
    all.push_back(one);
}
void add(Numbers& all, const Field& field) {
  for (const double one : field.amplitude) all.push_back(one);
  for (const double one : field.ln_amplitude) all.push_back(one);
  for (const ToneField& tone : field.tones) {
    for (const auto& v : tone.v) all.push_back(v.real()), all.push_back(v.imag());
    all.push_back(tone.info.gain), all.push_back(tone.info.conditioning);
    add(all, tone.info.last_peak_m), add(all, tone.info.turning_point_m);
  }
}

// Every public function that takes a surface, at one frequency.
void surface_calls(Calls& calls, const std::string& what, const Surface& s, double f) {
  const Tone tone{f, 1e-6, 0};
  const Numbers x{0, 0.3 * s.length_m, s.length_m};
  const auto on = [&](const char* function, const std::function<Numbers()>& call) {
    calls(std::string(function) + ", " + what, call);
  };
  for (const Model model : all_models) {
    const std::string by = " by " + std::string(name(model));
    for (const auto normalise : {Normalise::drive, Normalise::peak, Normalise::none})
      calls("evaluate" + by + ", " + what, [&] {
        Numbers all;
        const Field field = evaluate(s, {&tone, 1}, x, model, normalise);
        add(all, field);
        if (normalise == Normalise::drive) all.push_back(describe(s, {&tone, 1}, field).error_bound);
        return all;
      });
    calls("estimate" + by + ", " + what, [&] {
      Numbers all;
      add(all, estimate(s, {{tone}, 100, Edge::percent(0.5), Normalise::drive, {}}, model));
      return all;
    });
  }
  for (const Edge edge : {Edge::turning(), Edge::peak(), Edge::percent(0.5), Edge::friction(0.7)})
    calls("map of " + format(edge) + ", " + what, [&] {
      Numbers all;
      MapOptions options;
      options.edge = edge;
      if (edge.kind == Edge::Kind::friction) options.friction = FrictionContext{};
      const double at = std::min(2e4, f > 0 ? f : 2e4);
      options.band = {0.9 * at, 1.1 * at};
      const BoundaryMap map(s, options);
      add(all, map.boundary_m(f)), add(all, map.frequency_Hz(0.5 * s.length_m));
      add(all, map.at_boundary(0.5 * s.length_m)), add(all, map.at_frequency(f));
      return all;
    });
  on("solve_frequency_Hz", [&] {
    Numbers all;
    MapOptions options;
    options.edge = Edge::percent(0.5);
    add(all, solve_frequency_Hz(s, options, 0.5 * s.length_m));
    add(all, solve_frequency_Hz(s, options, 0.5 * s.length_m, f));
    return all;
  });
  on("choose_model", [&] {
    Numbers all;
    PlanRequest request{{tone}, 100, Edge::percent(0.5), Normalise::drive, {}};
    request.tolerance.amplitude = 0.02;
    add(all, choose_model(s, request).bound);
    return all;
  });
  on("tone_info", [&] {
    const ToneInfo info = tone_info(s, f);
    Numbers all{info.gain, info.conditioning};
    add(all, info.nearest_resonance_Hz);
    return all;
  });
  on("drive_amplitude_m", [&] { return Numbers{drive_amplitude_m(s, f, 1e-6)}; });
  on("resonances_Hz", [&] { return resonances_Hz(s, 0.9 * f, f); });
  on("resonances_Hz up to", [&] { return resonances_Hz(s, 2e4, f); });
  on("loudest_sound", [&] { return Numbers{loudest_sound(s, tone, Model::mode, 0.5).level_dB}; });
  on("finger_load", [&] {
    Numbers all;
    for (const FingerLoad& load : finger_load(s, f, x, {}))
      for (const auto& one : {load.unloaded, load.loaded, load.mobility_m_per_Ns})
        all.push_back(one.real()), all.push_back(one.imag());
    return all;
  });
  MapOptions half;
  half.edge = Edge::percent(0.5);
  on("boundary_reach_m", [&] {
    const Reach reach = boundary_reach_m(s, half);
    return Numbers{reach.first_m, reach.last_m};
  });
  on("answer_at_boundary", [&] {
    Numbers all;
    add(all, answer_at_boundary(s, half, 0.5 * s.length_m));
    return all;
  });
  on("finger_edge_shift_m", [&] {
    Numbers all;
    add(all, finger_edge_shift_m(finger_load(s, f, finger_sweep_m(s), {}), half.edge, {}));
    return all;
  });
  on("boundary_budget", [&] { return Numbers{boundary_budget(s, f, 0.5 * s.length_m).total_m}; });
  on("level_budget", [&] {
    const LevelBudget budget = level_budget(s, f, 0.5 * s.length_m);
    return Numbers{budget.total_dB, budget.low_dB, budget.high_dB};
  });
  on("boundary_derivative", [&] {
    Numbers all;
    for (const Parameter p : parameters(s)) all.push_back(boundary_derivative(s, p, f, 0.5 * s.length_m));
    return all;
  });
  on("fit_boundaries", [&] {
    Numbers all;
    const MeasuredBoundary measured{f, 0.5 * s.length_m, 1e-3};
    for (const auto& one : fit_boundaries(s, {Edge::turning(), {}, {}, {}}, {&measured, 1}).parameters)
      all.push_back(one.change);
    return all;
  });
  on("shear_shift_m", [&] {
    Numbers all;
    add(all, shear_shift_m(s, f));
    all.push_back(choose_theory(s, {&f, 1}, 1e-3).shift_m);
    return all;
  });
  on("cut-offs", [&] {
    return Numbers{wavenumber_per_m(s, f), cut_off_half_width_m(s, f), cut_off_frequency_Hz(s, f),
                   frequency_for_wavenumber_Hz(s, f), turning_point_m(s, f).value_or(0)};
  });
  on("tone_warnings", [&] { return Numbers{static_cast<double>(tone_warnings(s, {&tone, 1}).size())}; });
  on("stiffness", [&] {
    return Numbers{bending_stiffness_N_m(s).value_or(0), line_tension_N_per_m(s), wave_speed_m_s(s),
                   half_width_m(s, 0.5 * s.length_m)};
  });
}

Surface thick_plate() {
  Surface s = aluminium_plate();
  s.theory = PlateTheory::mindlin;
  return s;
}

Surface curved_membrane() {
  Surface s = seed_brass();
  s.quality_factor = 60;
  s.taper = ExponentialTaper{0.03, 0.2};
  s.sd.density_kg_m3 = 20;
  s.sd.decay_length_m = 1e-3;
  return s;
}

// A membrane whose table has `points` points; between the two middle ones it falls by a tenth within
// `cliff_m`.
Surface tabulated(std::size_t points, double cliff_m = 0) {
  Surface s = seed_brass();
  s.quality_factor = 60;
  TabulatedTaper table;
  for (std::size_t i = 0; i < points; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(points - 1);
    table.points.push_back({0.29 * t, 0.03 - 0.029 * t});
  }
  if (cliff_m > 0) {
    table.points.insert(
        table.points.begin() + static_cast<std::ptrdiff_t>(points / 2),
        {table.points[points / 2].x_m - cliff_m, table.points[points / 2].half_width_m + 2e-3});
  }
  s.taper = table;
  s.length_m = 0.29;
  return s;
}

}  // namespace

TEST_CASE("unusual values: the check itself finds an answer that is not finite, and one that is late",
          "[physics][unusual]") {
  CHECK(fault([] { return Numbers{inf}; }));
  CHECK(fault([]() -> Numbers {
    const double start = processor_s();
    while (processor_s() < start + 0.11 * patience) continue;
    throw std::runtime_error("late");
  }));
  CHECK_FALSE(fault([] { return Numbers{1}; }));
  CHECK_FALSE(fault([]() -> Numbers { throw std::runtime_error("soon"); }));
}

TEST_CASE("unusual values: every function of a surface and a frequency refuses them or answers",
          "[physics][unusual]") {
  Calls calls;
  for (const double f : unusual) {
    surface_calls(calls, "brass at " + std::to_string(f), seed_brass(), f);
    surface_calls(calls, "a thin plate at " + std::to_string(f), aluminium_plate(), f);
    surface_calls(calls, "a thick plate at " + std::to_string(f), thick_plate(), f);
    surface_calls(calls, "a curved membrane at " + std::to_string(f), curved_membrane(), f);
  }
  for (const double f : {1e9, 1e7, 1e6, 3e5, 10.0, 1e-3})
    surface_calls(calls, "brass at " + std::to_string(f), seed_brass(), f);
  for (const double f : {1e9, 1e6, 3e5, 10.0})
    surface_calls(calls, "a thin plate at " + std::to_string(f), aluminium_plate(), f);
  CHECK(calls.faults == "");
}

TEST_CASE("unusual values: every function refuses a surface that has one, or answers", "[physics][unusual]") {
  struct Quantity {
    const char* name;
    std::function<void(Surface&, double)> set;
  };
  const std::vector<Quantity> quantities{
      {"density", [](Surface& s, double v) { s.density_kg_m3 = v; }},
      {"tension", [](Surface& s, double v) { s.tension_Pa = v; }},
      {"thickness", [](Surface& s, double v) { s.thickness_m = v; }},
      {"length", [](Surface& s, double v) { s.length_m = v; }},
      {"quality factor", [](Surface& s, double v) { s.quality_factor = v; }},
      {"half-width",
       [](Surface& s, double v) {
         s.taper = LinearTaper{v, 0.03};
       }},
      {"slope",
       [](Surface& s, double v) {
         s.taper = LinearTaper{0.03, v};
       }},
      {"decay length",
       [](Surface& s, double v) {
         s.taper = ExponentialTaper{0.03, v};
       }},
      {"width of an exponential",
       [](Surface& s, double v) {
         s.taper = ExponentialTaper{v, 0.2};
       }},
      {"modulus", [](Surface& s, double v) { s.modulus_Pa = v; }},
      {"poisson", [](Surface& s, double v) { s.poisson = v; }},
      {"yield", [](Surface& s, double v) { s.yield_strength_Pa = v; }},
      {"expansion", [](Surface& s, double v) { s.expansion_per_K = v; }},
      {"modulus per kelvin", [](Surface& s, double v) { s.modulus_per_K = v; }},
      {"sd of thickness", [](Surface& s, double v) { s.sd.thickness_m = v; }},
      {"sd of half-width", [](Surface& s, double v) { s.sd.half_width_m = v; }},
      {"sd of the quality factor", [](Surface& s, double v) { s.sd.quality_factor = v; }},
      {"correlation",
       [](Surface& s, double v) {
         s.correlations = {{Parameter::thickness, Parameter::density, v}};
       }},
      {"step of a table",
       [](Surface& s, double v) {
         s.taper = TabulatedTaper{{{0, 0.03}, {v, 0.02}, {0.3, 0.001}}};
       }},
      {"width in a table", [](Surface& s, double v) {
         s.taper = TabulatedTaper{{{0, 0.03}, {0.1, v}, {0.3, 0.001}}};
       }}};
  Calls calls;
  for (const Surface& base : {seed_brass(), thick_plate()})
    for (const Quantity& q : quantities)
      for (const double v : unusual) {
        Surface s = base;
        q.set(s, v);
        surface_calls(calls, std::string(q.name) + " of " + std::to_string(v), s, 2.5e4);
      }
  CHECK(calls.faults == "");
}

TEST_CASE("unusual values: tables of 2 and of 100 000 points, and cliffs", "[physics][unusual]") {
  Calls calls;
  surface_calls(calls, "a table of 2 points", tabulated(2), 2e4);
  surface_calls(calls, "a table of 2000 points", tabulated(2000), 2e4);
  surface_calls(calls, "a table of 100 000 points", tabulated(100'000), 2e4);
  for (const double cliff_m : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-300})
    surface_calls(calls, "a cliff of " + std::to_string(1e6 * cliff_m) + " um", tabulated(5, cliff_m), 2e4);
  Surface plate = tabulated(2000);
  plate.tension_Pa = 0;
  plate.thickness_m = 2e-3;
  plate.edges = Edges::clamped;
  plate.modulus_Pa = 69e9;
  surface_calls(calls, "a plate with a table of 2000 points", plate, 2.5e4);
  CHECK(calls.faults == "");
}

TEST_CASE("unusual values: in every other argument", "[physics][unusual]") {
  Calls calls;
  const Surface s = aluminium_plate(), brass = seed_brass();
  for (const double v : unusual) {
    const std::string what = " of " + std::to_string(v);
    const Tone loud{3e4, v, 0}, turned{3e4, 1e-6, v}, tone{3e4, 1e-6, 0};
    const Numbers x{v};
    for (const Tone& one : {loud, turned})
      calls("tone" + what, [&] {
        Numbers all;
        add(all, evaluate(s, {&one, 1}, Numbers{0, 0.1}, Model::mode, Normalise::none));
        return all;
      });
    calls("points" + what, [&] {
      Numbers all;
      add(all, evaluate(s, {&tone, 1}, x, Model::mode, Normalise::peak));
      return all;
    });
    calls("displacement" + what, [&] { return Numbers{drive_amplitude_m(s, 3e4, v)}; });
    calls("distance" + what, [&] { return Numbers{loudest_sound(s, tone, Model::mode, v).level_dB}; });
    calls("air" + what, [&] { return Numbers{loudest_sound(s, tone, Model::mode, 0.5, {v, 343}).level_dB}; });
    calls("speed in air" + what, [&] {
      return Numbers{loudest_sound(s, tone, Model::mode, 0.5, {1.2, v}).level_dB};
    });
    calls("place" + what, [&] { return Numbers{half_width_m(s, v), boundary_budget(s, 3e4, v).total_m}; });
    for (const Finger& finger :
         {Finger{{v, 0}, 4e-3, 0}, Finger{{0, v}, 4e-3, 0}, Finger{{55, 0}, v, 0}, Finger{{55, 0}, 4e-3, v}})
      calls("finger" + what, [&] {
        Numbers all;
        for (const FingerLoad& load : finger_load(s, 3e4, {0.05, 0.1}, finger))
          all.push_back(std::abs(load.loaded));
        return all;
      });
    calls("finger's place" + what,
          [&] { return Numbers{std::abs(finger_load(s, 3e4, {v}, {}).front().loaded)}; });
    for (const FrictionContext& context :
         {FrictionContext{FrictionMap{}, v, 1e-2}, FrictionContext{FrictionMap{}, 1e-6, v}})
      calls("friction edge" + what, [&] {
        Numbers all;
        MapOptions options{Edge::friction(0.7), {}, {}, context};
        options.band = {2e4, 3e4};
        add(all, solve_frequency_Hz(brass, options, 0.2));
        add(all, BoundaryMap(brass, options).boundary_m(2.5e4));
        return all;
      });
    for (const Edge& edge : {Edge::percent(v), Edge::friction(v)})
      calls("edge" + what, [&] {
        Numbers all;
        MapOptions options{edge, {}, {}, FrictionContext{}};
        options.band = {2e4, 3e4};
        add(all, solve_frequency_Hz(brass, options, 0.2));
        return all;
      });
    calls("boundary" + what, [&] {
      Numbers all;
      const BoundaryMap map(s, {Edge::percent(0.5), {}, {}, {}});
      add(all, map.frequency_Hz(v)), add(all, map.boundary_m(v)), add(all, map.at_boundary(v));
      add(all, answer_at_boundary(s, {Edge::percent(0.5), {}, {}, {}}, v));
      add(all, solve_frequency_Hz(s, {Edge::percent(0.5), {}, {}, {}}, v));
      return all;
    });
    for (const auto band : {MapOptions::Band{v, 3e4}, MapOptions::Band{2e4, v}})
      calls("band" + what, [&] {
        Numbers all;
        add(all, BoundaryMap(curved_membrane(), {Edge::percent(0.5), {}, {}, {}, band}).boundary_m(2.5e4));
        return all;
      });
    for (int field = 0; field < 3; ++field)
      calls("tolerance" + what, [&] {
        Numbers all;
        PlanRequest request{{tone}, 100, Edge::percent(0.5), Normalise::drive, {}};
        if (field == 0) request.tolerance.boundary_m = v;
        if (field == 1) request.tolerance.amplitude = v;
        if (field == 2) request.tolerance.level_dB = v;
        add(all, choose_model(s, request).bound);
        return all;
      });
    calls("tolerance of a theory" + what, [&] {
      const double f = 3e4;
      return Numbers{choose_theory(s, {&f, 1}, v).shift_m};
    });
    for (double LoadSharing::*member : {&LoadSharing::pressure_Pa, &LoadSharing::floor,
                                        &LoadSharing::decay_length_m, &LoadSharing::ambient_Pa})
      calls("load sharing" + what, [&] {
        LoadSharing model;
        model.*member = v;
        const FrictionMap map(model);
        Numbers all{map.relative_friction(1e-6), map.sd(1e-6), map.lowest_friction(),
                    map.highest_displacement_m()};
        add(all, map.displacement_m(0.5));
        return all;
      });
    calls("friction" + what, [&] {
      const FrictionMap map;
      Numbers all{map.relative_friction(v), map.sd(v)};
      add(all, map.displacement_m(v));
      return all;
    });
    for (const auto& table : {std::vector<FrictionPoint>{{0, 1, 0}, {v, 0.5, 0}, {3e-6, 0.2, 0}},
                              {{0, 1, 0}, {1e-6, v, 0}},
                              {{0, 1, 0}, {1e-6, 0.5, v}}})
      calls("friction table" + what, [&] {
        const FrictionMap map(table);
        Numbers all{map.relative_friction(5e-7), map.sd(5e-7)};
        add(all, map.displacement_m(0.7));
        return all;
      });
    calls("fingertip_average" + what, [&] { return fingertip_average(Numbers{0, 1}, Numbers{1, 2}, v); });
    calls("values averaged" + what, [&] { return fingertip_average(Numbers{0, 1}, Numbers{1, v}, 0.5); });
    calls("places averaged" + what, [&] { return fingertip_average(Numbers{0, v}, Numbers{1, 2}, 0.5); });
    calls("squeeze film" + what, [&] { return Numbers{squeeze_film_overpressure(v)}; });
    for (const Tone& one : {Tone{v, 1, 0}, Tone{3e4, v, 0}, Tone{3e4, 1, v}})
      calls("phases" + what, [&] {
        std::vector<Tone> tones{one, {3.1e4, 1, 0}, {3.3e4, 1, 0}};
        assign_phases(tones);
        Numbers all{crest_factor(tones)};
        for (const Product& product : audible_products(tones)) all.push_back(product.frequency_Hz);
        return all;
      });
    for (std::size_t member = 0; member < 7; ++member)
      calls("zone" + what, [&] {
        ZoneRequest request;
        request.from_m = 0.02, request.boundary_m = 0.15, request.edge = Edge::percent(0.5);
        *std::array{&request.from_m,      &request.boundary_m,   &request.friction,
                    &request.band.low_Hz, &request.band.high_Hz, &request.band.spacing_Hz,
                    &request.fingertip_m}
             .at(member) = v;
        const ZoneDesign design = design_zone(s, FrictionMap{}, request);
        return Numbers{design.boundary_m, design.friction, design.residual, design.crest_factor};
      });
    for (const ToneBand& band : {ToneBand{v, 4e4, 1e3}, ToneBand{2.5e4, v, 1e3}, ToneBand{2.5e4, 4e4, v}})
      calls("profile's band" + what, [&] {
        const std::vector<ProfilePoint> target{{0.02, 1e-6}, {0.1, 5e-7}};
        return Numbers{design_profile(s, target, band).residual};
      });
    for (const ProfilePoint& point : {ProfilePoint{v, 1e-6}, ProfilePoint{0.1, v}})
      calls("profile" + what, [&] {
        const std::vector<ProfilePoint> target{{0.02, 1e-6}, point};
        return Numbers{design_profile(s, target, {}).residual};
      });
  }
  std::vector<FrictionPoint> many;
  for (int i = 0; i < 100'000; ++i) many.push_back({1e-10 * i, 1 - 9e-6 * i, 0.01});
  calls("friction table of 100 000 points", [&] {
    const FrictionMap map(many);
    return Numbers{map.relative_friction(5e-7), map.displacement_m(0.7).value()};
  });
  CHECK(calls.faults == "");
}
