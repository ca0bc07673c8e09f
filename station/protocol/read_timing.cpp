#include <map>

#include "station/protocol/expression.hpp"
#include "station/protocol/reading.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::TableReader;
using core::Value;

namespace {

void read_buzz(TableReader& reader, ResponseSignal& signal, const Reading& reading) {
  if (signal.by != ResponseSignal::By::buzz) return;
  signal.scene = read_scene_name(reader, "scene", reading);
  signal.length_s = 1e-3 * reader.number("length_ms");
}

void read_signal(TableReader& timing, Reading& reading) {
  const auto* table = timing.maybe_table("response_signal");
  if (!table) return;
  TableReader reader(*table, "timing.response_signal", reading.findings, timing.keys("response_signal"));
  ResponseSignal signal;
  reader.require(
      "after_s",
      phrase("say when the signal comes, in seconds after response_zero: a number, or a factor in quotes"));
  if (const auto after = read_expression(reader, "after_s", reading)) signal.after_s = *after;
  signal.window_s = reader.number("window_s");
  using By = ResponseSignal::By;
  static const std::map<std::string, By> kinds{
      {"screen", By::screen}, {"flash", By::flash}, {"tone", By::tone}, {"buzz", By::buzz}};
  if (const auto by = reader.maybe_word("by"); by && kinds.count(*by)) signal.by = kinds.at(*by);
  signal.by_place = reader.place("by");
  read_buzz(reader, signal, reading);
  reader.finish();
  reading.protocol.timing.signal = signal;
}

}  // namespace

void read_timing(TableReader& file, Reading& reading) {
  const auto* table = file.table("timing");
  if (!table) return;
  TableReader reader(*table, "timing", reading.findings, file.keys("timing"));
  auto& timing = reading.protocol.timing;
  const auto zero = reader.word("response_zero");
  timing.response_zero_place = reader.place("response_zero");
  for (const auto known : core::response_zeros)
    if (zero == name(known)) timing.response_zero = known;
  timing.explore_s = reader.maybe_number("explore_s");
  read_signal(reader, reading);
  timing.deadline_s = read_expression(reader, "deadline_s", reading);
  reader.require("iti_s");
  timing.iti_s = read_distribution(reader, "iti_s", reading).value_or(Distribution{1, 1, {}});
  if (const auto* delays = reader.maybe_table("delay_s")) {
    TableReader inner(*delays, "timing.delay_s", reading.findings, reader.keys("delay_s"));
    for (const auto& [key, delay] : {std::pair{"wrong", &timing.delay_s.wrong},
                                     {"late", &timing.delay_s.late},
                                     {"early", &timing.delay_s.early}})
      *delay = read_expression(inner, key, reading).value_or(Linear{});
    inner.finish();
  }
  if (!timing.signal && !reader.has("anticipation_s")) reader.defaulted("anticipation_s", "0");
  timing.anticipation_s = read_expression(reader, "anticipation_s", reading).value_or(Linear{});
  reader.finish();
}

void read_payoff(TableReader& file, Reading& reading) {
  const auto* table = file.maybe_table("payoff");
  if (!table) return;
  TableReader reader(*table, "payoff", reading.findings, file.keys("payoff"));
  Payoff payoff;
  reader.require("right");
  for (const auto& [key, points] : {std::pair{"right", &payoff.right},
                                    {"wrong", &payoff.wrong},
                                    {"late", &payoff.late},
                                    {"early", &payoff.early},
                                    {"unsure", &payoff.unsure}})
    *points = read_expression(reader, key, reading).value_or(Linear{});
  if (const auto* fast = reader.maybe_table("fast")) {
    TableReader inner(*fast, "payoff.fast", reading.findings, reader.keys("fast"));
    for (const auto* key : {"below_s", "points"}) inner.require(key);
    payoff.fast = Payoff::Fast{read_expression(inner, "below_s", reading).value_or(Linear{}),
                               read_expression(inner, "points", reading).value_or(Linear{})};
    inner.finish();
  }
  if (const auto* text = reader.take("text")) {
    payoff.text = localised_from(*text, "text", reading);
    for (const auto& [language, words] : payoff.text)
      if (words.find("%1") == std::string::npos)
        reader.problem("text",
                       phrase("the text in \"%1\" does not say where the number is", {plain(language)}),
                       phrase("write %1 in its place: \"You have earned € %1\"", {plain("%1")}));
  }
  payoff.worth = reader.number("worth");
  payoff.decimals = reader.integer("decimals");
  reader.finish();
  reading.protocol.payoff = std::move(payoff);
}

void read_instructions(TableReader& file, Reading& reading) {
  const auto* tables = file.maybe_table("instructions");
  if (!tables) return;
  for (const auto& entry : tables->entries) {
    if (entry.value.kind != Value::Kind::table) {
      reading.findings.add(entry.place,
                           phrase("\"instructions.%1\" is %2", {plain(entry.key), describe(entry.value)}),
                           phrase("write a table %1", {plain("[instructions.NAME]")}));
      continue;
    }
    TableReader reader(entry.value, "instructions." + entry.key, reading.findings,
                       keys_of("instructions.NAME"));
    Instruction instruction;
    instruction.text = read_localised(reader, "text", reading);
    if (const auto* late = reader.take("late_message"))
      instruction.late_message = localised_from(*late, "late_message", reading);
    instruction.deadline_s = read_expression(reader, "deadline_s", reading);
    instruction.target_accuracy = reader.maybe_interval("target_accuracy");
    if (const auto* table = reader.maybe_table("goal")) {
      TableReader inner(*table, "instructions." + entry.key + ".goal", reading.findings, reader.keys("goal"));
      instruction.goal =
          Goal{inner.maybe_number("accuracy_above"), inner.maybe_number("median_time_below_s")};
      inner.finish();
    }
    reader.finish();
    reading.protocol.instructions.emplace(entry.key, std::move(instruction));
  }
}

}  // namespace turnpoint::protocol
