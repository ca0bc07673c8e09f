#include <algorithm>

#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::TableReader;

void read_sensing(TableReader& file, Reading& reading) {
  const auto* table = file.maybe_table("sensing");
  if (!table) {
    for (const auto& part : reading.protocol.plan)
      if (const auto* block = std::get_if<Block>(&part); block && block->kind != BlockKind::trials)
        reading.findings.add(block->place,
                             phrase("the block \"%1\" needs a [sensing] table", {plain(block->name)}),
                             phrase("add [sensing] with the movement to make"));
    return;
  }
  TableReader reader(*table, "sensing", reading.findings, file.keys("sensing"));
  auto& sensing = reading.protocol.sensing.emplace();
  sensing.place = table->place;
  sensing.normal_N = reader.maybe_interval("normal_N");
  sensing.speed_mm_s = reader.maybe_interval("speed_mm_s");
  sensing.fraction = reader.number("fraction");
  sensing.strokes = reader.integer("strokes");
  const auto outside = reader.word("outside");
  if (outside == "repeat") sensing.repeats = reader.integer("repeats");
  const auto all = as_tasks_see(reading);
  const bool adjusts = std::any_of(all.begin(), all.end(),
                                   [](const Protocol& one) { return one.task.kind == TaskKind::adjustment; });
  if (adjusts && sensing.repeats > 0)
    reader.problem("outside", phrase("an adjustment is not presented again"), plain("outside = \"mark\""));
  sensing.guidance = reader.boolean("guidance");
  if (sensing.guidance && !sensing.normal_N && !sensing.speed_mm_s)
    reader.problem("guidance", phrase("there is nothing to guide to"),
                   phrase("add \"normal_N\" or \"speed_mm_s\""));
  if (sensing.guidance) sensing.live_guidance = reader.boolean("live_guidance");
  reader.finish();
}

}  // namespace turnpoint::protocol
