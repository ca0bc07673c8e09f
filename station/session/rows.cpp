#include "station/session/rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "station/protocol/answers.hpp"
#include "station/protocol/sources.hpp"
#include "station/text/number.hpp"

namespace turnpoint::session {

namespace {

/// The factor that the trial's level is of: its procedure's, else that of the first trials that have one.
std::string level_factor(const TrialSpec& spec, const protocol::Protocol& protocol) {
  if (const auto* procedure = protocol::find_procedure(protocol, spec.procedure)) return procedure->level;
  if (!protocol.procedures.empty()) return protocol.procedures.front().level;
  const auto sources = protocol::sources_of(protocol);
  return sources.empty() ? "" : sources.front().level;
}

std::optional<double> seconds(const std::optional<std::int64_t>& ns) {
  return ns ? std::optional(static_cast<double>(*ns) * 1e-9) : std::nullopt;
}

std::string choice_id(const protocol::Protocol& protocol, int index) {
  const auto& choices = protocol.task.choices;
  return index >= 0 && index < static_cast<int>(choices.size()) ? choices[static_cast<std::size_t>(index)].id
                                                                : "";
}

const char* kind_of(InputKind kind) {
  switch (kind) {
    case InputKind::answer:
      return "answer";
    case InputKind::next:
      return "next";
    case InputKind::slider:
      return "slider";
    case InputKind::touch_down:
      return "touch";
    case InputKind::button:
      return "button";
    case InputKind::contact:
      return "contact";
    case InputKind::stop:
      return "stop";
    case InputKind::pause:
      return "pause";
    case InputKind::frames_lost:
      return "frames_lost";
    case InputKind::xrun:
      return "xrun";
    case InputKind::heard:
      return "heard";
    case InputKind::fault:
      return "fault";
    case InputKind::failure:
      return "failure";
    case InputKind::glitch:
      return "glitch";
    case InputKind::notice:
      return "notice";
    case InputKind::arm:
      return "arm";
    case InputKind::disarm:
      return "disarm";
    case InputKind::repeat:
      return "repeat";
    case InputKind::note:
      return "note";
  }
  return "";
}

std::string value_of(const Input& input) {
  if (input.kind == InputKind::fault)
    return input.text.empty() ? name(input.fault) : fmt::format("{}: {}", name(input.fault), input.text);
  if (!input.text.empty()) return input.text;
  if (input.kind == InputKind::slider) return text::exact(input.number);
  if (input.kind == InputKind::contact && input.number >= 0)
    return fmt::format("{} {}", input.value, text::number(input.number, 4));
  return std::to_string(input.value);
}

/// Where a scene stands in its trial, and when it sounds.
struct Placed {
  int interval = 0, scene = 0;
  std::int64_t onset_frame = 0, length_frames = 0;
};

void add_scene(store::TrialRow& row, const scene::DrivePlan& plan, const Placed& placed) {
  for (std::size_t t = 0; t < plan.tones.size(); ++t) {
    store::ToneRow tone;
    tone.interval_index = placed.interval;
    tone.scene_index = placed.scene;
    tone.tone_index = static_cast<int>(t);
    tone.scene = plan.scene.name;
    if (plan.boundary_m) tone.boundary_mm = 1e3 * *plan.boundary_m;
    tone.frequency_Hz = plan.tones[t].frequency_Hz;
    tone.amplitude_um = 1e6 * plan.tones[t].amplitude_m;
    tone.displacement_um = 1e6 * plan.tones[t].displacement_m;
    tone.friction = plan.zone_friction ? plan.zone_friction : std::optional(plan.lowest_friction);
    tone.rove_dB = plan.scene.rove_dB;
    tone.model = physics::name(plan.model);
    tone.error_bound_mm = 1e3 * plan.error_bound_m;
    tone.uncertainty_mm = 1e3 * plan.uncertainty_m;
    tone.reason = plan.reason;
    tone.onset_frame = placed.onset_frame;
    tone.length_frames = placed.length_frames;
    row.tones.push_back(std::move(tone));
  }
}

void take_last(store::TrialRow& row, const scene::DrivePlan& last) {
  row.boundary_mm = last.boundary_m ? std::optional(1e3 * *last.boundary_m) : std::nullopt;
  if (last.tones.empty()) return;
  row.frequency_Hz = last.tones.front().frequency_Hz;
  row.amplitude = 1e6 * last.tones.front().displacement_m;
}

}  // namespace

store::BlockStart block_start(const protocol::Block& block, int block_index, int attempt) {
  store::BlockStart start;
  start.block_index = block_index;
  start.attempt = attempt;
  start.name = block.name;
  start.practice = block.practice;
  const auto found = block.fixed.find("instruction");
  if (found != block.fixed.end())
    if (const auto* text = std::get_if<std::string>(&found->second)) start.instruction = *text;
  return start;
}

store::TrialRow row_of(const TrialSpec& spec, const protocol::Protocol& protocol, int trial_index) {
  store::TrialRow row;
  row.trial_index = trial_index;
  row.trial_in_block = spec.trial_in_block;
  row.type = spec.type;
  row.procedure = spec.procedure;
  row.level = spec.level;
  for (const auto& [name, value] : spec.factors)
    std::visit([&row, &name = name](const auto& v) { row.factors[name] = v; }, value);
  if (spec.correct) row.correct_response = choice_id(protocol, *spec.correct);
  row.response_zero = name(protocol.timing.response_zero);
  row.response_time_quality = "n/a";
  row.deadline_s = spec.deadline_s;
  return row;
}

void add_tones(store::TrialRow& row, const std::vector<scene::DrivePlan>& scenes, int interval,
               std::int64_t onset_frame, const drive::PreparedBurst& burst) {
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const auto start = s == 0 ? 0 : burst.changes[s - 1].at_frame;
    const auto end = s + 1 < scenes.size() ? burst.changes[s].at_frame : burst.length_frames;
    add_scene(row, scenes[s], {interval, static_cast<int>(s), onset_frame + start, end - start});
  }
  take_last(row, scenes.back());
}

