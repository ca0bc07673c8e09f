#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "station/core/number.hpp"
#include "station/core/parts.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/orders.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Range;
using core::TableReader;
using core::Value;

namespace {

/// A kind of task, with the smallest and the largest number of choices that it can have.
struct TaskForm {
  const char* name;
  TaskKind kind;
  std::size_t fewest, most;
};
constexpr TaskForm task_forms[] = {{"single-interval", TaskKind::single_interval, 2, most_choices},
                                   {"2ifc", TaskKind::two_interval, 2, 2},
                                   {"3ifc", TaskKind::several_intervals, 3, 3},
                                   {"4ifc", TaskKind::several_intervals, 4, 4},
                                   {"same-different", TaskKind::same_different, 2, 2},
                                   {"oddity", TaskKind::oddity, 3, 3},
                                   {"abx", TaskKind::abx, 2, 2},
                                   {"match-to-sample", TaskKind::match_to_sample, 2, 2},
                                   {"comparison", TaskKind::comparison, 2, 2},
                                   {"adjustment", TaskKind::adjustment, 1, 1}};

/// True if the task presents a `standard` and a `target`.
bool compares(TaskKind kind) {
  return kind != TaskKind::single_interval && kind != TaskKind::two_interval &&
         kind != TaskKind::comparison && kind != TaskKind::adjustment;
}

/// Reports a name that is neither that of a scene nor that of parts.
void check_scene(const std::string& name, const core::Place& place, const Reading& reading) {
  auto known = reading.declared_scenes;
  for (const auto& [parts, list] : reading.protocol.task.parts) known.push_back(parts);
  if (std::find(known.begin(), known.end(), name) == known.end())
    reading.findings.add(place, phrase("unknown scene \"%1\"", {plain(name)}), core::suggestion(name, known));
}

std::vector<std::string> read_interval(const Value& item, const Reading& reading) {
  std::vector<std::string> scenes;
  const auto one = [&](const Value& value) {
    if (value.kind != Value::Kind::string)
      return reading.findings.add(value.place, phrase("an interval holds %1", {describe(value)}),
                                  phrase("write the name of a scene in quotes"));
    check_scene(value.string, value.place, reading);
    if (item.kind == Value::Kind::array && item.items.size() > 1 &&
        reading.protocol.task.parts.count(value.string))
      reading.findings.add(
          value.place,
          phrase("\"%1\" has several parts, so it cannot be one of two scenes", {plain(value.string)}),
          phrase("write its name alone, or name a scene"));
    scenes.push_back(value.string);
  };
  if (item.kind != Value::Kind::array)
    one(item);
  else
    for (const auto& value : item.items) one(value);
  if (item.kind == Value::Kind::array && item.items.size() != 1 && item.items.size() != 2)
    reading.findings.add(
        item.place, phrase("an interval has %1 scenes", {plain(item.items.size())}),
        phrase("an interval must have one scene, or two scenes with a foreperiod before the second"));
  return scenes;
}

/// Reads a length. One that could not be read, which has been reported, is 1 s for what depends on it.
std::optional<Linear> read_length(TableReader& reader, const Reading& reading) {
  auto length = read_expression(reader, "duration_s", reading);
  if (!length && reader.has("duration_s")) {
    length.emplace();
    length->constant = 1;
  }
  return length;
}

/// Reads a list of parts. A silence belongs to the scene after it; those after the last scene go to `after`.
std::vector<Part> read_part_list(const core::Value& list, const std::string& path, const Reading& reading,
                                 std::vector<Linear>& after) {
  std::vector<Part> parts;
  for (const auto& item : list.items) {
    if (item.kind != Value::Kind::table) {
      reading.findings.add(item.place, phrase("a part is %1", {describe(item)}),
                           phrase("write %1 or %2", {plain("{ scene = \"edge\", duration_s = 1.0 }"),
                                                     plain("{ silence_s = 0.3 }")}));
      continue;
    }
    TableReader reader(item, path, reading.findings, keys_of("task.parts.NAME"));
    if (reader.has("silence_s")) {
      if (auto silence_s = read_expression(reader, "silence_s", reading))
        after.push_back(std::move(*silence_s));
    } else if (reader.require("scene")) {
      Part part{{read_scene_name(reader, "scene", reading)}, {}, {}, std::exchange(after, {})};
      part.duration_s = read_length(reader, reading);
      part.first_s = reader.maybe_number("first_s");
      parts.push_back(std::move(part));
    }
    reader.finish();
  }
  return parts;
}

bool is_silence(const core::Value& item) { return item.find("silence_s") != nullptr; }

/// Reads the parts of an interval, which begins and ends with a scene.
std::vector<Part> read_interval_parts(const core::Value& list, const std::string& name,
                                      const Reading& reading) {
  std::vector<Linear> after;
  auto parts = read_part_list(list, key_of(reading.protocol.task, "parts." + name), reading, after);
  if (!list.items.empty() && (is_silence(list.items.front()) || is_silence(list.items.back())))
    reading.findings.add(is_silence(list.items.front()) ? list.items.front().place : list.items.back().place,
                         phrase("\"%1\" begins or ends with a silence", {plain(name)}),
                         phrase("silences stand between scenes; use \"gap_s\" between two intervals"));
  if (list.items.empty())
    reading.findings.add(list.place, phrase("\"%1\" has no parts", {plain(name)}),
                         phrase("write a list of parts: %1", {plain("[{ scene = \"edge\" }]")}));
  return parts;
}

/// Reads what a trial presents before its first interval. It begins with a scene; the silence at its end is
/// that before the interval.
void read_before(TableReader& reader, Task& task, const Reading& reading) {
  const auto* list = reader.take("before");
  if (!list) return;
  if (list->kind != Value::Kind::array)
    return reader.problem(
        "before", phrase("\"%1\" is %2", {plain("before"), describe(*list)}),
        phrase("write a list of parts: %1",
               {plain("[{ scene = \"adaptor\", duration_s = 5.0 }, { silence_s = 0.5 }]")}));
  task.before =
      read_part_list(*list, key_of(reading.protocol.task, "before"), reading, task.before_silences_s);
  if (list->items.empty() || is_silence(list->items.front()))
    reader.problem("before", phrase("\"before\" begins with no scene"),
                   phrase("write a scene first, or leave \"before\" out"));
  for (std::size_t i = 0; i < task.before.size(); ++i)
    if (!task.before[i].duration_s)
      reader.problem("before", phrase("part %1 of \"%2\" has no length", {plain(i + 1), plain("before")}),
                     phrase("give it \"duration_s\""));
}

void read_parts(TableReader& reader, Task& task, const Reading& reading) {
  const auto* table = reader.maybe_table("parts");
  if (!table) return;
  const auto& scenes = reading.declared_scenes;
  for (const auto& entry : table->entries) {
    if (std::find(scenes.begin(), scenes.end(), entry.key) != scenes.end())
      reading.findings.add(entry.place, phrase("there is already a scene \"%1\"", {plain(entry.key)}),
                           phrase("give the parts another name"));
    if (entry.value.kind == Value::Kind::array)
      task.parts[entry.key] = read_interval_parts(entry.value, entry.key, reading);
    else
      reading.findings.add(entry.value.place,
                           phrase("\"%1\" is %2", {plain(entry.key), describe(entry.value)}),
                           phrase("write a list of parts: %1",
                                  {plain("[{ scene = \"a\" }, { silence_s = 0.3 }, { scene = \"b\" }]")}));
  }
}

/// The factor that the slider moves changes only the last part, so no time may depend on it.
void check_slider_times(const Task& task, const Reading& reading) {
  for (const auto& time : stimulus_times(task))
    for (const auto& name : factors_in(time))
      if (name == task.adjusts)
        reading.findings.add(time.place,
                             phrase("a time depends on \"%1\", which the slider moves", {plain(name)}),
                             phrase("use another factor"));
}

/// The largest number of parts that a trial can have.
std::size_t most_parts_of_trial(const Task& task, const TaskForm& kind) {
  if (!compares(task.kind)) {
    auto intervals = task.intervals;
    if (!task.standard.empty()) intervals.push_back({task.standard});
    std::size_t sum = task.before.size();
    for (const auto& interval : intervals) sum += parts_of(task, interval).size();
    return sum;
  }
  const bool of_two = task.kind == TaskKind::same_different;
  const bool of_three = task.kind == TaskKind::abx || task.kind == TaskKind::match_to_sample;
  const std::size_t intervals = of_two ? 2 : of_three ? 3 : kind.most;
  return task.before.size() +
         intervals * std::max(parts_of(task, {task.standard}).size(), parts_of(task, {task.target}).size());
}

/// Where the intervals are presented in a random order, the place of the longest adaptor must not tell which
/// is which: then all intervals have the same first_s at the same parts.
void check_first(const Task& task, const Reading& reading) {
  std::set<std::vector<std::string>> intervals;
  for (const auto& order : orders_of(task)) intervals.insert(order.intervals.begin(), order.intervals.end());
  if (orders_of(task).size() < 2) return;
  std::optional<std::map<std::size_t, double>> first;
  for (const auto& interval : intervals) {
    std::map<std::size_t, double> here;
    const auto parts = parts_of(task, interval);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].first_s) here[i] = *parts[i].first_s;
    if (first && here != *first)
      return reading.findings.add(reading.places.of(key_of(task, "parts")),
                                  phrase("\"first_s\" is not the same in all intervals, so the first trial "
                                         "of a block tells their order"),
                                  phrase("give the same parts of each interval the same \"first_s\""));
    first = here;
  }
}

