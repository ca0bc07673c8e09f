#include "station/protocol/needs.hpp"

#include <algorithm>

#include "station/core/number.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/resolve.hpp"
#include "station/protocol/triggers.hpp"
#include "station/scene/measures.hpp"
#include "station/scene/planner.hpp"
#include "station/scene/scaled.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

void check_devices(const Protocol& protocol, const rig::Rig& rig, Survey& survey) {
  const auto add = [&](const Place& place, const core::Phrase& what, const core::Phrase& allowed) {
    survey.problems.push_back({place, what, allowed});
  };
  const auto& task = protocol.task;
  if (task.device == Device::buttons && !rig.buttons_uri)
    add(task.device_place, phrase("the task needs buttons, but the rig has none"),
        phrase("use a rig with [buttons], or set %1", {plain("device = \"touch\"")}));
  if (task.device == Device::touch && !rig.touch_uri)
    add(task.device_place, phrase("the task needs a touchscreen, but the rig has none"),
        phrase("use a rig with [touch], or set %1", {plain("device = \"buttons\"")}));
  if (task.device == Device::either && !rig.touch_uri && !rig.buttons_uri)
    add(task.device_place, phrase("the rig has neither touchscreen nor buttons"),
        phrase("use a rig with [touch] or [buttons]"));
  const bool two_lines = rig.buttons_uri && rig.buttons_uri->rfind("gpio:", 0) == 0 &&
                         rig.buttons_uri->find("third=") == std::string::npos;
  const int answers = answer_count(task), buttons = two_lines ? 2 : 3;
  if (task.device == Device::buttons && answers > buttons && rig.buttons_uri)
    add(task.device_place,
        phrase("the task has %1 answers, but the rig has only %2 buttons", {plain(answers), plain(buttons)}),
        answers == 3 ? phrase("add a line \"third\" to [buttons], or set %1", {plain("device = \"touch\"")})
                     : phrase("set %1", {plain("device = \"touch\"")}));
  if (task.sound == Sound::masking_noise && !rig.noise)
    add(task.sound_place, phrase("the task needs masking noise, but the rig has none"),
        phrase("use a rig with [noise] (headphones on a spare channel), or leave out \"sound\""));
  const auto& signal = protocol.timing.signal;
  if (signal && signal->by == ResponseSignal::By::tone && !(rig.noise && rig.noise->signal))
    add(signal->by_place, phrase("the response signal is a tone, but the rig has none"),
        phrase("use a rig with [noise] (headphones on a spare channel) and its \"signal\", or set %1",
               {plain("by = \"screen\"")}));
  const auto zero = protocol.timing.response_zero;
  const bool contact = zero == ResponseZero::first_contact || zero == ResponseZero::lift_off;
  if (contact && !rig.contact_uri)
    add(protocol.timing.response_zero_place,
        phrase("response times are measured from the finger's contact, but the rig cannot sense contact"),
        phrase("use a rig with [contact], or another \"response_zero\""));
}

/// The shortest time from the beginning of an interval, or of its second scene, to the next event.
double shortest_event_s(const Protocol& protocol) {
  const auto& task = protocol.task;
  std::optional<double> shortest_s;
  for (const auto& part : parts_of(task)) {
    const double length_s = length_range_s(protocol, part).first;
    shortest_s = std::min(shortest_s.value_or(length_s), length_s);
  }
  if (!task.foreperiod_s) return shortest_s.value_or(0);
  return std::min(task.foreperiod_s->low, shortest_s.value_or(0));
}