void set_scene(store::TrialRow& row, const scene::DrivePlan& scene, std::int64_t frame) {
  std::int64_t end = 0;
  for (const auto& tone : row.tones) end = std::max(end, tone.onset_frame + tone.length_frames);
  std::erase_if(row.tones, [](const auto& tone) { return tone.scene_index == 1; });
  for (auto& tone : row.tones) tone.length_frames = std::min(tone.length_frames, frame - tone.onset_frame);
  add_scene(row, scene, {0, 1, frame, end - frame});
  take_last(row, scene);
}

void fill_result(store::TrialRow& row, const trial::Result& result, const TrialSpec& spec,
                 const protocol::Protocol& protocol, std::int64_t origin_ns) {
  row.outcome = result.outcome;
  if (result.response) row.response = choice_id(protocol, *result.response);
  row.correct = result.correct;
  row.onset_ns = result.zero_ns.value_or(result.started_ns);
  row.onset_s = static_cast<double>(row.onset_ns - origin_ns) * 1e-9;
  row.duration_s = static_cast<double>(result.ended_ns - result.started_ns) * 1e-9;
  row.response_time_s = seconds(result.response_time_ns);
  row.decision_time_s = seconds(result.decision_time_ns);
  row.movement_time_s = seconds(result.movement_time_ns);
  row.extra_touches = result.extra_touches;
  row.xruns = result.xruns;
  if (!spec.correct) row.correct.reset();
  if (!result.response) row.response_time_quality = "n/a";
}

store::EventRow event_row(const Input& input, int trial_index) {
  store::EventRow row;
  row.time_ns = input.time_ns;
  row.kind = kind_of(input.kind);
  row.trial_index = trial_index;
  row.value = value_of(input);
  return row;
}

const char* name(TimeQuality quality) {
  switch (quality) {
    case TimeQuality::kernel:
      return "kernel";
    case TimeQuality::toolkit:
      return "toolkit";
    case TimeQuality::simulated:
      return "simulated";
  }
  return "";
}

