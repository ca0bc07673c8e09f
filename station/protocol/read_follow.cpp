#include <algorithm>
#include <cmath>
#include <functional>

#include "station/core/number.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/follow_target.hpp"
#include "station/protocol/reading.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

using core::Findings;
using core::Range;
using core::TableReader;
using core::Value;
using Ends = Range::Ends;
using follow::Shape;

namespace {

std::optional<Linear> read_within(TableReader& reader, const std::string& key, const Range& range,
                                  const Reading& reading) {
  const auto* value = reader.take(key);
  return value ? linear_from(*value, key, range, reading.protocol.factors, reader.findings()) : std::nullopt;
}

/// Like read_expression(), but reports to the reader's own findings.
std::optional<Linear> read_declared(TableReader& reader, const std::string& key, const Reading& reading) {
  return reader.has(key) ? read_within(reader, key, reader.range(key), reading) : std::nullopt;
}

/// Reports a problem unless `holds` at all ends of the factors' ranges.
void check_corners(TableReader& reader, const std::string& key,
                   const std::vector<const std::optional<Linear>*>& expressions, const Reading& reading,
                   const std::function<bool(const Factors&)>& holds, const core::Phrase& what,
                   const core::Phrase& allowed) {
  std::vector<const Linear*> all;
  for (const auto* expression : expressions) {
    if (!*expression) return;
    all.push_back(&**expression);
  }
  for (const auto& corner : corners(all, reading.protocol.factors)) try {
      if (!holds(corner)) return reader.problem(key, what, allowed);
    } catch (const std::invalid_argument&) {  // a factor whose values could not be read; reported already
      return;
    }
}

FollowEvent read_event(const Value& table, const std::string& path, Findings& findings,
                       const Reading& reading) {
  TableReader reader(table, path, findings, keys_of("scene.NAME.follow.parts.event"));
  FollowEvent event;
  if (reader.has("contact")) {
    event.event = follow::Event::contact;
    if (!reader.boolean("contact"))
      reader.problem("contact", phrase("\"contact\" is false"), phrase("write true, or leave out \"event\""));
  }
  const auto threshold = [&](const char* key, follow::Event kind) {
    if (!reader.has(key)) return;
    event.event = kind;
    event.threshold = read_declared(reader, key, reading);
  };
  threshold("force_N", follow::Event::force);
  threshold("place_mm", follow::Event::place);
  threshold("speed_mm_s", follow::Event::speed);
  event.until = reader.word("until") == "lifted" ? follow::Until::lifted : follow::Until::released;
  event.delay_s = read_declared(reader, "delay_s", reading);
  event.lasts_s = read_declared(reader, "lasts_s", reading);
  reader.finish();
  return event;
}

Noise read_noise(TableReader& reader, const Reading& reading, const std::optional<Linear>& period_mm) {
  Noise noise;
  double last = -1, highest = 0;
  for (const auto* point : reader.tables("spectrum")) {
    TableReader inner(*point, reader.path("spectrum"), reader.findings(),
                      keys_of("scene.NAME.follow.parts.spectrum"));
    const double per_mm = inner.number("cycles_per_mm");
    noise.spectrum.push_back({1e3 * per_mm, inner.number("density")});
    if (inner.has("cycles_per_mm") && per_mm <= last)
      inner.problem("cycles_per_mm", phrase("the points of a spectrum must ascend"),
                    phrase("above %1", {plain(core::number(last))}));
    last = per_mm;
    inner.finish();
  }
  noise.instance = read_declared(reader, "instance", reading);
  for (const auto& point : noise.spectrum) highest = std::max(highest, 1e-3 * point.cycles_per_m);
  check_corners(
      reader, "spectrum", {&period_mm}, reading,
      [&](const Factors& factors) { return noise_samples(noise, 1e-3 * evaluate(*period_mm, factors)) > 0; },
      phrase(
          "the noise has more than %1 samples (8 for each of its shortest cycles), or no power at any whole "
          "number of cycles in period_mm",
          {plain(follow::kTableSamples)}),
      phrase("a shorter \"period_mm\", or a spectrum that ends below %1 cycles per mm",
             {plain(core::number(highest))}));
  return noise;
}

std::optional<Shape> shape_of(const std::string& word) {
  if (word == "constant") return Shape::constant;
  if (word == "sine") return Shape::sine;
  if (word == "square") return Shape::square;
  if (word == "triangle") return Shape::triangle;
  if (word == "noise" || word == "table") return Shape::table;
  if (word == "gradient") return Shape::gradient;
  if (word == "bump") return Shape::bump;
  if (word == "edge") return Shape::edge;
  return std::nullopt;
}

/// What a value can be in the unit of the scene; in a part that is added, also below 0.
Range value_range(scene::FollowUnit unit, follow::Combine combine) {
  const double most = unit == scene::FollowUnit::relative      ? 1
                      : unit == scene::FollowUnit::coefficient ? 5
                                                               : 1000;
  return {combine == follow::Combine::add ? -most : 0, most, Ends::closed,
          unit == scene::FollowUnit::displacement ? "um" : ""};
}

FollowPart read_part(const Value& table, const std::string& path, Findings& findings, const Reading& reading,
                     scene::FollowUnit unit) {
  TableReader reader(table, path, findings, keys_of("scene.NAME.follow.parts"));
  FollowPart part;
  part.place = table.place;
  const auto word = reader.word("shape");
  part.shape = shape_of(word).value_or(Shape::constant);
  part.combine = reader.word("combine") == "add" ? follow::Combine::add : follow::Combine::replace;
  const auto values = value_range(unit, part.combine);
  if (part.shape != Shape::constant) {
    reader.require("from");
    part.from = read_within(reader, "from", values, reading);
  }
  reader.require("to");
  part.to = read_within(reader, "to", values, reading);
  part.begin_mm = read_declared(reader, "begin_mm", reading);
  part.end_mm = read_declared(reader, "end_mm", reading);
  const bool texture = part.shape == Shape::sine || part.shape == Shape::square ||
                       part.shape == Shape::triangle || part.shape == Shape::table;
  if (texture) {
    part.period_mm = read_declared(reader, "period_mm", reading);
    part.frequency_Hz = read_declared(reader, "frequency_Hz", reading);
    part.phase_deg = read_declared(reader, "phase_deg", reading);
    if (!reader.has("period_mm") && !reader.has("frequency_Hz"))
      reader.problem("shape", phrase("a %1 needs \"period_mm\" or \"frequency_Hz\"", {plain(word)}),
                     phrase("say how long a cycle is, or how many there are in a second"));
    if (!reader.has("period_mm"))
      check_corners(
          reader, "frequency_Hz", {&part.frequency_Hz}, reading,
          [&](const Factors& factors) { return evaluate(*part.frequency_Hz, factors) != 0; },
          phrase("\"frequency_Hz\" is 0, so that nothing varies"), phrase("another value, or \"period_mm\""));
  }
  if (texture || part.shape == Shape::bump || part.shape == Shape::edge)
    part.place_mm = read_declared(reader, "place_mm", reading);
  if (part.shape == Shape::bump || part.shape == Shape::edge) {
    part.width_mm = read_declared(reader, "width_mm", reading);
    if (!reader.has("place_mm"))
      reader.problem("shape", phrase("the %1 has no \"place_mm\"", {plain(word)}),
                     phrase("say where it is, in mm from the wide end"));
  }
  if (part.shape == Shape::bump) {
    if (!reader.has("width_mm"))
      reader.problem("shape", phrase("the bump has no \"width_mm\""), phrase("say how wide it is, in mm"));
    check_corners(
        reader, "width_mm", {&part.width_mm}, reading,
        [&](const Factors& factors) { return evaluate(*part.width_mm, factors) > 0; },
        phrase("the width of a bump is 0"), phrase("allowed: above 0 mm"));
  }
  if (part.shape == Shape::gradient && (!reader.has("begin_mm") || !reader.has("end_mm")))
    reader.problem("shape", phrase("a gradient needs \"begin_mm\" and \"end_mm\""),
                   phrase("say between which places the value changes, in mm from the wide end"));
  if (word == "table") {
    if (reader.has("samples") && reader.has("samples_file"))
      reader.problem("samples_file", phrase("the table has both \"samples\" and \"samples_file\""),
                     phrase("give one of them"));
    // parse() has put the numbers of a file in its place
    if (reader.has("samples_file"))
      (void)reader.string("samples_file");
    else
      reader.require("samples");
    part.samples = reader.maybe_numbers("samples");
  }
  if (word == "noise") {
    if (!reader.has("period_mm"))
      reader.problem("shape", phrase("noise needs \"period_mm\""),
                     phrase("say after which length it comes again"));
    reader.require("spectrum");
    part.noise = read_noise(reader, reading, part.period_mm);
  }
  check_corners(
      reader, "end_mm", {&part.begin_mm, &part.end_mm}, reading,
      [&](const Factors& factors) {
        return evaluate(*part.begin_mm, factors) < evaluate(*part.end_mm, factors);
      },
      phrase("the part does not end behind its begin"), phrase("\"end_mm\" must be above \"begin_mm\""));
  if (const auto* event = reader.maybe_table("event"))
    part.event = read_event(*event, path + ".event", findings, reading);
  reader.finish();
  return part;
}

}  // namespace