/// Reports parts without a length, parts that cannot have one, and lists of parts that no interval names.
void check_parts(const Task& task, const TaskForm& kind, const Reading& reading) {
  std::vector<std::string> named{task.standard, task.target};
  for (const auto& interval : task.intervals) named.insert(named.end(), interval.begin(), interval.end());
  const bool until_answer = explored(task);
  for (const auto& [name, parts] : task.parts) {
    const auto place = reading.places.of(key_of(task, "parts." + name));
    if (std::find(named.begin(), named.end(), name) == named.end())
      reading.findings.add(place, phrase("no interval presents the parts \"%1\"", {plain(name)}),
                           phrase("name them in \"intervals\", \"standard\" or \"target\""));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const bool last = i + 1 == parts.size();
      const bool open = last && until_answer;
      if (!open && length_of(task, parts[i]) == nullptr)
        reading.findings.add(place, phrase("part %1 of \"%2\" has no length", {plain(i + 1), plain(name)}),
                             phrase("give it \"duration_s\""));
      if (open && task.kind == TaskKind::adjustment && parts[i].duration_s)
        reading.findings.add(
            parts[i].duration_s->place,
            phrase("the last part lasts until the slider is set, so it has no \"duration_s\""),
            phrase("leave it out; \"explore_s\" in [timing] is the longest time"));
      if (last && parts[i].first_s)
        reading.findings.add(
            place, phrase("the last part of \"%1\" is no adaptor, so it has no \"first_s\"", {plain(name)}),
            phrase("leave it out, or add the part that is judged"));
    }
  }
  if (task.kind == TaskKind::adjustment) check_slider_times(task, reading);
  check_first(task, reading);
  const auto most = most_parts_of_trial(task, kind);
  if (most > core::kMostParts)
    reading.findings.add(
        reading.places.of(key_of(task, reading.places.has(key_of(task, "parts")) ? "parts" : "before")),
        phrase("the intervals of a trial have up to %1 scenes", {plain(most)}),
        phrase("at most %1", {plain(core::kMostParts)}));
}