std::optional<trial::Event> event_of(const Input& input) {
  using trial::EventKind;
  switch (input.kind) {
    case InputKind::answer:
      return trial::Event{input.time_ns, EventKind::answer, input.value};
    case InputKind::touch_down:
      return trial::Event{input.time_ns, EventKind::touch, 0};
    case InputKind::contact:
      return trial::Event{input.time_ns, EventKind::contact, input.value};
    case InputKind::xrun:
      return trial::Event{input.time_ns, EventKind::xrun, input.value};
    case InputKind::heard:
      return trial::Event{input.time_ns, EventKind::heard, input.value};
    case InputKind::fault:
      return trial::Event{input.time_ns, EventKind::fault, 0};
    case InputKind::stop:
    case InputKind::pause:
    case InputKind::failure:
    case InputKind::repeat:
      return trial::Event{input.time_ns, EventKind::abort, 0};
    case InputKind::disarm:
      return trial::Event{input.time_ns, EventKind::fault, 0};
    case InputKind::next:
    case InputKind::slider:
    case InputKind::button:
    case InputKind::glitch:
    case InputKind::notice:
    case InputKind::arm:
    case InputKind::note:
    case InputKind::frames_lost:
      break;
  }
  return std::nullopt;
}

observer::Question question_of(const TrialSpec& spec, const protocol::Protocol& protocol,
                               std::uint64_t seed) {
  observer::Question question;
  question.level = spec.level.value_or(0);
  question.correct = spec.correct;
  question.deadline_s = spec.deadline_s;
  question.answers = static_cast<int>(protocol.task.choices.size());
  question.key = {seed, random::Stream::observer, spec.block_index, spec.attempt, spec.trial_in_block};
  const auto level = level_factor(spec, protocol);
  question.decibel = level.ends_with("_dB");
  question.default_threshold = protocol::middle_level(protocol, level);
  const auto rule = protocol::answer_rule(protocol, level);
  question.positive = rule.positive;
  switch (rule.kind) {
    case protocol::AnswerKind::right_answer:
      break;
    case protocol::AnswerKind::side:
      question.decides = observer::Decides::side;
      break;
    case protocol::AnswerKind::presence:
      question.decides = observer::Decides::presence;
      question.absent = protocol.task.kind == protocol::TaskKind::same_different && spec.correct &&
                        *spec.correct != rule.positive;
      break;
  }
  return question;
}

observer::Adjustment adjustment_of(const TrialSpec& spec, std::uint64_t seed) {
  observer::Adjustment adjustment;
  adjustment.start = spec.level.value_or(spec.slider->low);
  adjustment.low = spec.slider->low, adjustment.high = spec.slider->high;
  adjustment.key = {seed, random::Stream::observer, spec.block_index, spec.attempt, spec.trial_in_block};
  return adjustment;
}

void replay(Director& director, const store::TrialRow& trial, const protocol::Protocol& protocol) {
  const auto mismatch = [&trial](const std::string& what) {
    throw std::runtime_error(
        fmt::format("resume: trial {} of the log cannot be replayed: {}; the database, the protocol or this "
                    "program has changed",
                    trial.trial_index, what));
  };
  const auto spec = director.next();
  if (!spec) mismatch("the session would have been over");
  if (spec->level != trial.level)
    mismatch(fmt::format("level {} would have come, the log holds {}", spec->level.value_or(0),
                         trial.level.value_or(0)));
  TrialEnd end;
  end.outcome = trial.outcome;
  end.correct = trial.correct;
  if (trial.response)
    for (std::size_t i = 0; i < protocol.task.choices.size(); ++i)
      if (protocol.task.choices[i].id == *trial.response) end.response = static_cast<int>(i);
  if (spec->slider && trial.response) {
    double setting = 0;
    const auto* last = trial.response->data() + trial.response->size();
    const auto read = std::from_chars(trial.response->data(), last, setting);
    if (read.ec != std::errc{} || read.ptr != last) mismatch("\"" + *trial.response + "\" is no setting");
    end.response = 0, end.setting = setting;
  }
  director.record(end);
  if (director.state_hash() != trial.state_hash) mismatch("its state hash differs");
}

}  // namespace turnpoint::session
