#include "station/rig/surface.hpp"

#include <array>
#include <cmath>

namespace turnpoint::rig {

using core::phrase, core::plain;

namespace {

// Handbook values for common tempers. A rig used for research should state its own values. The yield strength
// is only used to warn about a tension that the material cannot carry. expansion_per_K and modulus_per_K are
// the relative changes of length and of Young's modulus per kelvin at room temperature (for aluminium, from
// NIST's fits for 6061-T6). modulus_per_K is 0 where it depends on the product.
struct Material {
  const char* name;
  double density_kg_m3, modulus_GPa, poisson, yield_MPa, expansion_per_K, modulus_per_K;
};
constexpr std::array known_materials{
    Material{"aluminium", 2700, 69, 0.33, 275, 23.6e-6, -5.3e-4},
    Material{"brass", 8500, 105, 0.34, 450, 20e-6, -4e-4},
    Material{"copper", 8960, 120, 0.34, 210, 17e-6, -3.5e-4},
    Material{"glass", 2500, 70, 0.22, 45, 9e-6, 0},
    Material{"pmma", 1180, 3.1, 0.37, 70, 70e-6, 0},
    Material{"silicone rubber", 1100, 0.002, 0.49, 5, 300e-6, 0},
    Material{"steel", 7850, 205, 0.29, 350, 12e-6, -3e-4},
    Material{"titanium", 4430, 114, 0.34, 880, 8.6e-6, -5e-4},
};

const Material* find_material(const std::string& name) {
  for (const auto& material : known_materials)
    if (name == material.name) return &material;
  return nullptr;
}

void read_material(core::TableReader& reader, Surface& surface) {
  const auto word = reader.maybe_word("material");
  surface.material = word.value_or("");
  const auto* filled = find_material(surface.material);
  const auto from_material = [&](const char* key, double fallback) {
    return filled ? reader.number_or(key, fallback) : reader.number(key);
  };
  surface.density_kg_m3 = from_material("density_kg_m3", filled ? filled->density_kg_m3 : 0);
  surface.tension_Pa = reader.number("tension_Pa");
  const auto bending = reader.word("bending");
  surface.bending = bending == "on" ? Bending::on : bending == "off" ? Bending::off : Bending::automatic;
  if (surface.tension_Pa == 0 && surface.bending == Bending::off)
    reader.problem(
        "bending",
        phrase("\"bending\" is off although there is no tension, so nothing would hold the surface"),
        phrase("set \"tension_Pa\" above 0, or \"bending\" to \"auto\" or \"on\""));
  const bool needs_bending = surface.tension_Pa == 0 || surface.bending == Bending::on;
  if (filled || needs_bending || reader.has("modulus_GPa")) {
    surface.modulus_Pa = 1e9 * from_material("modulus_GPa", filled ? filled->modulus_GPa : 0);
    surface.poisson = from_material("poisson", filled ? filled->poisson : 0);
  } else {
    surface.poisson = reader.maybe_number("poisson");
  }
  if (filled) surface.yield_Pa = 1e6 * filled->yield_MPa;
  if (const auto yield = reader.maybe_number("yield_MPa")) surface.yield_Pa = 1e6 * *yield;
}

void read_profile(const core::Value& list, core::TableReader& reader, Taper& taper) {
  const auto allowed = phrase(
      "write a list of %1 pairs in mm, with x in ascending order from 0 and half-widths above 0 that never "
      "increase",
      {plain("[x, half-width]")});
  const auto bad = [&](const core::Place& place, const core::Phrase& what) {
    reader.findings().add(place, what, allowed);
  };
  if (list.kind != core::Value::Kind::array)
    return bad(list.place, phrase("\"%1\" is %2", {plain("profile_mm"), describe(list)}));
  for (const auto& item : list.items) {
    const bool pair = item.kind == core::Value::Kind::array && item.items.size() == 2;
    if (!pair) return bad(item.place, phrase("a point of \"profile_mm\" is not a pair"));
    for (const auto& x : item.items)
      if ((x.kind != core::Value::Kind::number && x.kind != core::Value::Kind::integer) ||
          !std::isfinite(x.number))
        return bad(x.place, phrase("a point of \"profile_mm\" contains %1", {describe(x)}));
    const double x_m = 1e-3 * item.items[0].number, w_m = 1e-3 * item.items[1].number;
    const auto& points = taper.profile_m;
    if (points.empty() ? x_m != 0 : x_m <= points.back().first)
      return bad(item.place, phrase("the x values of \"profile_mm\" are not in ascending order from 0"));
    if (w_m <= 0 || (!points.empty() && w_m > points.back().second))
      return bad(item.place,
                 phrase("a half-width of \"profile_mm\" is not above 0, or is larger than the one before"));
    taper.profile_m.emplace_back(x_m, w_m);
  }
  if (taper.profile_m.size() < 2) return bad(list.place, phrase("\"profile_mm\" has fewer than two points"));
  taper.half_width_m = taper.profile_m.front().second;
}

void check_length(const Surface& surface, core::TableReader& reader) {
  const auto& taper = surface.taper;
  if (taper.slope && taper.half_width_m - *taper.slope * surface.length_m < -1e-9)
    reader.problem("slope",
                   phrase("the half-width reaches 0 at %1 mm, before the end of the surface",
                          {plain(core::number(1e3 * taper.half_width_m / *taper.slope))}),
                   phrase("\"length_mm\" must be at most %1", {plain("half_width_mm / slope")}));
  if (!taper.profile_m.empty() && taper.profile_m.back().first < surface.length_m - 1e-9)
    reader.problem("profile_mm", phrase("the profile ends before the surface does"),
                   phrase("the last point must be at \"length_mm\" or beyond"));
}

void read_taper(core::TableReader& reader, Surface& surface) {
  auto& taper = surface.taper;
  const auto slope = reader.maybe_number("slope");
  const auto decay_mm = reader.maybe_number("decay_length_mm");
  const auto* profile = reader.take("profile_mm");
  if (!profile) taper.half_width_m = 1e-3 * reader.number("half_width_mm");
  taper.slope = slope;
  if (decay_mm) taper.decay_length_m = 1e-3 * *decay_mm;
  if (profile) read_profile(*profile, reader, taper);
  const auto deviation = [&](const char* key) { return reader.maybe_number(key).value_or(0); };
  surface.half_width_sd_m = 1e-3 * deviation("half_width_sd_mm");
  surface.slope_sd = deviation("slope_sd");
  surface.decay_length_sd_m = 1e-3 * deviation("decay_length_sd_mm");
  surface.clamp_line_sd_m = 1e-3 * deviation("clamp_line_sd_mm");
  if (surface.clamp_line_sd_m > 0 && taper.decay_length_m)
    reader.problem("clamp_line_sd_mm", phrase("an exponential taper has no clamp line"),
                   phrase("use \"half_width_sd_mm\""));
  check_length(surface, reader);
  reader.finish();
}

/// Reads standard deviations, and the changes of the surface with temperature.
void read_deviations(core::TableReader& reader, Surface& surface) {
  const auto number = [&](const char* key) { return reader.maybe_number(key).value_or(0); };
  surface.tension_sd_Pa = number("tension_sd_Pa");
  surface.thickness_sd_m = 1e-3 * number("thickness_sd_mm");
  surface.density_sd_kg_m3 = number("density_sd_kg_m3");
  surface.modulus_sd_Pa = 1e9 * number("modulus_sd_GPa");
  surface.temperature_sd_K = number("temperature_sd_K");
  surface.quality_factor_sd = number("quality_factor_sd");
  if (surface.quality_factor_sd > 0 && !std::isfinite(surface.quality_factor))
    reader.problem("quality_factor_sd", phrase("\"quality_factor\" is inf: the surface is lossless"),
                   phrase("leave the standard deviation out"));
  const auto* filled = find_material(surface.material);
  surface.expansion_per_K =
      reader.maybe_number("expansion_per_K").value_or(filled ? filled->expansion_per_K : 0);
  surface.modulus_per_K = reader.maybe_number("modulus_per_K").value_or(filled ? filled->modulus_per_K : 0);
  if (surface.temperature_sd_K > 0 && surface.expansion_per_K == 0 && surface.modulus_per_K == 0)
    reader.problem("temperature_sd_K", phrase("nothing says how this surface changes with temperature"),
                   phrase("add \"expansion_per_K\" and \"modulus_per_K\""));
}

void read_plate_theory(core::TableReader& reader, Surface& surface) {
  const auto word = reader.word("plate_theory");
  surface.plate_theory = word == "kirchhoff" ? PlateTheory::kirchhoff
                         : word == "mindlin" ? PlateTheory::mindlin
                         : word == "elastic" ? PlateTheory::elastic
                                             : PlateTheory::automatic;
  const bool needed = word == "mindlin" || word == "elastic";
  const double poisson = surface.poisson.value_or(-1);
  if (needed && (surface.tension_Pa > 0 || surface.edges != Edges::clamped || poisson < 0 || poisson > 0.49))
    reader.problem("plate_theory", phrase("\"plate_theory\" is \"%1\" on this surface", {plain(word)}),
                   phrase("\"edges\" \"clamped\", \"tension_Pa\" 0 and \"poisson\" from 0 to 0.49 with it"));
}

}  // namespace

std::vector<std::string> materials() {
  std::vector<std::string> names;
  for (const auto& material : known_materials) names.emplace_back(material.name);
  return names;
}

Surface read_surface(const core::Value& table, core::TableReader& file) {
  core::TableReader reader(table, "surface", file.findings(), file.keys("surface"));
  Surface surface;
  read_material(reader, surface);
  surface.thickness_m = 1e-3 * reader.number("thickness_mm");
  surface.length_m = 1e-3 * reader.number("length_mm");
  surface.quality_factor = reader.number("quality_factor");
  surface.edges = reader.word("edges") == "clamped" ? Edges::clamped : Edges::supported;
  read_plate_theory(reader, surface);
  surface.wide_end = reader.word("wide_end") == "left" ? WideEnd::left : WideEnd::right;
  read_deviations(reader, surface);
  if (const auto* taper = reader.table("taper")) {
    core::TableReader inner(*taper, "surface.taper", file.findings(), reader.keys("taper"));
    read_taper(inner, surface);
  }
  reader.finish();
  return surface;
}

}  // namespace turnpoint::rig
