#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>

#include "station/cli/command.hpp"
#include "station/cli/json.hpp"
#include "station/cli/shared_options.hpp"
#include "station/cli/sound.hpp"
#include "station/core/number.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/resolve.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/following.hpp"
#include "station/scene/planner.hpp"
#include "station/session/places.hpp"
#include "station/session/prepare.hpp"
#include "station/view/preview.hpp"

namespace turnpoint::cli {

namespace plan_command {

struct Options {
  std::string protocol, rig, calibration, scene;
  std::vector<std::string> set;
};

Json tones_json(scene::Planner& planner, const scene::DrivePlan& plan) {
  Json tones = Json::array();
  for (const auto& tone : plan.tones)
    tones.push_back(
        {{"frequency_Hz", tone.frequency_Hz},
         {"drive_um", json_number(tone.amplitude_m * 1e6)},
         {"phase_deg", json_number(tone.phase_rad * 180 / M_PI)},
         {"transducer", tone.transducer},
         {"channel", tone.channel},
         {"full_scale", json_number(tone.full_scale)},
         {"turning_point_mm", json_number(tone.turning_point_m, 1e3)},
         {"last_peak_mm", json_number(tone.last_peak_m, 1e3)},
         {"displacement_um", json_number(tone.displacement_m * 1e6)},
         {"gain", json_number(tone.gain)},
         {"nearest_resonance_Hz", json_number(planner.nearest_resonance_Hz(plan, tone.frequency_Hz))}});
  return tones;
}

/// The contrast in dB between the friction of a scene and that of its base scene, 20 log10(1 - friction /
/// base). Empty unless the friction is below that of the base.
std::optional<double> contrast_dB(const std::optional<double>& base, const std::optional<double>& friction) {
  if (!base || !friction || *friction >= *base) return std::nullopt;
  return 20 * std::log10(1 - *friction / *base);
}

/// How a finger changes a scene; if there is a base scene, also the contrast to it without and with the
/// finger.
struct Touched {
  scene::UnderFinger under;
  std::optional<double> free_contrast_dB, contrast_dB;
};

Touched touched(scene::Planner& planner, const scene::DrivePlan& plan,
                const std::optional<scene::DrivePlan>& base) {
  Touched all{planner.under_finger(plan), {}, {}};
  if (!base) return all;
  const auto below = planner.under_finger(*base);
  const bool zone = plan.zone_friction.has_value();
  all.free_contrast_dB = zone ? contrast_dB(base->zone_friction, plan.zone_friction)
                              : contrast_dB(below.free_friction, all.under.free_friction);
  all.contrast_dB = zone ? contrast_dB(below.zone_friction, all.under.zone_friction)
                         : contrast_dB(below.friction, all.under.friction);
  return all;
}

Json level_json(const scene::UnderFinger& under) {
  if (!under.level) return nullptr;
  Json parts = Json::object();
  for (const auto& part : under.level->parts)
    parts[std::string(physics::name(part.parameter))] = json_number(part.level_dB);
  return {{"sd_dB", json_number(under.level->total_dB)},
          {"interval_dB", {json_number(under.level->low_dB), json_number(under.level->high_dB)}},
          {"friction_interval", {json_number(under.friction_low), json_number(under.friction_high)}},
          {"parts_dB", parts}};
}

Json touched_json(const Touched& touched) {
  const auto& under = touched.under;
  return {{"level_uncertainty", level_json(under)},
          {"finger_mm", json_number(under.finger_m * 1e3)},
          {"free_um", json_number(under.free_m * 1e6)},
          {"displacement_um", json_number(under.displacement_m * 1e6)},
          {"displacement_range_um", {json_number(under.least_m * 1e6), json_number(under.most_m * 1e6)}},
          {"free_friction", json_number(under.free_friction)},
          {"friction", json_number(under.friction)},
          {"lowest_friction", json_number(under.lowest_friction)},
          {"zone_friction", json_number(under.zone_friction)},
          {"residual", json_number(under.residual)},
          {"boundary_shift_mm", json_number(under.boundary_shift_m, 1e3)},
          {"free_contrast_dB", json_number(touched.free_contrast_dB)},
          {"contrast_dB", json_number(touched.contrast_dB)}};
}

Json follow_json(const scene::DrivePlan& plan) {
  if (!plan.follow) return nullptr;
  const auto figures = scene::follow_figures(plan);
  Json textures = Json::array(), unmet = Json::array();
  for (const auto& texture : figures.textures)
    textures.push_back({{"part", texture.part + 1},
                        {"period_mm", json_number(1e3 * texture.period_m)},
                        {"place_mm", json_number(1e3 * texture.place_m)},
                        {"bandwidth_Hz", json_number(texture.bandwidth_Hz)},
                        {"most_speed_mm_s", json_number(texture.most_speed_m_s, 1e3)}});
  for (const auto& one : figures.unmet)
    unmet.push_back({{"from_mm", json_number(1e3 * one.from_m)},
                     {"to_mm", json_number(1e3 * one.to_m)},
                     {"text", core::say(scene::in_words(plan, one), "en")}});
  return {{"delay_ms", json_number(1e3 * figures.delay.total_s)},
          {"converter_ms", json_number(1e3 * figures.delay.converter_s)},
          {"plate_ms", json_number(1e3 * figures.time_constant_s)},
          {"loop_cutoff_Hz", json_number(figures.loop_cutoff_Hz)},
          {"textures", textures},
          {"unmet", unmet}};
}

Json to_json(scene::Planner& planner, const scene::DrivePlan& plan, const protocol::Factors& factors,
             const std::optional<scene::SoundBound>& sound, const Touched& touched) {
  Json values;
  for (const auto& [name, value] : factors)
    std::visit([&values, &name = name](const auto& v) { values[name] = v; }, value);
  Json products = Json::array();
  for (const auto& product : plan.audible_products)
    products.push_back({{"frequency_Hz", product.frequency_Hz}, {"order", product.order}});
  const auto& cues = plan.cues;
  return {{"scene", plan.scene.name},
          {"factors", values},
          {"model", physics::name(plan.model)},
          {"reason", plan.reason},
          {"inside_tolerance", plan.inside_tolerance},
          {"boundary_mm", json_number(plan.boundary_m, 1e3)},
          {"edge", physics::format(plan.scene.edge)},
          {"error_bound_mm", json_number(plan.error_bound_m * 1e3)},
          {"level_bound_dB", json_number(plan.level_bound_dB)},
          {"amplitude_bound", json_number(plan.amplitude_bound)},
          {"uncertainty_mm", json_number(plan.uncertainty_m * 1e3)},
          {"plate_theory", physics::name(plan.theory)},
          {"shear_shift_mm", json_number(plan.shear_shift_m, 1e3)},
          {"tones", tones_json(planner, plan)},
          {"zone_friction", json_number(plan.zone_friction)},
          {"residual", json_number(plan.residual)},
          {"lowest_friction", json_number(plan.lowest_friction)},
          {"peak_displacement_um", json_number(plan.peak_displacement_m * 1e6)},
          {"under_finger", touched_json(touched)},
          {"sound", json_sound(sound)},
          {"peak_full_scale", json_number(plan.peak_full_scale)},
          {"crest_factor", json_number(plan.crest_factor)},
          {"audible_products", products},
          {"cues",
           {{"pitch_Hz", json_number(cues.pitch_Hz)},
            {"loudness_dB", json_number(cues.loudness_dB)},
            {"wide_end_amplitude_um", json_number(cues.wide_end_amplitude_m * 1e6)},
            {"stripe_pitch_mm", json_number(cues.stripe_pitch_m * 1e3)},
            {"edge_width_mm", json_number(cues.edge_width_m * 1e3)},
            {"strip_width_mm", json_number(cues.strip_width_m * 1e3)},
            {"displacement_um", json_number(cues.displacement_m * 1e6)}}},
          {"follow", follow_json(plan)},
          {"warnings", json_warnings(plan.warnings)}};
}

void print(std::ostream& out, const Touched& touched) {
  using core::number;
  const auto& under = touched.under;
  fmt::print(out, "  under a finger at {} mm: {} um (people differ: {} to {}), without it {} um\n",
             number(under.finger_m * 1e3, 4), number(under.displacement_m * 1e6, 3),
             number(under.least_m * 1e6, 3), number(under.most_m * 1e6, 3), number(under.free_m * 1e6, 3));
  fmt::print(out, "  friction under a finger there {}, without it {}; lowest anywhere under a finger {}\n",
             number(under.friction, 3), number(under.free_friction, 3), number(under.lowest_friction, 3));
  if (under.level) {
    fmt::print(
        out,
        "  uncertain parameters of the rig: level there {} dB (one standard deviation), 95 % between {} and "
        "{} dB, friction between {} and {}; most from ",
        number(under.level->total_dB, 2), number(under.level->low_dB, 2), number(under.level->high_dB, 2),
        number(under.friction_low, 3), number(under.friction_high, 3));
    for (std::size_t i = 0; i < std::min<std::size_t>(3, under.level->parts.size()); ++i)
      fmt::print(out, "{}{} {} dB", i == 0 ? "" : ", ", physics::name(under.level->parts[i].parameter),
                 number(under.level->parts[i].level_dB, 2));
    fmt::print(out, "\n");
  }
  if (under.zone_friction)
    fmt::print(out, "  zone under a finger: mean friction {}, rms {} about it\n",
               number(*under.zone_friction, 3), number(under.residual.value_or(0), 3));
  if (touched.contrast_dB && touched.free_contrast_dB)
    fmt::print(out, "  contrast to the base scene: {} dB under a finger, {} dB without it\n",
               number(*touched.contrast_dB, 3), number(*touched.free_contrast_dB, 3));
  if (under.boundary_shift_m)
    fmt::print(out, "  a moving finger displaces the edge by {} mm\n",
               number(*under.boundary_shift_m * 1e3, 3));
}

void print_follow(std::ostream& out, const scene::DrivePlan& plan) {
  using core::number;
  if (!plan.follow) return;
  const auto figures = scene::follow_figures(plan);
  fmt::print(out, "  follows the finger: {}\n", follow::sentence(figures.delay));
  fmt::print(out, "  the plate rings with a time constant of {} ms\n",
             number(1e3 * figures.time_constant_s, 3));
  if (figures.loop_cutoff_Hz)
    fmt::print(out, "  friction is held by a loop of {} Hz\n", number(*figures.loop_cutoff_Hz, 3));
  for (const auto& texture : figures.textures) {
    fmt::print(out, "  part {}: bandwidth {} Hz for this change (least at {} mm)", texture.part + 1,
               number(texture.bandwidth_Hz, 3), number(1e3 * texture.place_m, 4));
    if (texture.most_speed_m_s)
      fmt::print(out, ", felt by fingers up to {} mm/s\n", number(1e3 * *texture.most_speed_m_s, 3));
    else
      fmt::print(out, "{}\n", texture.period_m > 0 ? ", felt at no speed" : "");
  }
  if (figures.unmet.empty()) fmt::print(out, "  everything that is asked for can be reached\n");
  for (const auto& unmet : figures.unmet)
    fmt::print(out, "  not met: {}\n", core::say(scene::in_words(plan, unmet), "en"));
}

void print(std::ostream& out, const scene::DrivePlan& plan, const std::optional<scene::SoundBound>& sound,
           const Touched& touched) {
  using core::number;
  if (plan.scene.tones.empty())
    fmt::print(out, "Scene {}: boundary at {} mm ({} edge)\n", plan.scene.name,
               plan.boundary_m ? number(*plan.boundary_m * 1e3) : "none", physics::format(plan.scene.edge));
  else
    fmt::print(out, "Scene {}: {} tone{}\n", plan.scene.name, plan.scene.tones.size(),
               plan.scene.tones.size() == 1 ? "" : "s");
  fmt::print(out, "  model {}: {}\n", physics::name(plan.model), plan.reason);
  fmt::print(out, "  model error at most {} mm{}\n", number(plan.error_bound_m * 1e3, 3),
             plan.inside_tolerance ? "" : "; EXCEEDS the scene's tolerance");
  fmt::print(out, "  {}\n", uncertainty_in_words(plan.uncertainty_m));
  if (plan.theory == physics::PlateTheory::elastic)
    fmt::print(out, "  plate theory elastic\n");
  else if (plan.shear_shift_m)
    fmt::print(out, "  plate theory {}; {} would move the boundary by {} mm\n", physics::name(plan.theory),
               plan.theory == physics::PlateTheory::kirchhoff ? "shear" : "an elastic cross-section",
               number(*plan.shear_shift_m * 1e3, 3));
  for (const auto& tone : plan.tones)
    fmt::print(out, "  {} Hz, drive {} um at {} deg on {} ({} of full scale), {} um at its last maximum{}\n",
               number(tone.frequency_Hz, 8), number(tone.amplitude_m * 1e6, 4),
               number(tone.phase_rad * 180 / M_PI, 4), tone.transducer, number(tone.full_scale, 3),
               number(tone.displacement_m * 1e6, 4),
               tone.last_peak_m ? " (" + number(*tone.last_peak_m * 1e3) + " mm)" : "");
  if (plan.zone_friction)
    fmt::print(out, "  zone: mean friction {}, rms {} about it\n", number(*plan.zone_friction, 3),
               number(plan.residual.value_or(0), 3));
  fmt::print(out, "  largest displacement of the surface {} um, crest factor {}, lowest friction {}\n",
             number(plan.peak_displacement_m * 1e6, 4), number(plan.crest_factor, 3),
             number(plan.lowest_friction, 3));
  print(out, touched);
  print_follow(out, plan);
  fmt::print(out, "  sound: {}\n", in_words(sound));
  for (const auto& product : plan.audible_products)
    fmt::print(out, "  audible product: {} Hz, order {}\n", number(product.frequency_Hz), product.order);
  for (const auto& warning : plan.warnings) fmt::print(out, "  warning: {}\n", warning.text);
}

void plan(const Options& options, Context& context) {
  const auto protocol = protocol::load(options.protocol);
  const auto rig = session::calibrated_rig(session::rig_or_default(options.rig, context.err),
                                           options.calibration, context.err);
  if (!protocol.scenes.count(options.scene)) {
    std::string known;
    for (const auto& [name, scene] : protocol.scenes) known += (known.empty() ? "" : ", ") + name;
    throw UsageError(
        fmt::format("--scene {}: the protocol has no such scene; its scenes are {}", options.scene, known));
  }
  std::vector<std::string> assumed;
  const auto factors = view::factors_for(protocol, options.set, assumed);
  for (const auto& name : assumed)
    std::visit([&](const auto& value) { fmt::print(context.err, "{} = {} (not --set)\n", name, value); },
               factors.at(name));
  scene::Planner planner(rig);
  const auto result = planner.plan(protocol::resolve(protocol, options.scene, factors, 0));
  const std::vector<physics::Tone> tones(result.tones.begin(), result.tones.end());
  const auto sound = scene::sound_bound(rig, tones, result.model);
  std::optional<scene::DrivePlan> base;
  if (const auto& from = protocol.scenes.at(options.scene); from.friction_contrast_dB)
    base = planner.plan(protocol::resolve(protocol, from.base, factors, 0));
  const auto finger = touched(planner, result, base);
  if (context.json)
    print_json(context.out, to_json(planner, result, factors, sound, finger));
  else
    print(context.out, result, sound, finger);
}

}  // namespace plan_command

void add_plan(CommandLine& app, Context& context) {
  using namespace plan_command;
  auto options = std::make_shared<Options>();
  auto* command =
      app.add_subcommand("plan", "Show how a scene of a protocol is presented: tones, model, reason, cues");
  add_protocol(*command, options->protocol)->required();
  command->add_option("--scene", options->scene, "Name of the scene")->required();
  command->add_option(
      "--set", options->set,
      "Value of a factor, as factor=value; by default its first level or the middle of its range");
  add_rig(*command, options->rig);
  add_calibration(*command, options->calibration);
  add_json(*command, context);
  command->footer("Example: turnpoint plan demo --scene edge --set offset_mm=9");
  command->callback([options, &context] { with_users_numbers([&] { plan(*options, context); }); });
}

}  // namespace turnpoint::cli
