#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "station/core/number.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Findings;
using core::Range;
using core::TableReader;
using core::Value;
using Ends = Range::Ends;

namespace {

std::optional<Linear> read_linear(TableReader& reader, const std::string& key, const Reading& reading) {
  const auto* value = reader.take(key);
  return value ? linear_from(*value, key, reader.range(key), reading.protocol.factors, reader.findings())
               : std::nullopt;
}

Edge read_edge(TableReader& reader) {
  Edge edge;
  const auto* value = reader.require("edge");
  if (!value) return edge;
  if (value->kind != Value::Kind::table) {
    edge.name = reader.maybe_word("edge").value_or("");
    return edge;
  }
  TableReader inner(*value, reader.path("edge"), reader.findings(), reader.keys("edge"));
  edge.name = "friction";
  edge.friction = inner.number("friction");
  inner.finish();
  return edge;
}

SceneTone read_tone(const Value& table, const std::string& name, Findings& findings, const Reading& reading) {
  TableReader reader(table, name, findings, keys_of("scene.NAME.tones"));
  SceneTone tone;
  tone.boundary_mm = read_linear(reader, "boundary_mm", reading);
  tone.frequency_Hz = read_linear(reader, "frequency_Hz", reading);
  if (reader.has("boundary_mm")) tone.edge = read_edge(reader);
  reader.require("displacement_um");
  if (const auto displacement = read_linear(reader, "displacement_um", reading))
    tone.displacement_um = *displacement;
  tone.phase_deg = reader.maybe_number("phase_deg").value_or(0);
  reader.finish();
  return tone;
}

Zone read_zone(const Value& table, const std::string& name, Findings& findings, const Reading& reading) {
  TableReader reader(table, name, findings, keys_of("scene.NAME.zone"));
  Zone zone;
  zone.from_mm = reader.number("from_mm");
  reader.require("friction");
  zone.friction = read_linear(reader, "friction", reading);
  zone.tones = reader.integer("tones");
  reader.finish();
  return zone;
}

Tolerance read_tolerance(const Value& table, const std::string& name, Findings& findings) {
  TableReader reader(table, name, findings, keys_of("scene.NAME.tolerance"));
  Tolerance tolerance;
  tolerance.boundary_mm = reader.maybe_number("boundary_mm");
  tolerance.level_dB = reader.maybe_number("level_dB");
  tolerance.friction = reader.maybe_number("friction");
  reader.finish();
  return tolerance;
}

// Reports a displacement under a finger for which the position of the finger is missing.
void check_finger(TableReader& reader, const Scene& scene) {
  const bool wanted = reader.has("displacement_under_finger_um");
  if (wanted && !reader.has("finger_mm"))
    reader.problem("displacement_under_finger_um",
                   phrase("\"displacement_under_finger_um\" needs \"finger_mm\""),
                   phrase("say where the finger is, in mm from the wide end"));
  if (!wanted && reader.has("finger_mm"))
    reader.problem(
        "finger_mm", phrase("\"finger_mm\" needs \"displacement_under_finger_um\""),
        phrase("leave it out: \"displacement_um\" and \"friction\" are those of the free surface"));
  if (wanted && scene.edge.friction)
    reader.problem(
        "edge", phrase("an edge that friction defines is not allowed with \"displacement_under_finger_um\""),
        phrase("use an edge by name, or \"displacement_um\""));
}

// Checks that a scene is given in exactly one of the three possible forms.
void check_form(TableReader& reader, const Scene& scene, Findings& findings) {
  const auto form = phrase(
      "use one of three forms: one boundary (\"boundary_mm\", \"edge\" and \"displacement_um\" or "
      "\"friction\"), a \"zone\" with \"boundary_mm\" and \"edge\", or explicit \"tones\"");
  const bool tones = reader.has("tones"), zone = reader.has("zone"), boundary = reader.has("boundary_mm");
  if (!tones && !boundary)
    return findings.add(reader.place(), phrase("%1 presents nothing", {reader.title()}), form);
  if (tones) {
    for (const auto* key : {"boundary_mm", "edge", "zone", "displacement_um", "friction",
                            "displacement_under_finger_um", "finger_mm", "friction_contrast_dB"})
      if (reader.has(key))
        reader.problem(
            key, phrase("\"%1\" is not allowed together with \"tones\" in %2", {plain(key), reader.title()}),
            form);
    return;
  }
  std::vector<std::string> stated;
  for (const auto* key : {"displacement_um", "friction", "displacement_under_finger_um"})
    if (reader.has(key)) stated.emplace_back(key);
  if (zone) {
    for (const auto* key : {"displacement_um", "friction", "displacement_under_finger_um", "finger_mm"})
      if (reader.has(key))
        reader.problem(key, phrase("\"%1\" is not allowed together with \"%2\"", {plain(key), plain("zone")}),
                       phrase("set \"friction\" inside \"zone\" instead"));
  } else if (stated.size() != 1) {
    findings.add(stated.size() > 1 ? reader.place(stated[1]) : reader.place(),
                 stated.size() > 1 ? phrase("%1 has both \"%2\" and \"%3\"",
                                            {reader.title(), plain(stated[0]), plain(stated[1])})
                                   : phrase("%1 does not say how strong it is", {reader.title()}),
                 phrase("give exactly one of \"displacement_um\" (at the last maximum), \"friction\" and "
                        "\"displacement_under_finger_um\""));
  } else {
    check_finger(reader, scene);
  }
  if (scene.friction_contrast_dB && !zone && !reader.has("friction"))
    reader.problem("friction_contrast_dB",
                   phrase("\"friction_contrast_dB\" needs a base that states friction"),
                   phrase("use a base with \"friction\" or with a \"zone\""));
  if (scene.zone && scene.boundary_mm && scene.zone->from_mm) {
    const auto least = bounds(*scene.boundary_mm, {}).first;
    if (scene.boundary_mm->is_constant() && *scene.zone->from_mm >= least)
      reader.problem("zone",
                     phrase("the zone begins at %1 mm, beyond its boundary",
                            {plain(core::number(*scene.zone->from_mm))}),
                     phrase("\"from_mm\" must be less than \"boundary_mm\""));
  }
}

Scene read_scene(const Value& table, const std::string& name, const Value& own, Findings& findings,
                 const Reading& reading) {
  const std::string path = "scene." + name;
  TableReader reader(table, path, findings, keys_of("scene.NAME"));
  Scene scene;
  scene.name = name;
  scene.place = table.place;
  scene.base = reader.maybe_string("base").value_or("");
  scene.boundary_mm = read_linear(reader, "boundary_mm", reading);
  if (reader.has("boundary_mm")) scene.edge = read_edge(reader);
  scene.displacement_um = read_linear(reader, "displacement_um", reading);
  scene.friction = read_linear(reader, "friction", reading);
  scene.displacement_under_finger_um = read_linear(reader, "displacement_under_finger_um", reading);
  scene.finger_mm = read_linear(reader, "finger_mm", reading);
  for (const auto* tone : reader.tables("tones"))
    scene.tones.push_back(read_tone(*tone, path + ".tones", findings, reading));
  if (reader.has("tones") && scene.tones.empty())
    reader.problem("tones", phrase("\"tones\" has no tone"),
                   phrase("add at least one tone: %1", {plain("{ ... }")}));
  if (const auto* zone = reader.maybe_table("zone"))
    scene.zone = read_zone(*zone, path + ".zone", findings, reading);
  scene.friction_contrast_dB = read_linear(reader, "friction_contrast_dB", reading);
  if (own.find("friction_contrast_dB") && scene.base.empty())
    reader.problem("friction_contrast_dB", phrase("\"friction_contrast_dB\" needs a \"base\""),
                   phrase("name the scene whose friction is to be lowered"));
  scene.rove_dB = reader.number("rove_dB");
  scene.ramp_ms = reader.number("ramp_ms");
  if (const auto* tolerance = reader.maybe_table("tolerance"))
    scene.tolerance = read_tolerance(*tolerance, path + ".tolerance", findings);
  if (const auto* follow = reader.maybe_table("follow"))
    scene.follow = read_follow(*follow, path + ".follow", findings, reading);
  if (scene.follow && scene.rove_dB > 0)
    reader.problem("rove_dB", phrase("\"rove_dB\" has no effect in a scene that follows the finger"),
                   phrase("leave it out, or let a factor change the values of its parts"));
  check_form(reader, scene, findings);
  reader.finish();
  return scene;
}

void erase(Value& table, const std::string& key) {
  std::erase_if(table.entries, [&](const auto& entry) { return entry.key == key; });
}

// Returns the base scene's table with the scene's own keys added or replaced; `zone`, `tolerance` and
// `follow` are merged key by key.
Value laid_over(Value base, const Value& own) {
  const auto states = [&](const char* key) { return own.find(key) != nullptr; };
  const auto strengths = {"displacement_um", "friction", "displacement_under_finger_um"};
  if (std::any_of(strengths.begin(), strengths.end(), states)) {
    for (const auto* key : strengths) erase(base, key);
    if (!states("displacement_under_finger_um")) erase(base, "finger_mm");
  }
  // the three units of `follow`
  const auto units = {"friction", "coefficient", "displacement_um"};
  if (base.find("parts") && std::any_of(units.begin(), units.end(), states))
    for (const auto* key : units) erase(base, key);
  if (states("tones"))
    for (const auto* key : {"boundary_mm", "edge", "zone", "displacement_um", "friction",
                            "displacement_under_finger_um", "finger_mm"})
      erase(base, key);
  if (states("boundary_mm") || states("zone")) erase(base, "tones");
  for (const auto& entry : own.entries) {
    const auto* below = base.find(entry.key);
    const bool tables =
        below && below->value.kind == Value::Kind::table && entry.value.kind == Value::Kind::table;
    auto merged = entry;
    if (tables && (entry.key == "zone" || entry.key == "tolerance" || entry.key == "follow"))
      merged.value = laid_over(below->value, entry.value);
    erase(base, entry.key);
    base.entries.push_back(std::move(merged));
  }
  base.place = own.place;
  return base;
}

class Resolver {
 public:
  Resolver(const Value& scenes, Reading& reading) : scenes_(scenes), reading_(reading) {}

