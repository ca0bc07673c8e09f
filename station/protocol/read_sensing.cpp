#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using text::Range;
using text::TableReader;

void read_sensing(TableReader& file, Reading& reading) {
  const auto* table = file.maybe_table("sensing");
  if (!table) return;
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
    reader.problem("repeats", "\"repeats\" has no effect", "outside = \"repeat\", or leave \"repeats\" out");
  if (reading.protocol.task.kind == TaskKind::adjustment && sensing.repeats > 0)
    reader.problem("outside", "an adjustment is not presented again", "outside = \"mark\"");
  reader.finish();
}

}  // namespace turnpoint::protocol
