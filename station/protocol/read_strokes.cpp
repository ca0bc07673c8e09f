#include <algorithm>

#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::TableReader;

namespace {

void read_training(TableReader& reader, Block& block, const Reading& reading) {
  block.kind = BlockKind::training;
  block.trials = reader.integer("strokes");
  const auto* table = reader.maybe_table("pass");
  if (!table) return;
  TableReader inner(*table, reader.path("pass"), reading.findings, reader.keys("pass"));
  const int strokes = inner.integer("strokes", 1, *block.trials);
  block.pass = Pass{static_cast<double>(strokes) / *block.trials, inner.integer("retries")};
  inner.finish();
}

/// Checks that the block's scene contains no factors, because the scene is the same in every trial.
void check_scene(TableReader& reader, const Block& block, const Reading& reading) {
  const auto& scenes = reading.protocol.scenes;
  const auto found = scenes.find(block.strokes.scene);
  if (found == scenes.end()) {
    std::vector<std::string> known;
    for (const auto& [name, scene] : scenes) known.push_back(name);
    // If the scene could not be read, that has been reported already.
    const auto& declared = reading.declared_scenes;
    if (!block.strokes.scene.empty() &&
        std::find(declared.begin(), declared.end(), block.strokes.scene) == declared.end())
      reader.problem("scene", phrase("there is no [scene.%1]", {plain(block.strokes.scene)}),
                     core::suggestion(block.strokes.scene, known));
    return;
  }
  const auto expressions = expressions_of(found->second);
  if (std::any_of(expressions.begin(), expressions.end(),
                  [](const Linear* expression) { return !expression->is_constant(); }))
    reader.problem("scene", phrase("the scene \"%1\" depends on factors", {plain(block.strokes.scene)}),
                   phrase("a friction table needs a scene without factors"));
}

void read_friction_table(TableReader& reader, Block& block, const Reading& reading) {
  block.kind = BlockKind::friction_table;
  auto& strokes = block.strokes;
  strokes.scene = reader.string("scene");
  check_scene(reader, block, reading);
  strokes.from_mm = reader.number("from_mm");
  strokes.to_mm = reader.number("to_mm");
  if (strokes.to_mm < strokes.from_mm + 20)
    reader.problem("to_mm", phrase("the part of the surface is shorter than 20 mm"),
                   plain("to_mm >= from_mm + 20"));
  strokes.levels_um = reader.numbers("displacement_um");
  if (std::adjacent_find(strokes.levels_um.begin(), strokes.levels_um.end(), std::greater_equal<>()) !=
      strokes.levels_um.end())
    reader.problem("displacement_um", phrase("the displacements are not in ascending order"),
                   phrase("list each displacement once, the smallest first"));
  strokes.repeats = reader.integer("repeats");
  strokes.used = reader.boolean("use");
  block.trials = 2 * static_cast<int>(strokes.levels_um.size()) * strokes.repeats + 1;
}

}  // namespace

void read_strokes(TableReader& reader, const std::string& kind, Block& block, const Reading& reading) {
  block.place = reader.place();
  block.practice = true;
  block.strokes.duration_s = reader.number("duration_s");
  if (kind == "training")
    read_training(reader, block, reading);
  else
    read_friction_table(reader, block, reading);
  read_break(reader, block, reading);
}

}  // namespace turnpoint::protocol