void check_triggers(const Protocol& protocol, const rig::Rig& rig, Survey& survey) {
  const int largest = rig::largest_trigger_code(rig);
  if (largest == 0) return;
  const auto codes = trigger_codes(protocol);
  const auto most = std::max_element(codes.begin(), codes.end(),
                                     [](const auto& a, const auto& b) { return a.code < b.code; });
  auto place = protocol.triggers.place;
  if (place.line == 0) place = {protocol.path, 0, 0};
  if (most != codes.end() && most->code > largest)
    survey.problems.push_back(
        {place,
         phrase("the trigger codes go up to %1, for %2 conditions",
                {plain(most->code), plain(codes.size() / protocol.triggers.send.size() - 1)}),
         phrase("the rig's outputs give codes up to %1; send fewer events (\"send\" in [triggers]), or use a "
                "rig with more trigger lines",
                {plain(largest)})});
  const bool marked = rig.marker && rig.marker->kind == rig::Marker::Kind::code;
  const double code_s = marked ? rig::trigger_code_bits * rig.marker->duration_s : 0;
  if (!codes.empty() && code_s > shortest_event_s(protocol))
    survey.problems.push_back(
        {place,
         phrase("a trigger code lasts %1 ms, longer than the shortest time between two events",
                {plain(core::number(1e3 * code_s, 3))}),
         phrase("shorten \"duration_ms\" in [marker] of the rig")});
}

void check_sensing(const Protocol& protocol, const rig::Rig& rig, Survey& survey) {
  if (!protocol.sensing) return;
  if (rig::has_force_cells(rig)) {
    if (rig.capture->uri != "sim:" && !rig.capture->forces)
      survey.problems.push_back(
          {protocol.sensing->place,
           phrase("the rig's force cells are not calibrated, so the finger's movement is not known"),
           phrase("calibrate them with %1, or leave out [sensing]",
                  {plain("`turnpoint calibrate --forces`")})});
    return;
  }
  survey.problems.push_back(
      {protocol.sensing->place, phrase("the rig has no force cells, so the finger's movement is not known"),
       phrase("leave out [sensing], or use a rig with \"bridges\" in [capture] or with [force_cells]")});
}

/// Scenes that follow the finger need calibrated cells as [sensing] does. What else they need, the planner
/// says.
void check_following(const Protocol& protocol, const rig::Rig& rig, Survey& survey) {
  if (protocol.sensing || !rig::has_force_cells(rig) || rig.capture->uri == "sim:" || rig.capture->forces)
    return;
  for (const auto& name : scenes_used(protocol)) {
    const auto& follow = protocol.scenes.at(name).follow;
    if (!follow) continue;
    survey.problems.push_back(
        {follow->place,
         phrase("the rig's force cells are not calibrated, so scene \"%1\" cannot follow the finger",
                {plain(name)}),
         phrase("calibrate them with %1", {plain("`turnpoint calibrate --forces`")})});
    return;
  }
}

/// Plans each friction table's trials with the largest displacement, and reports those that the rig cannot
/// play.
void check_friction_tables(const Protocol& protocol, const rig::Rig& rig, Survey& survey) {
  for (const auto& part : protocol.plan) {
    const auto& block = block_of(part);
    if (block.kind != BlockKind::friction_table) continue;
    const auto& strokes = block.strokes;
    try {
      scene::Planner planner(rig);
      const auto plan = planner.plan(resolve(protocol, strokes.scene, {}, 0));
      const double reference_m =
          scene::mean_displacement_m(planner, plan, {1e-3 * strokes.from_mm, 1e-3 * strokes.to_mm});
      scene::refuse_beyond_limits(
          rig, scene::scaled(planner, plan, 1e-6 * strokes.levels_um.back() / reference_m));
    } catch (const scene::Unreachable& error) {
      survey.problems.push_back(
          {block.place,
           phrase("friction table \"%1\" at %2 um: %3",
                  {plain(block.name), plain(core::number(strokes.levels_um.back())), error.why()}),
           phrase("use smaller displacements, or another scene")});
    }
  }
}

}  // namespace

void check_needs(const Protocol& protocol, const rig::Rig& rig, Survey& survey) {
  check_devices(protocol, rig, survey);
  check_triggers(protocol, rig, survey);
  check_sensing(protocol, rig, survey);
  check_following(protocol, rig, survey);
  check_friction_tables(protocol, rig, survey);
}

}  // namespace turnpoint::protocol