void read_intervals(TableReader& reader, Task& task, const Reading& reading) {
  if (compares(task.kind)) {
    task.standard = reader.string("standard");
    task.target = reader.string("target");
    for (const auto* key : {"standard", "target"})
      if (reader.has(key))
        check_scene(key == std::string("standard") ? task.standard : task.target, reader.place(key), reading);
    if (!task.standard.empty() && task.standard == task.target)
      reader.problem("target", phrase("\"target\" and \"standard\" are the same scene"),
                     phrase("name two different scenes"));
    return;
  }
  const auto* list = reader.require("intervals");
  if (!list) return;
  if (list->kind != Value::Kind::array)
    return reader.problem("intervals", phrase("\"%1\" is %2", {plain("intervals"), describe(*list)}),
                          phrase("write a list of scene names: %1", {plain("[\"edge\"]")}));
  for (const auto& item : list->items) task.intervals.push_back(read_interval(item, reading));
  const auto given = task.intervals.size();
  if (task.kind == TaskKind::comparison) {
    if (given < 2 || given > 4)
      reader.problem("intervals", phrase("\"%1\" has %2", {plain("intervals"), plain(given)}),
                     phrase("two for pairs, three for triads, four for quadruples"));
    return;
  }
  const std::size_t needed = task.kind == TaskKind::two_interval ? 2 : 1;
  if (task.intervals.size() != needed)
    reader.problem("intervals", phrase("\"%1\" has %2", {plain("intervals"), plain(task.intervals.size())}),
                   phrase("%1 must be given for this kind of task", {plain(needed)}));
}

