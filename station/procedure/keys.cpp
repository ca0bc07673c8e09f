#include "station/procedure/keys.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::procedure {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;

namespace {

void read_max_run(TableReader& order, Spec& spec) {
  const auto* table = order.take("max_run");
  if (!table || table->kind != core::Value::Kind::table) {
    if (const auto limit = order.maybe_integer("max_run")) spec.max_run[kRightAnswer] = *limit;
    return;
  }
  TableReader inner(*table, order.path("max_run"), order.findings(), order.keys("max_run"));
  for (const auto& entry : table->entries)
    if (const auto limit = inner.maybe_integer(entry.key, 1, 1000)) spec.max_run[entry.key] = *limit;
  inner.finish();
}

void read_order(TableReader& reader, Spec& spec) {
  const auto* table = reader.maybe_table("order");
  if (!table) {
    if (!reader.has("order")) reader.defaulted("order.shuffle", "\"within-repeat\"");
    return;
  }
  TableReader inner(*table, reader.path("order"), reader.findings(), reader.keys("order"));
  spec.after_each_other = inner.maybe_strings("after_each_other");
  if (inner.has("after_each_other")) spec.back = inner.integer("back");
  if (const auto* never = inner.maybe_table("never_after")) spec.never_after = *never;
  const auto shuffle = inner.has("after_each_other") ? "within-block" : inner.word("shuffle");
  spec.shuffle = shuffle == "none"           ? Shuffle::none
                 : shuffle == "within-block" ? Shuffle::within_block
                                             : Shuffle::within_repeat;
  read_max_run(inner, spec);
  inner.finish();
}

}  // namespace

void read_runs(TableReader& reader, Spec& spec) {
  const auto* table = reader.maybe_table("order");
  if (!table) return;
  TableReader inner(*table, reader.path("order"), reader.findings(), reader.keys("order"));
  read_max_run(inner, spec);
  inner.finish();
}

void read_tracks(TableReader& reader, Spec& spec) {
  spec.tracks = reader.maybe_string("tracks").value_or("");
}

void read_scale(TableReader& reader, Spec& spec) {
  const auto scale = reader.word("scale");
  spec.scale = scale == "log10" ? Scale::log10 : scale == "dB" ? Scale::dB : Scale::linear;
}

void read_stop(TableReader& reader, Spec& spec) {
  const auto* table = reader.table("stop");
  if (!table) return;
  TableReader inner(*table, reader.path("stop"), reader.findings(), reader.keys("stop"));
  spec.stop.trials = inner.maybe_integer("trials");
  spec.stop.reversals = inner.maybe_integer("reversals");
  spec.stop.min_trials = inner.maybe_integer("min_trials");
  spec.stop.threshold_sd = inner.maybe_number("threshold_sd");
  spec.stop.entropy_nats = inner.maybe_number("entropy_nats");
  spec.stop.max_trials = inner.maybe_integer("max_trials");
  if (spec.stop.max_trials &&
      *spec.stop.max_trials < std::max(spec.stop.trials.value_or(0), spec.stop.min_trials.value_or(0)))
    inner.problem("max_trials", phrase("\"max_trials\" is smaller than another rule asks for"),
                  phrase("at least %1",
                         {plain(std::max(spec.stop.trials.value_or(0), spec.stop.min_trials.value_or(0)))}));
  if (spec.start) spec.stop.limit_steps = inner.maybe_integer("limit_steps");
  read_right_of_last(inner, spec);
  const int rules = inner.has("right") + inner.has("trials") + inner.has("reversals") +
                    inner.has("threshold_sd") + inner.has("entropy_nats");
  if (rules == 0)
    reader.findings().add(
        table->place, phrase("\"stop\" does not contain a stopping rule"),
        phrase("add \"trials\", \"reversals\", \"threshold_sd\", \"entropy_nats\" or \"right\""));
  if (rules > 1 && !inner.has("rule"))
    reader.findings().add(table->place, phrase("\"stop\" contains several stopping rules"),
                          phrase("add %1 (any of them ends the procedure) or %2 (all must be met)",
                                 {plain("rule = \"or\""), plain("rule = \"and\"")}));
  spec.stop.rule = inner.maybe_word("rule").value_or("or") == "and" ? StopRule::all : StopRule::any;
  inner.finish();
}

void read_right_of_last(TableReader& stop, Spec& spec) {
  spec.stop.right = stop.maybe_integer("right");
  spec.stop.of_last = stop.maybe_integer("of_last");
  if (spec.stop.right && spec.stop.of_last && *spec.stop.right > *spec.stop.of_last)
    stop.problem("right", phrase("more right answers than answers"), phrase("at most \"of_last\""));
  if (!spec.stop.right || !spec.stop.of_last) spec.stop.right.reset(), spec.stop.of_last.reset();
}

void read_list(TableReader& reader, Spec& spec) {
  spec.repeats = reader.integer("repeats");
  spec.balance = reader.maybe_strings("balance");
  read_order(reader, spec);
}

void read_span(TableReader& reader, Spec& spec) {
  spec.start = reader.number("start");
  spec.min = reader.number("min");
  spec.max = reader.number("max");
}

void validate_span(const Spec& spec, std::vector<Problem>& problems) {
  if (!spec.start)
    problems.push_back({"start", plain("missing"), phrase("write the first level as a number")});
  if (spec.min && spec.max && *spec.min >= *spec.max)
    problems.push_back({"min", phrase("\"min\" is not less than \"max\""), plain("min < max")});
  if (spec.start && ((spec.min && *spec.start < *spec.min) || (spec.max && *spec.start > *spec.max)))
    problems.push_back({"start", phrase("the first level is not between min and max"),
                        phrase("write a level between min and max")});
  if (spec.scale != Scale::linear && spec.start && !(*spec.start > 0))
    problems.push_back({"start", phrase("on a logarithmic scale the first level must be above 0"),
                        phrase("write a level above 0")});
}

bool positive(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v > 0 && std::isfinite(v); });
}

}  // namespace turnpoint::procedure