Follow read_follow(const Value& table, const std::string& path, Findings& findings, const Reading& reading) {
  TableReader reader(table, path, findings, keys_of("scene.NAME.follow"));
  Follow follow;
  follow.place = table.place;
  const auto base = [&](const char* key, scene::FollowUnit unit) {
    if (!reader.has(key)) return;
    follow.unit = unit;
    if (const auto value = read_declared(reader, key, reading)) follow.base = *value;
  };
  const auto units = {"friction", "coefficient", "displacement_um"};
  const auto stated =
      std::count_if(units.begin(), units.end(), [&](const char* key) { return reader.has(key); });
  if (stated != 1)
    findings.add(stated == 0 ? reader.place()
                             : reader.place(reader.has("coefficient") ? "coefficient" : "displacement_um"),
                 stated == 0 ? phrase("%1 does not say what it follows", {reader.title()})
                             : phrase("%1 has several units", {reader.title()}),
                 phrase("give exactly one of \"friction\", \"coefficient\" and \"displacement_um\""));
  base("friction", scene::FollowUnit::relative);
  base("displacement_um", scene::FollowUnit::displacement);
  base("coefficient", scene::FollowUnit::coefficient);
  if (reader.has("coefficient") && reader.word("control") == "closed")
    follow.control = follow::Control::closed;
  follow.resting_friction = read_declared(reader, "resting_friction", reading);
  follow.resting_gain = reader.number("resting_gain");
  std::size_t samples = 0;
  for (const auto* part : reader.tables("parts")) {
    follow.parts.push_back(read_part(*part, path + ".parts", findings, reading, follow.unit));
    samples += follow.parts.back().samples.size();
  }
  if (follow.parts.size() > static_cast<std::size_t>(follow::kMostParts))
    reader.problem("parts", phrase("\"parts\" has %1 parts", {plain(follow.parts.size())}),
                   phrase("allowed: at most %1", {plain(follow::kMostParts)}));
  std::vector<const std::optional<Linear>*> periods_mm;
  for (const auto& part : follow.parts)
    if (part.noise) periods_mm.push_back(&part.period_mm);
  if (!periods_mm.empty())
    check_corners(
        reader, "parts", periods_mm, reading,
        [&](const Factors& factors) {
          auto all = samples;
          for (const auto& part : follow.parts)
            if (part.noise)
              all += static_cast<std::size_t>(
                  noise_samples(*part.noise, 1e-3 * evaluate(*part.period_mm, factors)));
          return samples > static_cast<std::size_t>(follow::kTableSamples) ||  // said below
                 all <= static_cast<std::size_t>(follow::kTableSamples);
        },
        phrase("the tables and noises of all parts together have more than %1 samples",
               {plain(follow::kTableSamples)}),
        phrase("shorter periods of the noises, or spectra that end lower"));
  if (samples > static_cast<std::size_t>(follow::kTableSamples))
    reader.problem("parts", phrase("the tables of all parts together have %1 samples", {plain(samples)}),
                   phrase("allowed: at most %1", {plain(follow::kTableSamples)}));
  reader.finish();
  return follow;
}

