#include "station/protocol/design_advice.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "station/protocol/expression.hpp"
#include "station/protocol/key_places.hpp"
#include "station/protocol/sources.hpp"
#include "station/text/number.hpp"

namespace turnpoint::protocol {

namespace {

using procedure::Kind;
using procedure::Spec;
using text::number;
using text::Problem;

/// Weaker than any finger feels by far, and stronger than rounding.
constexpr double least_displacement_um = 0.001;

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t\n\r");
  return from == std::string::npos ? "" : text.substr(from, text.find_last_not_of(" \t\n\r") - from + 1);
}

class Advice {
 public:
  explicit Advice(const Protocol& protocol) : protocol_(protocol), places_(protocol.source, protocol.path) {}

  std::vector<Problem> all() {
    for (const auto& spec : protocol_.procedures) {
      level_without_scene(spec);
      steps(spec);
      rates(spec);
      grids(spec);
    }
    answers();
    words();
    ramps();
    strengths();
    blocks();
    instructions();
    return std::move(found_);
  }

 private:
  void add(const std::string& key, const std::string& what, const std::string& allowed) {
    found_.push_back({places_.of(key), what, allowed});
  }
  static std::string key_of(const Spec& spec, const std::string& key) {
    return "procedure." + spec.name + "." + key;
  }

  void level_without_scene(const Spec& spec) {
    for (const auto& name : scenes_used(protocol_))
      for (const auto* expression : expressions_of(protocol_.scenes.at(name))) {
        double sum = 0;
        for (const auto& [factor, coefficient] : expression->terms)
          if (factor == spec.level) sum += coefficient;
        if (sum != 0) return;
      }
    add(key_of(spec, "level"), "no scene of the task depends on \"" + spec.level + "\": all trials are alike",
        "a scene with \"" + spec.level + "\" in its arithmetic");
  }

  void steps(const Spec& spec) {
    const auto& down = spec.step.empty() ? spec.step_down : spec.step;
    const std::string key = spec.step.empty() ? "step_down" : "step";
    if (down.empty() || spec.scale != procedure::Scale::linear) return;
    if (spec.min && spec.max && down.front() >= *spec.max - *spec.min)
      add(key_of(spec, key), "a step of " + number(down.front()) + " is as large as the whole range",
          "steps well below " + number(*spec.max - *spec.min));
    if (!std::is_sorted(down.rbegin(), down.rend()))
      add(key_of(spec, key), "the steps grow from reversal to reversal",
          "steps that become smaller, [4.0, 2.0, 1.0]");
  }

  double chance() const { return 1.0 / static_cast<double>(protocol_.task.choices.size()); }

  void rates(const Spec& spec) {
    const bool scored = spec.tracks.empty();
    for (const double guess : spec.guess.values)
      if (scored && std::fabs(guess - chance()) > 0.1) {
        add(key_of(spec, "grid.guess"),
            "a guess rate of " + number(guess, 3) + ", where guessing gets " + number(chance(), 3) + " right",
            number(chance(), 3) + ", or values near it");
        break;
      }
    for (const double lapse : spec.lapse.values)
      if (lapse >= 0.5 && lapse < 1) {
        add(key_of(spec, "grid.lapse"),
            "a lapse rate of " + number(lapse, 3) + ": most answers would be slips",
            "small values, such as 0.01 to 0.1");
        break;
      }
    if (spec.kind == Kind::weighted_up_down && scored && spec.target && *spec.target <= chance() + 1e-9)
      add(key_of(spec, "target"), "a target of " + number(*spec.target, 3) + " is not above guessing",
          "between " + number(chance(), 3) + " and 1");
  }

  void grids(const Spec& spec) {
    const auto& stimuli = spec.stimuli.values;
    const auto& threshold = spec.threshold.values;
    if (stimuli.empty() || threshold.empty()) return;
    const auto [low, high] = std::minmax_element(stimuli.begin(), stimuli.end());
    const auto [from, to] = std::minmax_element(threshold.begin(), threshold.end());
    if (*to < *low || *from > *high)
      add(key_of(spec, "grid.threshold"), "no threshold of the grid lies among the stimuli",
          number(*low) + " to " + number(*high));
    const auto& prior = spec.prior_threshold.normal;
    if (prior && (prior->first < *from - 3 * prior->second || prior->first > *to + 3 * prior->second))
      add(key_of(spec, "prior.threshold"),
          "the prior's mean of " + number(prior->first) + " is far outside the grid",
          number(*from) + " to " + number(*to));
    if (spec.stop.min_trials && spec.stop.trials && *spec.stop.min_trials > *spec.stop.trials)
      add(key_of(spec, "stop"), "\"min_trials\" is above \"trials\"",
          "at most " + std::to_string(*spec.stop.trials));
  }

  // Every value that a factor of the comparisons can take with this source, the
  // others as they come first.
  std::vector<Factors> cases_of(const Source& source) const {
    std::vector<Factors> cases;
    for (const double level : source.levels) {
      cases.push_back(any_factors(protocol_));
      cases.back()[source.level] = level;
    }
    return cases;
  }

  void answers() {
    const auto& correct = protocol_.task.correct_answer;
    if (correct.empty()) return;
    std::vector<int> right(correct.size(), 0);
    int all = 0;
    for (const auto& source : sources_of(protocol_)) {
      int scored = 0;
      for (const auto& factors : cases_of(source)) {
        ++all;
        for (std::size_t i = 0; i < correct.size(); ++i)
          if (holds(correct[i].second, factors)) ++right[i], ++scored;
      }
      if (scored == 0 && source.spec && source.spec->kind == Kind::constant_stimuli)
        add(key_of(*source.spec, "values"), "no answer is right at any of these levels",
            "levels for which \"correct\" names an answer");
    }
    for (std::size_t i = 0; i < correct.size(); ++i) {
      if (depends_on_drawn(correct[i].second)) continue;
      const std::string key = "task.correct." + correct[i].first;
      if (right[i] == 0)
        add(key, "the answer \"" + correct[i].first + "\" is never right",
            "a comparison that some level fulfils");
      else if (right[i] == all)
        add(key, "the answer \"" + correct[i].first + "\" is always right",
            "a comparison that some level does not fulfil");
    }
  }