void read_times(TableReader& reader, Task& task, const Reading& reading) {
  // A single interval needs no length: without one, it lasts until the answer.
  const bool single = task.kind == TaskKind::single_interval && task.standard.empty();
  const bool several = !single && task.kind != TaskKind::adjustment;
  std::vector<std::vector<std::string>> listed = task.intervals;
  for (const auto* name : {&task.standard, &task.target})
    if (!name->empty()) listed.push_back({*name});
  const bool plain_interval = std::any_of(listed.begin(), listed.end(), [&](const auto& interval) {
    return interval.size() != 1 || task.parts.count(interval.front()) == 0;
  });
  if (several && (plain_interval || listed.empty())) reader.require("duration_s");
  task.duration_s = read_length(reader, reading);  // with it, no interval is explored
  if (several) reader.require("gap_s");
  if (several) task.gap_s = read_expression(reader, "gap_s", reading);
  if (task.duration_s && task.kind == TaskKind::adjustment)
    reader.problem(
        "duration_s",
        phrase("a slider is set for as long as it takes: \"duration_s\" does not apply to \"adjustment\""),
        phrase("set \"explore_s\" in [timing] to the longest time that the tones last"));
  const auto sequence = [](const auto& interval) { return interval.size() > 1; };
  const bool change = std::any_of(task.intervals.begin(), task.intervals.end(), sequence);
  if (change) {
    reader.require("foreperiod_s");
    task.foreperiod_s = read_distribution(reader, "foreperiod_s", reading);
    task.transition_ms = reader.number("transition_ms");
  } else {
    for (const auto* key : {"foreperiod_s", "transition_ms"})
      if (reader.take(key))
        reader.problem(key, phrase("\"%1\" needs an interval with a second scene", {plain(key)}),
                       phrase("use an interval of two scenes: %1", {plain("intervals = [[\"a\", \"b\"]]")}));
  }
}

/// Reads the labels at values of a scale. Both ends of the scale must have a label.
std::vector<Anchor> read_anchors(TableReader& reader, double low, double high, const Reading& reading) {
  std::vector<Anchor> anchors;
  reader.require("labels");
  for (const auto* table : reader.tables("labels")) {
    TableReader inner(*table, reader.path("labels"), reading.findings, reader.keys("labels"));
    Anchor anchor;
    anchor.at = inner.number("at", {low, high});
    anchor.text = read_localised(inner, "text", reading);
    if (!anchors.empty() && anchor.at <= anchors.back().at)
      inner.problem("at", phrase("the labels are not in ascending order"),
                    phrase("begin with the lowest value"));
    inner.finish();
    anchors.push_back(std::move(anchor));
  }
  if (reader.has("labels") && (anchors.size() < 2 || anchors.front().at > low || anchors.back().at < high))
    reader.problem(
        "labels", phrase("an end of the scale has no label"),
        phrase("write labels at %1 and at %2", {plain(core::number(low)), plain(core::number(high))}));
  return anchors;
}

}  // namespace

Scale read_scale(const Value& table, const std::string& path, const Reading& reading) {
  TableReader reader(table, path, reading.findings, keys_of("task.rating"));
  Scale scale;
  if (const auto points = reader.maybe_integer("points")) {
    for (int i = 1; i <= *points; ++i) scale.choices.push_back({std::to_string(i), {}});
    scale.anchors = read_anchors(reader, 1, *points, reading);
  }
  if (const auto line = reader.maybe_interval("line")) {
    ValueAnswer value{false, line->first, line->second, reader.integer("decimals"), {}};
    const double steps = (value.high - value.low) * std::pow(10.0, value.decimals);
    if (steps < 10 || steps > 1000)
      reader.problem(reader.has("decimals") ? "decimals" : "line",
                     phrase("the line has %1 steps of its smallest decimal", {plain(core::number(steps))}),
                     phrase("use 10 to 1000, because a finger cannot choose between more places"));
    value.anchors = read_anchors(reader, value.low, value.high, reading);
    scale.value = std::move(value);
  }
  reader.finish();
  return scale;
}

