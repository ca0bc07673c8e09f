#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <memory>

#include "physics/centre_line.hpp"
#include "physics/field.hpp"
#include "physics/planner.hpp"
#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/cli/tones.hpp"
#include "station/core/number.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"

namespace turnpoint::cli {

namespace field_command {

struct Options {
  std::string rig, calibration, at, model = "auto", normalise = "drive";
  std::vector<std::string> tones;
  int points = 0;
  double tolerance = 0;
};

struct Choice {
  physics::Model model;
  std::string why;
};

Choice choose(const physics::Surface& surface, const std::vector<physics::Tone>& tones, int points,
              const Options& options) {
  if (options.model != "auto") return {physics::parse_model(options.model), "asked for"};
  physics::PlanRequest request;
  request.tones = tones;
  request.points = points;
  request.normalise = physics::parse_normalise(options.normalise);
  if (options.tolerance > 0) request.tolerance.amplitude = options.tolerance;
  // Without a tolerance the cheapest model would be chosen, which is too inaccurate. Use the equation for one
  // mode instead.
  if (options.tolerance <= 0)
    return {physics::Model::mode, "the one-mode equation, because no tolerance was given"};
  auto choice = physics::choose_model(surface, request);
  return {choice.model, choice.reason};
}

Json tones_json(const physics::Surface& surface, const physics::Field& field) {
  Json list = Json::array();
  for (const auto& tone : field.tones) {
    Json re = Json::array(), im = Json::array();
    for (const auto& v : tone.v) re.push_back(json_number(v.real())), im.push_back(json_number(v.imag()));
    list.push_back({{"frequency_Hz", tone.info.frequency_Hz},
                    {"re", re},
                    {"im", im},
                    {"turning_point_mm", json_number(tone.info.turning_point_m, 1e3)},
                    {"last_peak_mm", json_number(tone.info.last_peak_m, 1e3)},
                    {"gain", json_number(tone.info.gain)},
                    {"nearest_resonance_Hz",
                     json_number(physics::nearest_resonance_Hz(surface, tone.info.frequency_Hz))},
                    {"conditioning", json_number(tone.info.conditioning)},
                    {"no_peak_reason", tone.info.no_peak_reason}});
  }
  return list;
}

Json to_json(const physics::Surface& surface, const physics::Field& field, const physics::FieldNotes& notes,
             const Choice& choice, const std::vector<double>& x_m, const std::vector<double>& friction) {
  Json document = {{"model", physics::name(field.model)},
                   {"error_bound", json_number(notes.error_bound)},
                   {"why", choice.why},
                   {"validity", notes.validity},
                   {"normalise", physics::name(field.normalise)},
                   {"unit", field.normalise == physics::Normalise::none ? "m" : "relative"},
                   {"x_mm", json_numbers(x_m, 1e3)}};
  const auto tones = tones_json(surface, field);
  if (field.tones.size() == 1) document["re"] = tones[0]["re"], document["im"] = tones[0]["im"];
  document["amplitude"] = json_numbers(field.amplitude);
  document["ln_amplitude"] = json_numbers(field.ln_amplitude);
  document["friction"] = json_numbers(friction);
  document["tones"] = tones;
  document["warnings"] = json_warnings(notes.warnings);
  return document;
}

void print(std::ostream& out, const physics::Field& field, const physics::FieldNotes& notes,
           const Choice& choice, const std::vector<double>& x_m, const std::vector<double>& friction) {
  using core::number;
  fmt::print(out, "model {} ({}); error bound {} of the largest amplitude\n", physics::name(field.model),
             choice.why, number(notes.error_bound, 3));
  for (const auto& tone : field.tones)
    fmt::print(
        out, "{} Hz: turning point {} mm, last maximum {} mm, gain {}\n", number(tone.info.frequency_Hz, 8),
        tone.info.turning_point_m ? number(*tone.info.turning_point_m * 1e3) : "none",
        tone.info.last_peak_m ? number(*tone.info.last_peak_m * 1e3) : "none: " + tone.info.no_peak_reason,
        number(tone.info.gain, 4));
  for (const auto& warning : notes.warnings) fmt::print(out, "warning: {}\n", warning.text);
  fmt::print(out, "{:>10} {:>14} {:>12} {:>9}\n", "x mm", "amplitude", "ln", "friction");
  for (std::size_t i = 0; i < x_m.size(); ++i)
    fmt::print(out, "{:>10} {:>14.6g} {:>12.6g} {:>9.4f}\n", number(x_m[i] * 1e3), field.amplitude[i],
               field.ln_amplitude[i], friction[i]);
}

void field(const Options& options, Context& context) {
  if ((options.points > 0) == !options.at.empty()) throw UsageError("field: give either --points or --at");
  const auto rig = session::calibrated_rig(session::rig_or_default(options.rig, context.err), options.calibration,
                                         context.err);
  const auto surface = rig::surface_of(rig);
  const auto tones = parse_tones(options.tones);
  std::vector<double> x_m;
  if (options.points > 0) x_m = physics::linspace_points(surface, options.points);
  if (!options.at.empty())
    for (const double mm : parse_list(options.at, "--at")) x_m.push_back(mm * 1e-3);
  const auto choice = choose(surface, tones, static_cast<int>(x_m.size()), options);
  const auto result =
      physics::evaluate(surface, tones, x_m, choice.model, physics::parse_normalise(options.normalise));
  // The friction model needs amplitudes in metres, so compute them again without the normalisation that the
  // user chose.
  const auto metres = physics::amplitude_profile(surface, tones, x_m, choice.model);
  const auto map = rig::friction_of(rig);
  std::vector<double> friction;
  for (const double a : metres) friction.push_back(map.relative_friction(a));
  const auto notes = physics::describe(surface, tones, result);
  if (context.json)
    context.out << to_json(surface, result, notes, choice, x_m, friction).dump(-1, ' ', false, kInvalidBytes)
                << "\n";
  else
    print(context.out, result, notes, choice, x_m, friction);
}

}  // namespace field_command

void add_field(CommandLine& app, Context& context) {
  using namespace field_command;
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("field", "Compute displacement and friction along the centre line of the surface");
  add_rig(*command, options->rig);
  add_calibration(*command, options->calibration);
  command
      ->add_option("--tone", options->tones,
                   "HZ[:UM[:DEG]]: frequency, displacement of the driven edge, phase")
      ->required();
  command
      ->add_option("--points", options->points,
                   "Number of evenly spaced points along the surface, ends included")
      ->check(range(2, 1'000'000));
  command->add_option("--at", options->at, "Positions in mm, separated by commas");
  command
      ->add_option("--model", options->model, "Physical model: auto | mode | modes")
      ->check(one_of({"auto", "mode", "modes"}))
      ->capture_default_str();
  command->add_option("--tolerance", options->tolerance, "Allowed relative error of the amplitude")
      ->check(positive());
  command
      ->add_option(
          "--normalise", options->normalise,
          "Amplitude that is set to 1: drive (at the driven edge) | peak (last maximum) | none (in m)")
      ->capture_default_str();
  add_json(*command, context);
  command->footer("Example: turnpoint field --tone 30000:0.5 --points 301");
  command->callback([options, &context] { with_users_numbers([&] { field(*options, context); }); });
}

}  // namespace turnpoint::cli