  bool depends_on_drawn(const Comparison& comparison) const {
    for (const auto* side : {&comparison.left, &comparison.right})
      for (const auto& [name, coefficient] : side->terms)
        if (const auto* factor = find_factor(protocol_.factors, name); factor && factor->levels.size() > 1)
          return true;
    return false;
  }

  void words() {
    const auto& choices = protocol_.task.choices;
    for (const auto& language : protocol_.languages) {
      std::set<std::string> seen;
      for (std::size_t i = 0; i < choices.size(); ++i) {
        const auto found = choices[i].label.find(language);
        const auto label = found == choices[i].label.end() ? "" : trimmed(found->second);
        const auto key = "task.choices." + std::to_string(i) + ".label." + language;
        if (label.empty())
          add(key, "the label of \"" + choices[i].id + "\" is blank",
              "what the participant reads on the button");
        else if (!seen.insert(label).second)
          add(key, "two answers have the label \"" + label + "\"", "labels that differ");
      }
      const auto question = protocol_.task.question.find(language);
      if (question != protocol_.task.question.end() && trimmed(question->second).empty())
        add("task.question." + language, "the question is blank", "what the participant is asked");
    }
  }

  void ramps() {
    const auto& task = protocol_.task;
    const bool several = task.duration_s.has_value();
    const double longest_s = task.duration_s.value_or(protocol_.timing.explore_s.value_or(0));
    for (const auto& name : scenes_used(protocol_)) {
      if (longest_s <= 0 || 2e-3 * protocol_.scenes.at(name).ramp_ms < longest_s) continue;
      const bool stated =
          places_.has("scene." + name + ".ramp_ms") && protocol_.scenes.at(name).ramp_ms > 500;
      add(stated    ? "scene." + name + ".ramp_ms"
          : several ? "task.duration_s"
                    : "timing.explore_s",
          "the ramps of scene \"" + name + "\" take as long as its tones, " + number(longest_s) + " s",
          "tones that last longer than both ramps");
      return;
    }
  }

  void strengths() {
    for (const auto& name : scenes_used(protocol_)) {
      const auto& displacement = protocol_.scenes.at(name).displacement_um;
      if (displacement && bounds(*displacement, protocol_.factors).second < least_displacement_um)
        add("scene." + name + ".displacement_um",
            "nobody feels a displacement of " + displacement->source + " um", "about 0.2 to 3 um");
    }
  }

  void blocks() {
    for (const auto& part : protocol_.plan) {
      const auto& block = block_of(part);
      const auto* sequence = std::get_if<Sequence>(&part);
      const auto table = sequence ? "sequence." + sequence->name + ".block" : "block." + block.name;
      std::size_t levels = block.levels.size();
      for (const auto& name : block.procedures)
        if (const auto* spec = find_procedure(protocol_, name); spec && spec->kind == Kind::constant_stimuli)
          levels += spec->values.size();
      if (block.trials && static_cast<std::size_t>(*block.trials) < levels)
        add(table + ".trials",
            "of " + std::to_string(levels) + " levels " + std::to_string(*block.trials) +
                " are presented: the others never are",
            "at least " + std::to_string(levels) + " trials");
      if (places_.has(table + ".interleave") && block.procedures.size() < 2)
        add(table + ".interleave", "\"interleave\" with one procedure", "two procedures or more");
      if (sequence && sequence->mirror && sequence->cycles < 2)
        add("sequence." + sequence->name + ".mirror", "\"mirror\" with one cycle mirrors nothing",
            "cycles = 2 or more");
    }
  }

  void instructions() {
    for (const auto& [name, instruction] : protocol_.instructions) {
      bool shown = false;
      for (const auto& block : all_blocks(protocol_)) {
        const auto fixed = block.fixed.find("instruction");
        shown = shown || (fixed != block.fixed.end() && fixed->second == FactorValue(name));
      }
      if (!shown)
        add("instructions." + name, "nothing shows the instruction \"" + name + "\"",
            "instruction = \"" + name +
                "\" in a block, or a sequence over a factor named "
                "\"instruction\"");
    }
  }

  const Protocol& protocol_;
  KeyPlaces places_;
  std::vector<Problem> found_;
};

}  // namespace

std::vector<Problem> design_advice(const Protocol& protocol) { return Advice(protocol).all(); }

std::vector<Problem> notes(const Protocol& protocol) {
  const KeyPlaces places(protocol.source, protocol.path);
  std::vector<Problem> notes;
  for (const auto& spec : protocol.procedures)
    for (const auto& name : spec.balance) {
      const auto* factor = find_factor(protocol.factors, name);
      const int levels = factor ? static_cast<int>(factor->levels.size()) : 0;
      if (levels == 0 || spec.repeats % levels == 0) continue;
      const int least = spec.repeats / levels;
      notes.push_back({places.of("procedure." + spec.name + ".balance"),
                       "each level meets each of the " + std::to_string(levels) + " values of \"" + name +
                           "\" " + std::to_string(least) + " or " + std::to_string(least + 1) + " times",
                       "equally often with repeats = " + std::to_string((least + 1) * levels)});
    }
  return notes;
}

}  // namespace turnpoint::protocol