ValueAnswer read_typed(TableReader& reader) {
  ValueAnswer value;
  value.typed = true;
  value.decimals = reader.integer("decimals");
  const double least = std::pow(10.0, -value.decimals);
  value.low = reader.number_or("low", least);
  value.high = reader.number("high");
  if (value.high <= value.low || value.high < least)
    reader.problem("high", phrase("\"high\" is not above \"low\""),
                   phrase("give the largest number that may be typed"));
  return value;
}

std::vector<Choice> read_choice_list(TableReader& reader, const std::string& path, const Reading& reading) {
  std::vector<Choice> choices;
  std::set<std::string> seen;
  for (const auto* table : reader.tables("choices")) {
    TableReader inner(*table, path, reading.findings, reader.keys("choices"));
    Choice choice;
    choice.id = inner.string("id");
    choice.label = read_localised(inner, "label", reading);
    if (!choice.id.empty() && !seen.insert(choice.id).second)
      inner.problem("id", phrase("there is already a choice with the id \"%1\"", {plain(choice.id)}),
                    phrase("each choice needs a different id"));
    inner.finish();
    choices.push_back(std::move(choice));
  }
  return choices;
}

namespace {

void read_rating(const Value& table, Task& task, const Reading& reading) {
  auto scale = read_scale(table, key_of(task, "rating"), reading);
  task.rating = !scale.choices.empty();
  if (task.rating) task.choices = std::move(scale.choices);
  task.anchors = std::move(scale.anchors);
  task.value = std::move(scale.value);
}

void read_number(const Value& table, Task& task, const Reading& reading) {
  TableReader reader(table, key_of(task, "number"), reading.findings, keys_of("task.number"));
  auto value = read_typed(reader);
  if (reader.has("standard")) {
    task.standard = reader.string("standard");
    check_scene(task.standard, reader.place("standard"), reading);
    reader.require("modulus");
    task.modulus = reader.maybe_number("modulus", {value.low, value.high});
  }
  reader.finish();
  task.value = std::move(value);
}

/// Reads which trials have a signal, if the rating says how sure a person is that there was one.
void read_present(TableReader& reader, Task& task, const Reading& reading) {
  const auto* value = reader.take("present");
  if (!value) return;
  if (!task.rating)
    return reader.problem("present",
                          phrase("only a rating on points can say how sure a person is of a signal"),
                          phrase("%1 in [task.rating]", {plain("points = 6")}));
  if (value->kind != Value::Kind::string)
    return reader.problem("present", phrase("\"%1\" is %2", {plain("present"), describe(*value)}),
                          phrase("write a comparison in quotes: %1", {plain("\"strength_um > 0\"")}));
  task.present = parse_comparison(value->string, value->place, reading.protocol.factors, reading.findings);
}

/// Reads the answer of a task without choices: [task.rating] or [task.number].
void read_judgement(TableReader& reader, Task& task, const Reading& reading) {
  const auto* rating = reader.maybe_table("rating");
  const auto* number = reader.maybe_table("number");
  if (!rating && !number) return;
  if (rating && number)
    return reader.problem("number", phrase("the task has both a \"rating\" and a \"number\""),
                          phrase("use one of them"));
  const char* key = rating ? "rating" : "number";
  if (task.kind != TaskKind::single_interval)
    reader.problem(key, phrase("this kind of task cannot have a \"%1\"", {plain(key)}),
                   plain("kind = \"single-interval\""));
  for (const auto* other : {"choices", "correct"})
    if (reader.take(other))
      reader.problem(other, phrase("a %1 has no \"%2\"", {plain(key), plain(other)}),
                     phrase("remove \"%1\"", {plain(other)}));
  if (task.device == Device::buttons)
    reader.problem("device", phrase("a %1 is given on the screen", {plain(key)}), plain("\"touch\""));
  if (rating)
    read_rating(*rating, task, reading);
  else
    read_number(*number, task, reading);
  read_present(reader, task, reading);
  if (task.value) task.choices = {{"value", {}}};
}

void read_confidence(TableReader& reader, Task& task, const Reading& reading) {
  const auto* table = reader.maybe_table("confidence");
  if (!table) return;
  TableReader inner(*table, key_of(task, "confidence"), reading.findings, reader.keys("confidence"));
  Confidence confidence;
  confidence.question = read_localised(inner, "question", reading);
  inner.require("labels");
  for (const auto* label : inner.tables("labels"))
    confidence.labels.push_back(localised_from(*label, "labels", reading));
  if (inner.has("labels") && (confidence.labels.size() < 2 || confidence.labels.size() > most_choices))
    inner.problem("labels", phrase("\"%1\" has %2", {plain("labels"), plain(confidence.labels.size())}),
                  phrase("from 2 to 9, from the least sure to the surest"));
  inner.finish();
  if (task.kind == TaskKind::adjustment)
    reader.problem("confidence", phrase("an adjustment cannot have a \"confidence\""),
                   phrase("use another kind of task"));
  if (task.device == Device::buttons)
    reader.problem("device",
                   phrase("the confidence is stated on the screen, so buttons alone are not enough"),
                   phrase("use \"touch\" or \"either\""));
  task.confidence = std::move(confidence);
}

/// Reads the answer for those who do not want to guess.
void read_unsure(TableReader& reader, Task& task, const Reading& reading) {
  const auto* text = reader.take("unsure");
  if (!text) return;
  if (task.kind == TaskKind::comparison)
    return reader.problem("unsure", phrase("in a comparison no answer is right or wrong"),
                          phrase("leave it out"));
  task.unsure = localised_from(*text, "unsure", reading);
  for (const auto& choice : task.choices)
    if (choice.id == kUnsure)
      reader.problem("choices", phrase("there is already an answer with the id \"%1\"", {plain(kUnsure)}),
                     phrase("give this choice another id"));
  if (task.kind == TaskKind::two_interval && !task.correct_answer.empty())
    reader.problem("unsure", phrase("\"unsure\" needs an interval that is right at every level"),
                   phrase("name the scene whose interval is right: %1", {plain("correct = \"SCENE\"")}));
  if (task.confidence)
    reader.problem("unsure", phrase("a task cannot have both \"unsure\" and \"confidence\""),
                   phrase("use one of them"));
}

void read_choices(TableReader& reader, Task& task, const TaskForm& kind, const Reading& reading) {
  task.choices = read_choice_list(reader, key_of(task, "choices"), reading);
  std::set<std::string> seen;
  for (const auto& choice : task.choices) seen.insert(choice.id);
  const auto [fewest, most] = std::pair(kind.fewest, kind.most);
  const auto* list = reader.take("choices");
  if (const auto given = list && list->kind == Value::Kind::array ? list->items.size() : fewest;
      given < fewest || given > most)
    reading.findings.add(given > most ? list->items[most].place : list->place,
                         phrase("\"%1\" has %2", {plain("choices"), plain(given)}),
                         fewest < most ? phrase("from %1 to %2 must be given for this kind of task",
                                                {plain(fewest), plain(most)})
                                       : phrase("%1 must be given for this kind of task", {plain(most)}));
  if (task.kind == TaskKind::same_different && task.choices.size() == 2 &&
      seen != std::set<std::string>{"same", "different"})
    reader.problem("choices", phrase("these are not the ids of the answers in a same-different task"),
                   phrase("use the ids \"same\" and \"different\""));
}

/// Reads for each of the two scenes when its interval is the right answer, such as the one that is rougher.
void read_correct_scenes(TableReader& reader, Task& task, const Reading& reading) {
  const auto* table = reader.maybe_table("correct");
  std::vector<std::string> scenes;
  for (const auto& interval : task.intervals)
    for (const auto& name : interval)
      if (std::find(scenes.begin(), scenes.end(), name) == scenes.end()) scenes.push_back(name);
  for (const auto& entry : table->entries) {
    if (std::find(scenes.begin(), scenes.end(), entry.key) == scenes.end()) {
      reading.findings.add(entry.place, phrase("unknown scene \"%1\"", {plain(entry.key)}),
                           core::suggestion(entry.key, scenes));
      continue;
    }
    if (entry.value.kind != Value::Kind::string) {
      reading.findings.add(entry.value.place,
                           phrase("\"%1\" has %2", {plain("correct"), describe(entry.value)}),
                           phrase("write a comparison in quotes: %1", {plain("\"change > 0\"")}));
      continue;
    }
    const auto comparison =
        parse_comparison(entry.value.string, entry.value.place, reading.protocol.factors, reading.findings);
    if (comparison) task.correct_answer.emplace_back(entry.key, *comparison);
  }
  for (const auto& name : scenes)
    if (!table->find(name))
      reading.findings.add(table->place,
                           phrase("\"correct\" does not say when \"%1\" is right", {plain(name)}),
                           phrase("write a comparison for each choice"));
}

void read_correct_scene(TableReader& reader, Task& task, const Reading& reading) {
  if (const auto* value = reader.take("correct"); value && value->kind == Value::Kind::table)
    return read_correct_scenes(reader, task, reading);
  task.correct_scene = reader.string("correct");
  if (task.correct_scene.empty()) return;
  check_scene(task.correct_scene, reader.place("correct"), reading);
  const auto in = [&](const auto& interval) {
    return std::find(interval.begin(), interval.end(), task.correct_scene) != interval.end();
  };
  if (task.intervals.size() == 2 && in(task.intervals[0]) == in(task.intervals[1]))
    reader.problem(task.intervals[0] == task.intervals[1] ? "intervals" : "correct",
                   in(task.intervals[0])
                       ? phrase("\"%1\" is in both intervals", {plain(task.correct_scene)})
                       : phrase("\"%1\" is in neither interval", {plain(task.correct_scene)}),
                   phrase("name a scene that is in only one of the two intervals"));
}

void read_correct_answers(TableReader& reader, Task& task, const Reading& reading) {
  const auto* table = reader.maybe_table("correct");
  if (!table) return;
  std::vector<std::string> ids;
  for (const auto& choice : task.choices) ids.push_back(choice.id);
  for (const auto& entry : table->entries) {
    if (std::find(ids.begin(), ids.end(), entry.key) == ids.end())
      reading.findings.add(
          entry.place, phrase("\"correct\" has \"%1\", which is not the id of a choice", {plain(entry.key)}),
          core::suggestion(entry.key, ids));
    if (entry.value.kind != Value::Kind::string) {
      reading.findings.add(entry.value.place,
                           phrase("\"%1\" has %2", {plain("correct"), describe(entry.value)}),
                           phrase("write a comparison in quotes: %1", {plain("\"offset_mm < 0\"")}));
      continue;
    }
    const auto comparison =
        parse_comparison(entry.value.string, entry.value.place, reading.protocol.factors, reading.findings);
    if (comparison) task.correct_answer.emplace_back(entry.key, *comparison);
  }
  for (const auto& id : ids)
    if (!id.empty() && !table->find(id))
      reading.findings.add(table->place, phrase("\"correct\" does not say when \"%1\" is right", {plain(id)}),
                           phrase("write a comparison for each choice"));
}

void read_correct(TableReader& reader, Task& task, const Reading& reading) {
  switch (task.kind) {
    case TaskKind::single_interval:
      return read_correct_answers(reader, task, reading);
    case TaskKind::two_interval:
      return read_correct_scene(reader, task, reading);
    case TaskKind::oddity: {
      const auto odd = reader.word("odd");
      task.odd = odd == "target" ? Odd::target : odd == "standard" ? Odd::standard : Odd::either;
      return;
    }
    case TaskKind::adjustment:
      if (const auto* factor = read_numeric_factor(reader, "adjusts", reading)) {
        task.adjusts = factor->name;
        if (!factor->range)
          reader.problem("adjusts", phrase("the factor \"%1\" has no range", {plain(factor->name)}),
                         phrase("give this factor a \"range\", over which the slider moves"));
      }
      task.step = reader.number("step");
      return;
    case TaskKind::several_intervals:
    case TaskKind::same_different:
    case TaskKind::abx:
    case TaskKind::match_to_sample:
    case TaskKind::comparison:
      return;
  }
}

/// Reads the factor whose value the question shows.
void read_shown(TableReader& reader, Task& task, const Reading& reading) {
  const auto name = reader.maybe_string("question_shows");
  if (!name) return;
  if (!find_factor(reading.protocol.factors, *name))
    return reader.problem("question_shows", phrase("unknown factor \"%1\"", {plain(*name)}),
                          core::suggestion(*name, names(reading.protocol.factors)));
  task.question_shows = *name;
  for (const auto& [language, text] : task.question)
    if (text.find("%1") == std::string::npos)
      reader.problem(
          "question",
          phrase("the question in \"%1\" does not show the value of \"%2\"", {plain(language), plain(*name)}),
          plain("%1"));
}

}  // namespace