void check_follow(const Reading& reading) {
  const auto& protocol = reading.protocol;
  const auto refuse = [&](const std::string& name, const core::Phrase& what, const core::Phrase& allowed) {
    const auto found = protocol.scenes.find(name);
    if (found != protocol.scenes.end() && found->second.follow)
      reading.findings.add(found->second.follow->place,
                           phrase("scene \"%1\" follows the finger, but %2", {plain(name), what}), allowed);
  };
  for (const auto& interval : protocol.task.intervals)
    if (interval.size() > 1)
      for (const auto& name : interval)
        refuse(name, phrase("it is one end of a change within an interval"),
               phrase("let an \"event\" of a part make the change"));
  if (protocol.task.kind == TaskKind::adjustment)
    for (const auto& interval : protocol.task.intervals)
      if (const auto parts = parts_of(protocol.task, interval);
          !parts.empty() && !parts.back().scenes.empty())
        refuse(parts.back().scenes.back(),
               phrase("it is what the slider moves, which such a scene cannot do while it is presented"),
               phrase("a staircase, as in matching-held-friction.toml"));
  if (const auto& signal = protocol.timing.signal; signal && signal->by == ResponseSignal::By::buzz)
    for (const auto& part : last_parts(protocol.task))
      for (const auto& name : part.scenes)
        refuse(name, phrase("the response signal is a buzz, which takes its place"),
               phrase("another response signal, or a scene that does not follow the finger"));
  for (const auto& part : protocol.plan)
    if (const auto& block = block_of(part); block.kind == BlockKind::friction_table)
      refuse(block.strokes.scene, phrase("a friction table is measured with it"),
             phrase("a scene with the same tones that does not follow the finger"));
}

}  // namespace turnpoint::protocol