  /// Returns the scene's table merged with its base scene's, and reads it. Reads the base scenes first.
  /// Returns nullptr if a base scene does not exist or depends on itself.
  const Value* resolve(const std::string& name) {
    if (const auto done = resolved_.find(name); done != resolved_.end()) return &done->second;
    const auto& own = scenes_.find(name)->value;
    open_.insert(name);
    auto table = own;
    if (const auto* base = own.find("base"); base && base->value.kind == Value::Kind::string) {
      const auto* below = base_of(name, base->value);
      if (!below) return open_.erase(name), nullptr;
      if (own.find("friction_contrast_dB") && below->find("friction_contrast_dB"))
        reading_.findings.add(
            base->value.place,
            phrase("the base \"%1\" has a friction contrast itself", {plain(base->value.string)}),
            phrase("use a base without \"friction_contrast_dB\""));
      if (own.find("friction_contrast_dB") && (own.find("zone") || own.find("friction")))
        reading_.findings.add(own.find("friction_contrast_dB")->place,
                              phrase("the scene has both a contrast to its base and its own friction"),
                              phrase("remove one of the two"));
      table = laid_over(*below, own);
    }
    open_.erase(name);
    read(name, table, own);
    return &(resolved_[name] = std::move(table));
  }

 private:
  const Value* base_of(const std::string& name, const Value& base) {
    std::vector<std::string> others;
    for (const auto& entry : scenes_.entries)
      if (entry.key != name) others.push_back(entry.key);
    if (open_.count(base.string)) {
      reading_.findings.add(base.place, phrase("the bases of \"%1\" run in a circle", {plain(name)}),
                            phrase("use a base that does not depend on this scene"));
      return nullptr;
    }
    const auto* found = scenes_.find(base.string);
    if (found && found->value.kind == Value::Kind::table) return resolve(base.string);
    reading_.findings.add(base.place, phrase("unknown scene \"%1\"", {plain(base.string)}),
                          core::suggestion(base.string, others));
    return nullptr;
  }