namespace {

/// Reads one task from its table; `path` is that of the table.
void read_one(const Value& table, const std::string& path, const core::Keys& keys, Reading& reading) {
  TableReader reader(table, path, reading.findings, keys);
  auto& task = reading.protocol.task;
  const auto word = reader.word("kind");
  // An unknown kind has been reported. The code below then reads the keys of the first kind.
  const auto* kind = std::find_if(std::begin(task_forms), std::end(task_forms),
                                  [&word](const TaskForm& known) { return known.name == word; });
  if (kind == std::end(task_forms)) kind = std::begin(task_forms);
  task.kind = kind->kind;
  read_parts(reader, task, reading);
  read_before(reader, task, reading);
  read_intervals(reader, task, reading);
  const auto device = reader.word("device");
  task.device_place = reader.place("device");
  task.device = device == "touch" ? Device::touch : device == "buttons" ? Device::buttons : Device::either;
  if (task.kind == TaskKind::adjustment && task.device == Device::buttons)
    reader.problem("device", phrase("a slider cannot be moved with buttons"), plain("\"touch\""));
  if (reader.maybe_word("sound") == "masking_noise") task.sound = Sound::masking_noise;
  task.sound_place = reader.place("sound");
  if (reader.has("cue")) task.cue = read_localised(reader, "cue", reading);
  task.cue_s = read_expression(reader, "cue_s", reading).value_or(task.cue_s);
  task.again = static_cast<int>(reader.maybe_integer("again").value_or(0));
  task.question = read_localised(reader, "question", reading);
  read_shown(reader, task, reading);
  read_judgement(reader, task, reading);
  read_confidence(reader, task, reading);
  read_times(reader, task, reading);
  if (!judges(task) && !reader.has("rating") && !reader.has("number")) {
    read_choices(reader, task, *kind, reading);
    read_correct(reader, task, reading);
    read_unsure(reader, task, reading);
  }
  check_parts(task, *kind, reading);
  reader.finish();
}

}  // namespace

