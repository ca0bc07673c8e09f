#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using texts::phrase, texts::plain;

using text::Range;
using text::TableReader;

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
  TableReader reader(*table, "sensing", reading.findings);
  auto& sensing = reading.protocol.sensing.emplace();
  sensing.place = table->place;
  sensing.normal_N = reader.maybe_interval("normal_N", {0.1, 5, Range::Ends::closed, "N"});
  sensing.speed_mm_s = reader.maybe_interval("speed_mm_s", {10, 1000, Range::Ends::closed, "mm/s"});
  sensing.fraction = reader.number("fraction", {0, 1, Range::Ends::open_low}, 0.8);
  sensing.strokes = reader.integer("strokes", 1, 100, 2);
  const auto outside = reader.word("outside", {"mark", "repeat"}, "mark");
  if (outside == "repeat")
    sensing.repeats = reader.integer("repeats", 1, 10, 2);
  else if (reader.maybe_integer("repeats", 1, 10))
    reader.problem("repeats", phrase("\"%1\" has no effect", {plain("repeats")}),
                   phrase("%1, or leave \"repeats\" out", {plain("outside = \"repeat\"")}));
  if (reading.protocol.task.kind == TaskKind::adjustment && sensing.repeats > 0)
    reader.problem("outside", phrase("an adjustment is not presented again"), plain("outside = \"mark\""));
  sensing.guidance = reader.boolean("guidance", "false");
  if (sensing.guidance && !sensing.normal_N && !sensing.speed_mm_s)
    reader.problem("guidance", phrase("there is nothing to guide to"),
                   phrase("add \"normal_N\" or \"speed_mm_s\""));
  if (sensing.guidance)
    sensing.live_guidance = reader.boolean("live_guidance", "false");
  else if (reader.take("live_guidance"))
    reader.problem("live_guidance", phrase("\"%1\" has no effect", {plain("live_guidance")}),
                   plain("guidance = true"));
  reader.finish();
}

}  // namespace turnpoint::protocol
