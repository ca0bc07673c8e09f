#include "station/procedure/keys.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::procedure {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;

namespace {

core::Keys stop_rules() {
  using namespace core::key;
  return {
      integer("trials", 1, 100000, "ends after so many trials"),
      integer("reversals", 1, 10000, "ends after so many reversals"),
      integer("min_trials", 1, 100000, "but not before so many trials"),
      integer("max_trials", 1, 100000, "but in any case after so many trials")
          .without_it(
              "400, or four times what the rules ask for if that is more (10 trials for each reversal)"),
      number("threshold_sd", positive_step,
             "QUEST+, psi and others with a posterior: ends when the threshold's standard deviation is at "
             "most this"),
      number("entropy_nats", {-100, 100}, "the same for the entropy of the posterior")};
}

core::Key stop_table(core::Keys rules) {
  rules.and_also(right_of_last_keys());
  rules.list.push_back(core::key::word("rule", {"or", "and"}, "whether one of several rules is enough")
                           .without_it("needed with several rules"));
  return core::key::table("stop", std::move(rules), "when it ends").required();
}

core::Key max_run_key() {
  using namespace core::key;
  return several(
      "max_run",
      {integer("", 1, 1000, ""), table("",
                                       core::Keys{}.with_free_names(integer(
                                           "FACTOR", 1, 1000, "longest run of one value of this factor")),
                                       "")},
      "most trials in a row with the same right answer; or with the same value of each named factor");
}

core::Key order_table(const core::Keys& keys) {
  return core::key::table("order", keys, "the order of the trials");
}

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

core::Key scale_key() {
  return core::key::word(
             "scale", {"linear", "log10", "dB"},
             "on which scale steps are counted, and level and threshold compared: \"linear\" for differences "
             "(also of levels in dB), else for ratios")
      .by_default("\"linear\"");
}

core::Key stop_key() { return stop_table(stop_rules()); }

core::Key track_stop_key() {
  return stop_table(stop_rules().and_also(
      {core::key::integer("limit_steps", 1, 1000, "ends after so many steps in a row that min or max refuses")
           .by_default("10")}));
}

core::Keys right_of_last_keys() {
  using namespace core::key;
  return {
      integer("right", 1, 1000, "ends as soon as so many answers were right (or those that it tracks) ...")
          .only_with("of_last"),
      integer("of_last", 1, 1000, "... of so many last ones; suits training").only_with("right")};
}

core::Key tracks_key() {
  return core::key::string("tracks", "id of the answer that it follows instead of correctness");
}

core::Keys list_keys() {
  using namespace core::key;
  return {
      integer("repeats", 1, 10000, "how often each level is presented").required(),
      strings("balance",
              "factors whose levels are combined equally often with each level (and with each other)")
          .holding(0),
      order_table(
          {word("shuffle", {"within-repeat", "within-block", "none"}, "among which trials the order is drawn")
               .by_default("\"within-repeat\"")
               .only_without("after_each_other"),
           strings("after_each_other",
                   "factors of which each combination of values comes equally often after each other "
                   "one; the level, or those of \"balance\""),
           integer("back", 1, 5,
                   "how many trials back that holds: 2 for each value after each pair of values")
               .by_default("1")
               .only_with("after_each_other"),
           table("never_after",
                 core::Keys{}.with_free_names(
                     list("FACTOR", {numbers("", any_level, "").holding(2, 2), strings("", "").holding(2, 2)},
                          "pairs of its values")),
                 "pairs of values, of which the second never comes right after the first"),
           max_run_key()})};
}

core::Key runs_key() { return order_table({max_run_key()}); }

core::Keys range_keys() {
  using namespace core::key;
  return {number("min", any_level, "lowest level").required(),
          number("max", any_level, "highest level").required()};
}

core::Keys span_keys() {
  core::Keys keys{core::key::number("start", any_level, "the first level").required()};
  return keys.and_also(range_keys());
}

core::Key step_key() { return core::key::number("step", positive_step, "the step").required(); }

core::Key target_key() {
  return core::key::number("target", {0, 1, Range::Ends::open},
                           "proportion of right answers (or of those that it tracks) on which it converges")
      .required();
}

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