void read_task(TableReader& file, Reading& reading) {
  if (!file.has("tasks")) {
    if (const auto* one = file.table("task")) read_one(*one, "task", file.keys("task"), reading);
    return;
  }
  const auto* several = file.maybe_table("tasks");
  if (!several) return;
  const auto& keys = keys_of("tasks.NAME");
  for (const auto& entry : several->entries) {
    if (entry.value.kind != Value::Kind::table) {
      reading.findings.add(entry.place,
                           phrase("\"tasks.%1\" is %2", {plain(entry.key), describe(entry.value)}),
                           phrase("write a table %1", {plain("[tasks.NAME]")}));
      continue;
    }
    const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
    if (entry.key.size() > 64 || !std::all_of(entry.key.begin(), entry.key.end(), fits))
      reading.findings.add(entry.place, phrase("the name of the task is \"%1\"", {plain(entry.key)}),
                           phrase("at most 64 letters, digits, _ and -"));
    reading.protocol.task = {};
    reading.protocol.task.name = entry.key;
    read_one(entry.value, "tasks." + entry.key, keys, reading);
    reading.tasks.push_back(reading.protocol.task);
  }
  if (several->entries.size() < 2)
    reading.findings.add(several->place, phrase("[tasks] has %1", {plain(several->entries.size())}),
                         phrase("two or more tables [tasks.NAME], or one [task]"));
}