  // If a base scene contains a mistake, every scene that builds on it contains the mistake too. So report
  // only one problem for each place in the file.
  void read(const std::string& name, const Value& table, const Value& own) {
    Findings found;
    auto scene = read_scene(table, name, own, found, reading_);
    if (scene.zone) {
      const auto base = reading_.protocol.scenes.find(scene.base);
      const bool below = base != reading_.protocol.scenes.end() && base->second.zone;
      scene.zone->design_friction = below ? base->second.zone->friction : scene.zone->friction;
    }
    for (auto& problem : found.problems)
      if (places_.insert({problem.place.line, problem.place.column}).second)
        reading_.findings.problems.push_back(std::move(problem));
    auto& defaults = reading_.findings.defaults_used;
    defaults.insert(defaults.end(), found.defaults_used.begin(), found.defaults_used.end());
    reading_.protocol.scenes.emplace(name, std::move(scene));
  }

  const Value& scenes_;
  Reading& reading_;
  std::map<std::string, Value> resolved_;
  std::set<std::string> open_;
  std::set<std::pair<int, int>> places_;
};

}  // namespace

void read_scenes(TableReader& file, Reading& reading) {
  const auto* scenes = file.table("scene");
  if (!scenes) return;
  for (const auto& entry : scenes->entries) reading.declared_scenes.push_back(entry.key);
  Resolver resolver(*scenes, reading);
  for (const auto& entry : scenes->entries) {
    if (entry.value.kind == Value::Kind::table)
      resolver.resolve(entry.key);
    else
      reading.findings.add(entry.place,
                           phrase("\"scene.%1\" is %2", {plain(entry.key), describe(entry.value)}),
                           phrase("write a table %1", {plain("[scene.NAME]")}));
  }
}

}  // namespace turnpoint::protocol