Task read_asked(TableReader& reader, const Reading& reading) {
  const auto name = reader.maybe_string("task");
  if (reading.tasks.empty()) {
    if (name)
      reader.problem("task", phrase("\"task\" names one of several tasks, but the file has one"),
                     phrase("leave it out, or write several tables [tasks.NAME]"));
    return reading.protocol.task;
  }
  std::vector<std::string> known;
  for (const auto& task : reading.tasks) known.push_back(task.name);
  const auto found = std::find(known.begin(), known.end(), name.value_or(""));
  if (!name)
    reader.findings().add(reader.place(), phrase("%1 does not say which task it asks", {reader.title()}),
                          phrase("\"task\" with %1", {core::quoted_list(known)}));
  else if (found == known.end())
    reader.problem("task", phrase("there is no [tasks.%1]", {plain(*name)}), core::suggestion(*name, known));
  if (found != known.end()) return reading.tasks[static_cast<std::size_t>(found - known.begin())];
  auto unknown = reading.tasks.front();
  unknown.name.clear();
  return unknown;
}

std::vector<Protocol> as_tasks_see(const Reading& reading) {
  if (reading.tasks.empty()) return {reading.protocol};
  std::vector<Protocol> all;
  for (const auto& task : reading.tasks) all.push_back(with_task(reading.protocol, task, reading.asks));
  return all;
}

}  // namespace turnpoint::protocol
