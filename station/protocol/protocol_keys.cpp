#include "station/protocol/protocol_keys.hpp"

#include <limits>

#include "station/core/parts.hpp"
#include "station/core/trial.hpp"
#include "station/follow/pattern.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/protocol.hpp"
#include "station/protocol/triggers.hpp"

namespace turnpoint::protocol {

// The short names of this file are nobody else's.
namespace declarations {
namespace {

using core::Key;
using core::Keys;
using core::Range;
using namespace core::key;
using Ends = Range::Ends;
using Words = std::vector<std::string>;

const Range any_value{-1e6, 1e6};
// A position below one millimetre was probably written in metres, so it is refused.
const Range position_mm{1, 1e5, Ends::closed, "mm"};
const Range displacement_um{0, 1000, Ends::open_low, "um"};
const Range share{0, 1, Ends::open};
const Range deadline_s{0, 3600, Ends::open_low, "s"};
const Range seconds{0, 3600, Ends::closed, "s"};
const Range delay_s{0, 120, Ends::closed, "s"};
constexpr int most = static_cast<int>(most_choices);

Key name(const char* key, const char* help) {
  return string(key, help)
      .matching("^[A-Za-z0-9_-]{1,64}$", "at most 64 letters, digits, _ and -")
      .required();
}

/// A number of seconds, fixed, drawn evenly between two, or depending on factors.
Key time(const char* key, const char* help) {
  return several(
      key,
      {expression("", seconds, ""),
       table("", {interval("uniform", seconds, "the shortest and the longest time").required()}, "")},
      help);
}

Key one_or_more(const char* key, const char* help) {
  return several(key, {string("", ""), strings("", "")}, help);
}

Key by_factor(const char* key, const char* help) {
  return table(
      key,
      Keys{}.with_free_names(several("FACTOR", {number("", any_value, ""), string("", "")}, "its value")),
      help);
}

Keys audience() {
  return {integers("sessions", 1, 100, "planned sessions that have it").without_it("all"),
          strings("groups", "groups of participants that have it").holding(0).without_it("all")};
}

Key choices(const char* help) {
  return tables(
      "choices",
      {name("id", "what is stored with the data"), localised("label", "what the button says").required()},
      help);
}

Keys rating() {
  Keys keys{
      integer("points", 2, most, "number of buttons").only_without("line"),
      interval("line", any_value, "ends of a line without points").only_without("points"),
      integer("decimals", 0, 3, "decimals of a value on the line, which has 10 to 1000 steps")
          .by_default("0")
          .only_with("line"),
      tables("labels",
             {number("at", any_value, "the value").required(), localised("text", "what it means").required()},
             "what values mean, from the lowest to the highest, both ends among them")
          .required()
          .holding(2)};
  return keys.one_of({"points", "line"});
}

Keys typed() {
  return {number("low", {0, 1e6}, "smallest number that may be typed")
              .without_it("the smallest above 0 with these decimals"),
          number("high", {0, 1e6, Ends::open_low}, "largest number that may be typed").by_default("1000"),
          integer("decimals", 0, 3, "decimals that may be typed").by_default("0")};
}

Keys factor() {
  Keys keys{
      string("name", "a name that ends with the unit, such as \"offset_mm\"")
          .matching(
              "^[A-Za-z_][A-Za-z0-9_]*$",
              "letters, digits and _, not beginning with a digit; end the name with the unit: \"offset_mm\"")
          .required(),
      interval("range", any_value, "lowest and highest value that a procedure may set or a draw may give"),
      several("levels", {numbers("", any_value, ""), strings("", "")},
              "the values: all numbers, or all names; one is drawn in each trial if nothing else sets the "
              "factor"),
      several("draw",
              {word("", {"uniform", "without-repetition", "per-participant"}, ""),
               table("",
                     {table("normal",
                            {number("mean", any_value, "mean").required(),
                             number("sd", {0, 2e6, Ends::open_low}, "standard deviation").required()},
                            "a normal distribution, cut off at the range")
                          .required()},
                     "")},
              "how a value is drawn if nothing else sets the factor; \"without-repetition\": each once "
              "before any comes again; \"per-participant\": groups")
          .without_it("levels independently; a range not at all")};
  return keys.some_of({"range", "levels"});
}

Key edge() {
  return several("edge",
                 {word("", {"turning", "peak", "p70", "p50", "p25", "p10"}, ""),
                  table("",
                        {number("friction", share, "friction at the boundary, as a share of that at rest")
                             .required()},
                        "")},
                 "which place the boundary is: local cut-off, last maximum of the vibration, where it has "
                 "fallen to so "
                 "many percent, or where friction under a fingertip crosses a share of its value at rest")
      .required()
      .only_with("boundary_mm");
}

Keys follow_event() {
  Keys keys{
      boolean("contact", "true: when the finger touches the surface"),
      expression("force_N", {0, 20, Ends::open_low, "N"}, "when it presses with this normal force"),
      expression("place_mm", {0, 1e5, Ends::open_low, "mm"},
                 "when it passes this place, away from the wide end"),
      expression("speed_mm_s", {0, 1000, Ends::open_low, "mm/s"}, "when it is as fast as this"),
      word("until", {"released", "lifted"},
           "until it falls below that again (by a fifth, or by 0.3 mm), or until the finger lifts")
          .by_default("\"released\""),
      expression("delay_s", {0, 10, Ends::closed, "s"}, "the part begins so much later").by_default("0"),
      expression("lasts_s", {0, 600, Ends::open_low, "s"}, "its longest duration")
          .without_it("until the event ends")};
  return keys.one_of({"contact", "force_N", "place_mm", "speed_mm_s"});
}

Keys follow_part() {
  const Words textures{"sine", "square", "triangle", "noise", "table"};
  const Words ranged{"sine", "square", "triangle", "noise", "table", "gradient", "bump", "edge"};
  const Range value{-1000, 1000}, place_mm{0, 1e5, Ends::closed, "mm"};
  return {
      word("shape", {"constant", "sine", "square", "triangle", "noise", "table", "gradient", "bump", "edge"},
           "how its value varies between `from` and `to`")
          .required(),
      expression("from", value,
                 "in the unit of the scene's `follow`: the lowest of a table or noise, the value "
                 "before an edge, outside a bump, or at begin_mm of a gradient")
          .required()
          .only_with("shape", ranged),
      expression("to", value, "the value of a constant, and the other end of all others").required(),
      expression("begin_mm", place_mm, "where the part begins, from the wide end").without_it("everywhere"),
      expression("end_mm", place_mm,
                 "where it ends; with both, the rig must be able to present it between them")
          .without_it("everywhere"),
      expression("period_mm", {0.1, 1e5, Ends::closed, "mm"},
                 "length of a cycle; of noise: the length after which it comes again")
          .without_it("it varies only in time")
          .only_with("shape", textures),
      expression("frequency_Hz", {-1000, 1000, Ends::closed, "Hz"},
                 "cycles in a second: it moves, or without period_mm it vibrates")
          .by_default("0")
          .only_with("shape", textures),
      expression("phase_deg", {-360, 360, Ends::closed, "degrees"}, "its phase at place_mm")
          .by_default("0")
          .only_with("shape", textures),
      expression("place_mm", place_mm, "the middle of a bump or an edge; where a texture has its phase")
          .without_it("0; required for a bump and an edge")
          .only_with("shape", {"sine", "square", "triangle", "noise", "table", "bump", "edge"}),
      expression("width_mm", {0, 1e4, Ends::closed, "mm"}, "width of the bump, or of the change at an edge")
          .without_it("0 for an edge; required for a bump")
          .only_with("shape", {"bump", "edge"}),
      tables("spectrum",
             {number("cycles_per_mm", {0, 100, Ends::closed}, "spatial frequency").required(),
              number("density", {0, 1e6, Ends::closed}, "power density there, in any unit").required()},
             "points of the noise's spectrum, joined by straight lines")
          .holding(2)
          .required()
          .only_with("shape", {"noise"}),
      expression("instance", {0, 1e6, Ends::closed},
                 "which one of the noises with this spectrum: each whole number is another")
          .by_default("1")
          .only_with("shape", {"noise"}),
      numbers("samples", {0, 1, Ends::closed}, "one cycle of a table: 0 is `from`, 1 is `to`")
          .holding(2, follow::kTableSamples)
          .without_it("for a table: required, or samples_file")
          .only_with("shape", {"table"}),
      string("samples_file",
             "CSV file with these numbers, one in each line, beside the protocol file; a session stores them")
          .only_with("shape", {"table"}),
      word("combine", {"replace", "add"},
           "whether it takes the place of the parts before it, or is added to them")
          .by_default("\"replace\""),
      table("event", follow_event(), "what makes the part begin").without_it("it is always there"),
  };
}

Key following() {
  Keys keys{
      expression("friction", {0, 1, Ends::open_low}, "friction where no part acts, relative to that at rest")
          .without_it("that of the base; else one of the three is required"),
      expression("coefficient", {0, 5, Ends::open_low},
                 "the same as a coefficient: lateral over normal force"),
      expression("displacement_um", {0, 1000, Ends::closed, "um"},
                 "displacement under the finger where no part acts"),
      word("control", {"open", "closed"},
           "by the friction table alone, or corrected by the measured friction so that it is held")
          .by_default("\"open\"")
          .only_with("coefficient"),
      expression("resting_friction", {0.05, 3, Ends::closed},
                 "coefficient of friction of the surface at rest; in a closed loop, the first guess")
          .by_default("1"),
      number("resting_gain", {0, 1, Ends::closed},
             "share of the strength without a finger, and after a fault")
          .by_default("0"),
      tables("parts", follow_part(), "textures, edges and events, in order").holding(0, follow::kMostParts),
  };
  return table(
      "follow", keys,
      "the strength follows the finger: friction over place and time. The scene's own strength is the "
      "most that is used");
}

Key scene() {
  Keys tone{
      expression("boundary_mm", position_mm, "where its vibration ends").only_without("frequency_Hz"), edge(),
      expression("frequency_Hz", {0, 1e6, Ends::open_low, "Hz"}, "its frequency").only_without("boundary_mm"),
      expression("displacement_um", displacement_um, "peak displacement at its last maximum").required(),
      number("phase_deg", {-360, 360, Ends::closed, "degrees"}, "its phase").by_default("0")};
  return table(
      "NAME",
      {string("base",
              "scene from which everything is taken that this one does not state; of zone, tolerance and "
              "follow, each key"),
       expression("boundary_mm", position_mm, "where the smooth part ends, from the wide end"), edge(),
       expression("displacement_um", displacement_um,
                  "peak displacement at the last maximum, without a finger"),
       expression("friction", share, "instead of displacement_um: relative friction at the last maximum"),
       expression("displacement_under_finger_um", displacement_um,
                  "instead of both: peak displacement under a finger, as a mean over its contact; edge must "
                  "be a name"),
       expression("finger_mm", position_mm,
                  "where this finger is, from the wide end; required with displacement_under_finger_um"),
       tables("tones", tone.one_of({"boundary_mm", "frequency_Hz"}), "explicit tones"),
       table("zone",
             {number("from_mm", {0, 1e5, Ends::closed, "mm"}, "where it begins")
                  .without_it("that of the base; else required"),
              expression("friction", share, "mean relative friction inside")
                  .without_it("that of the base; else required"),
              integer("tones", 1, 16,
                      "largest number of tones; each fills gaps of the others; 3 is a good choice")
                  .without_it("that of the base; else required")},
             "a stretch of even friction that ends at boundary_mm"),
       expression(
           "friction_contrast_dB", {-std::numeric_limits<double>::infinity(), 0, Ends::open_high, "dB"},
           "contrast to the base: 20 log10(difference / friction of the base); -20 is a tenth less friction"),
       number("rove_dB", {0, 40, Ends::closed, "dB"},
              "the strength of each interval is drawn up to this much above or below, so that it is no cue")
           .by_default("0"),
       number("ramp_ms", {1, 2000, Ends::closed, "ms"},
              "length of the ramps at onset and end; below 20 the onset itself can be felt")
           .by_default("50"),
       table("tolerance",
             {number("boundary_mm", {0, 1000, Ends::open_low, "mm"}, "of the boundary"),
              number("level_dB", {0, 60, Ends::open_low, "dB"}, "of the level at the last maximum"),
              number("friction", share, "of the friction")},
             "the largest error that the physics model may have; the simplest model within it is used"),
       following()},
      "what the surface presents");
}

Keys part() {
  Keys keys{string("scene", "the scene that it presents").only_without("silence_s"),
            expression("duration_s", {0, 600, Ends::open_low, "s"}, "its length")
                .without_it("that of [task]; the last part of a single interval: until the answer")
                .only_with("scene"),
            number("first_s", {0, 600, Ends::open_low, "s"},
                   "its length in the first trial of a block, after a break, and after an interruption")
                .without_it("duration_s")
                .only_with("scene"),
            expression("silence_s", {0, 600, Ends::closed, "s"}, "instead of a scene: a silence")
                .only_without("scene")};
  return keys.one_of({"scene", "silence_s"});
}

Keys task() {
  const Words several_scenes{"3ifc", "4ifc", "same-different", "oddity", "abx", "match-to-sample"};
  const Words intervals{"single-interval", "2ifc", "comparison", "adjustment"};
  Keys number_keys = typed();
  number_keys.list.push_back(
      string("standard",
             "scene that begins each trial (with duration_s and gap_s); without it the modulus is free"));
  number_keys.list.push_back(
      number("modulus", {0, 1e6},
             "the number that stands for the standard; the page shows it above the question")
          .required()
          .only_with("standard"));
  const auto comparisons = [](const char* of, const char* help) {
    return table("", Keys{}.with_free_names(string(of, help)), "");
  };
  Keys keys{
      word("kind",
           {"single-interval", "2ifc", "3ifc", "4ifc", "same-different", "oddity", "abx", "match-to-sample",
            "comparison", "adjustment"},
           "what a trial is")
          .required(),
      list("intervals", {string("", ""), strings("", "").holding(1, 2)},
           "the scene of each interval, or the name of its parts; two scenes for a change after a foreperiod")
          .holding(1, 4)
          .required()
          .only_with("kind", intervals),
      string("standard", "the scene that most intervals present, or the name of its parts")
          .required()
          .only_with("kind", several_scenes),
      string("target", "the scene that differs, or the name of its parts")
          .required()
          .only_with("kind", several_scenes),
      word("odd", {"either", "target", "standard"}, "which scene may be the odd one")
          .by_default("\"either\"")
          .only_with("kind", {"oddity"}),
      expression("duration_s", {0, 600, Ends::open_low, "s"},
                 "length of each interval, and of each part without its own")
          .without_it("until the answer, in one interval; else required"),
      expression("gap_s", {0, 60, Ends::closed, "s"}, "silence between two intervals")
          .without_it("required with several intervals"),
      table("parts", Keys{}.with_free_names(tables("NAME", part(), "the parts of an interval, in order")),
            "intervals of several parts: scenes with silences between them"),
      tables("before", part(), "parts that each trial presents once, before its first interval")
          .only_with("kind", {"2ifc", "3ifc", "4ifc", "same-different", "oddity", "abx", "match-to-sample",
                              "comparison"}),
      time("foreperiod_s", "time before the second scene of an interval")
          .without_it("required with a second scene"),
      number("transition_ms", {1, 5000, Ends::closed, "ms"}, "length of the change to the second scene")
          .without_it("required with a second scene"),
      integer("again", 1, core::kMostAgain,
              "how often people may ask for the intervals of a trial again before they answer")
          .without_it("never"),
      word("device", {"touch", "buttons", "either"},
           "how people answer; buttons for response times, as a panel adds 50 ms and more")
          .required(),
      word("sound", {"none", "masking_noise"}, "noise on the rig's headphones while the surface vibrates")
          .by_default("\"none\""),
      localised("cue", "what the page says before each trial")
          .without_it("where to put the finger, or to get ready; required in blocks of several tasks"),
      expression("cue_s", {kCue_s, 60, Ends::closed, "s"}, "how long it does so, in silence")
          .without_it("0.8"),
      localised("question", "what is asked").required(),
      string("question_shows", "a factor whose value in the trial stands for %1 in the question"),
      choices("the answers").holding(1, most_choices),
      localised("unsure", "an answer for those who do not want to guess")
          .only_with("kind", {"2ifc", "3ifc", "4ifc", "oddity", "abx", "match-to-sample"}),
      several("correct", {string("", ""), comparisons("SCENE", "a comparison, such as \"change > 0\"")},
              "the scene whose interval is right; or a comparison for each of the two scenes, if the level "
              "decides it")
          .required()
          .only_with("kind", {"2ifc"}),
      several("correct", {comparisons("CHOICE", "a comparison, such as \"offset_mm < 0\"")},
              "for each choice, a comparison of factors that says when it is right; without it, answers are "
              "not scored")
          .only_with("kind", {"single-interval"}),
      string("present", "a comparison of factors: which trials have a signal; the others are noise")
          .only_with("rating"),
      string("adjusts", "the factor that the slider moves over its range")
          .required()
          .only_with("kind", {"adjustment"}),
      number("step", {0, 1e6, Ends::open_low}, "smallest step of the slider")
          .required()
          .only_with("kind", {"adjustment"}),
      table("rating", rating(), "a rating instead of choices"),
      table("number", number_keys, "magnitude estimation: a typed number instead of choices"),
      table("confidence",
            {localised("question", "what is asked after the answer").required(),
             list("labels", {localised("", "")},
                  "what the participant can say, from the least sure to the surest")
                 .holding(2, most_choices)
                 .required()},
            "a second question after each answer: how sure the participant is"),
  };
  return keys.some_of({"choices", "rating", "number"});
}

Keys timing() {
  Words zeros;
  for (const auto zero : core::response_zeros) zeros.emplace_back(core::name(zero));
  return {
      word("response_zero", zeros,
           "from when response times count: onset of the last interval, start of its second scene, its end, "
           "or (with a sensor) the finger's contact or lift-off")
          .required(),
      number("explore_s", {0, 600, Ends::open_low, "s"}, "one interval: the tones last at most this long"),
      expression("deadline_s", deadline_s,
                 "latest answer, from response_zero; a later one is a timeout and no error")
          .without_it("none")
          .only_without("response_signal"),
      table(
          "response_signal",
          {expression("after_s", {0.02, 60, Ends::closed, "s"},
                      "when the signal comes, from response_zero; factors in it must not decide which answer "
                      "is right")
               .required(),
           number("window_s", {0.05, 10, Ends::closed, "s"}, "answers count until this time after the signal")
               .required(),
           word("by", {"screen", "flash", "tone", "buzz"},
                "what the signal is: a band of the page, the whole page, a tone on the headphones, another "
                "scene")
               .by_default("\"screen\""),
           string("scene", "scene that the surface presents as the signal; it must not contain factors")
               .required()
               .only_with("by", {"buzz"}),
           number("length_ms", {20, 500, Ends::closed, "ms"}, "length of the buzz")
               .required()
               .only_with("by", {"buzz"})},
          "a signal to answer at once, instead of a deadline; trials answered too early or too late are "
          "repeated"),
      time("iti_s", "pause between trials").required(),
      table("delay_s",
            Keys{expression("wrong", delay_s, "after a wrong answer").by_default("0"),
                 expression("late", delay_s, "after a missed deadline").by_default("0"),
                 expression("early", delay_s, "after an answer that was too early").by_default("0")}
                .some_of({"wrong", "late", "early"}),
            "how much longer the pause is after trials that were not right"),
      expression("anticipation_s", {0, 10, Ends::closed, "s"},
                 "earlier answers are anticipations, and do not count")
          .by_default("0")
          .only_without("response_signal"),
  };
}

Keys payoff() {
  const auto points = [](const char* key, const char* help) {
    return expression(key, any_value, help).by_default("0");
  };
  return {
      expression("right", any_value, "points of a right answer").required(),
      points("wrong", "points of a wrong answer"),
      points("late", "points of a missed deadline"),
      points("early", "points of an answer that was too early"),
      points("unsure", "points of the answer \"unsure\" of [task]"),
      table("fast",
            {expression("below_s", {0, 600, Ends::open_low, "s"}, "for response times below this").required(),
             expression("points", any_value, "points").required()},
            "more points for right answers that are fast"),
      localised("text", "how a score is said, with %1 for its worth").without_it("\"%1 points\""),
      number("worth", {0, 1e6, Ends::open_low}, "worth of one point in this text").by_default("1"),
      integer("decimals", 0, 3, "decimals of the worth").by_default("0")};
}

Keys pass_of_trials() {
  return {
      number("accuracy", {0, 1, Ends::open_low}, "proportion of right answers needed to go on").required(),
      integer("retries", 0, 20, "how often the block is repeated at most; then the session ends").required()};
}

/// The keys of a block of trials; with the condition of a [[block]] if it may have another kind.
Keys trials(bool of_block) {
  Keys keys{
      strings("procedures", "procedures that choose the levels"),
      string("level", "instead of procedures: the factor of the fixed levels"),
      numbers("levels", any_value, "fixed levels, presented in shuffled order"),
      string("task", "which of [tasks] the trials with fixed levels ask")
          .without_it("[task]; required with [tasks]"),
      integer("trials", 1, 100000, "number of trials at most").without_it("until the procedures end"),
      number(
          "lasts_s", {10, 7200, Ends::closed, "s"},
          "the block ends with the trial in which its trials, with the pauses between them, have lasted this "
          "long; breaks, waits that the rig's limits impose, and void trials do not count")
          .without_it("until the procedures end"),
      word("feedback", {"none", "trial", "block"},
           "when the participant learns what was right: never, after each trial, after the block")
          .by_default("\"none\""),
      boolean("practice", "its trials are marked as practice and left out of all estimates"),
      table("pass", pass_of_trials(), "when practice is passed").only_with("practice", {"true"}),
      word("interleave", {"none", "random", "alternate", "passes"},
           "how several procedures are mixed: one after the other, at random, each in turn, or each once in "
           "a pass of random order")
          .without_it("required with several procedures"),
      table(
          "catch",
          Keys{number("rate", {0, 0.5, Ends::open_low}, "share of catch trials").required()}.with_free_names(
              several("FACTOR", {number("", any_value, ""), numbers("", any_value, "")}, "its easy levels")),
          "easy trials that show whether people pay attention"),
      string("instruction", "name of the [instructions.NAME] to show before the block"),
  };
  if (of_block)
    for (auto& key : keys.list) {
      if (key.conditions.empty()) key.only_with("kind", {"trials"});
    }
  return keys;
}

Key break_after() {
  return table("break_after",
               {integer("trials", 1, 100000, "trials before each break").required(),
                number("min_s", seconds, "its shortest length").by_default("0")},
               "a break after so many trials");
}

Keys block() {
  const Words strokes{"training", "friction-table"}, table_only{"friction-table"};
  const Range place{0, 10000, Ends::closed, "mm"};
  Keys keys{
      name("name", "a name, which is stored with the data"),
      word("kind", {"trials", "training", "friction-table"}, "what the block is").by_default("\"trials\"")};
  keys.and_also(trials(true));
  keys.and_also({
      break_after(),
      number("duration_s", {0.5, 20, Ends::closed, "s"},
             "length of each trial; the strokes of [sensing] must fit in it")
          .required()
          .only_with("kind", strokes),
      integer("strokes", 1, 200, "number of trials").by_default("10").only_with("kind", {"training"}),
      table("pass",
            {integer("strokes", 1, 200, "trials with a right movement that are needed to go on").required(),
             integer("retries", 0, 20, "how often the block is repeated at most; then the session ends")
                 .required()},
            "when the training is passed")
          .only_with("kind", {"training"}),
      string("scene", "the scene whose strength is changed; it must not contain factors")
          .required()
          .only_with("kind", table_only),
      number("from_mm", place, "displacement and friction are averaged from here ...")
          .required()
          .only_with("kind", table_only),
      number("to_mm", place, "... to here, at least 20 mm further").required().only_with("kind", table_only),
      numbers("displacement_um", {0, 100, Ends::open_low, "um"},
              "displacements (rms) to measure, the smallest first")
          .holding(3)
          .required()
          .only_with("kind", table_only),
      integer("repeats", 3, 50, "trials at each displacement").by_default("6").only_with("kind", table_only),
      boolean("use", "later trials of the session are planned with the measured table instead of the rig's")
          .only_with("kind", table_only),
  });
  return keys.and_also(audience());
}

Keys sequence() {
  auto below = trials(false);
  below.list.push_back(break_after());
  Keys keys{
      name("name", "a name, which is stored with the data"),
      word("design", {"latin-square"},
           "how the order differs between participants: a Williams square, in which each level follows each "
           "other one equally often")
          .required(),
      string("over", "the factor that differs between the blocks").required(),
      integer("cycles", 1, 100, "how often all levels run").by_default("1"),
      boolean("mirror", "every second cycle runs backwards (A B B A), so that fatigue cancels out"),
      word("each_session", {"all", "one"},
           "with [sessions]: each session has all levels, or one, and the square orders the sessions")
          .by_default("\"all\""),
      table("block", below, "what each block presents").required(),
  };
  return keys.and_also(audience());
}

Keys procedure() {
  Keys keys{
      name("name", "a name, which is stored with the data"),
      string("copy", "procedure above, from which everything is taken that this one does not state"),
      word("kind", procedure::kind_names(), "how it chooses levels")
          .without_it("that of the copied one; else required"),
      string("level", "the factor that it sets").without_it("that of the copied one; else required"),
      string("task", "which of [tasks] its trials ask").without_it("[task]; required with [tasks]"),
  };
  keys.and_also(procedure::procedure_keys());
  return keys.and_also({
      by_factor("with", "values that other factors have in all of its trials"),
      string("for_each",
             "a factor: the table becomes one procedure for each of its levels, called NAME-LEVEL"),
      boolean("continues",
              "goes on, in the next planned session, from the state in which the last one left it"),
  });
}

Keys questionnaire() {
  Keys item{
      name("id", "what is stored with the answer"),
      localised("question", "what is asked").required(),
      choices("the answers").holding(2, most_choices),
      table("rating", rating(), "a rating"),
      table("number", typed(), "a typed number"),
      one_or_more(
          "when",
          "comparisons with answers and scores above, such as \"hand == left\"; it is asked if all are true"),
      several("simulated", {string("", ""), number("", any_value, "")}, "what the simulated observer answers")
          .without_it("a random answer")};
  Keys keys{name("name", "a name, which is stored with the data"),
            string("after_each",
                   "block or sequence: it comes after each of its blocks, wherever it stands in the file"),
            tables("item", item.one_of({"choices", "rating", "number"}), "its questions")
                .required()
                .holding(1, 200)};
  return keys.and_also(audience());
}

Keys explanation() {
  Keys example{localised("label", "what the button says").required(),
               string("scene", "the scene to present").required(),
               by_factor("with", "values of the factors on which the scene depends"),
               number("duration_s", {0.2, 10, Ends::closed, "s"}, "how long").by_default("2")};
  Keys keys{
      name("name", "a name, which is stored with the data"),
      string("after_each",
             "block or sequence: it comes after each of its blocks, wherever it stands in the file"),
      tables("page",
             {localised("text", "what it says").required(),
              string("picture", "PNG or JPEG file, as seen from this file"),
              tables("examples", example, "buttons with which a stimulus can be felt, as often as wished")
                  .holding(0, 4)},
             "its pages")
          .required()};
  return keys.and_also(audience());
}

Keys consent() {
  Keys keys{name("name", "a name, which is stored with the data"),
            localised("text", "what people agree to").required(),
            localised("agree", "what the button says that agrees").required(),
            localised("refuse", "what the other button says").required(),
            localised("farewell", "what is said to those who refuse; the session then ends").required()};
  return keys.and_also(audience());
}

Keys screening() {
  Keys keys{
      name("name", "a name, which is stored with the data"),
      one_or_more("pass", "comparisons that must all hold, such as \"practice.accuracy >= 0.8\"").required(),
      localised("farewell", "what is said to those who do not pass; the session then ends").required()};
  return keys.and_also(audience());
}

Key seed() {
  auto whole = integer("", 0, 0, "");
  whole.range.high = 9007199254740992;
  return several("seed", {word("", {"per-session"}, ""), whole},
                 "\"per-session\": a new seed is drawn and stored, as without [random]; a number: the same "
                 "order each time")
      .required();
}

const Keys& all() {
  static const Keys keys{
      word("format", {"friction-protocol/1"}, "the version of this format").required(),
      table("protocol",
            {name("id", "a short name; exported data are written to a folder with this name"),
             string("version", "a text such as \"1.0.0\"; increase it with each change").required(),
             string("title", "a title for the researcher").required(),
             strings("languages", "the languages of all texts, such as [\"en\", \"ja\"]").required()},
            "what the study is")
          .required(),
      table("random", {seed()}, "the seed of all draws"),
      tables("factor", factor(), "what can differ between trials"),
      table("scene", Keys{}.with_free_names(scene()).holding(1),
            "what the surface presents: one table [scene.NAME] for each scene")
          .required(),
      table("task", task(), "what a trial is and how people answer").required().only_without("tasks"),
      table("tasks", Keys{}.with_free_names(table("NAME", task(), "one of several tasks")).holding(2),
            "several tasks, instead of [task]; each procedure names its own"),
      table("timing", timing(), "when things happen in a trial").required(),
      table("payoff", payoff(), "points for answers"),
      tables("procedure", procedure(), "how levels are chosen"),
      tables("block", block(), "blocks of trials"),
      tables("sequence", sequence(), "counterbalanced blocks, one for each level of a factor"),
      table("instructions",
            Keys{}.with_free_names(table(
                "NAME",
                {localised("text", "what is said before a block").required(),
                 localised("late_message",
                           "what the page says after a missed deadline, instead of the station's words"),
                 expression("deadline_s", deadline_s,
                            "latest answer in these blocks; missed ones are then data, and fixed levels do "
                            "not come again")
                     .without_it("that of [timing]"),
                 interval("target_accuracy", {0, 1},
                          "accuracy to aim at: a note for you, which check compares with guessing"),
                 table("goal",
                       Keys{number("accuracy_above", share, "proportion of right answers"),
                            number("median_time_below_s", {0, 600, Ends::open_low, "s"},
                                   "median response time")}
                           .some_of({"accuracy_above", "median_time_below_s"}),
                       "what to reach in a block: said before it, and at its end whether it was reached")},
                "an instruction")),
            "instructions of blocks"),
      table(
          "analysis",
          {one_or_more("by",
                       "factors with levels: a curve and scores for each combination, and their differences")
               .without_it("each instruction"),
           expression("difficulty", {-1e9, 1e9},
                      "arithmetic with the same value for equally difficult trials: the diffusion model has "
                      "a drift for each")
               .without_it("the size of the level"),
           words("show",
                 {"psychometric", "ez", "bis", "lisas", "ies", "caf", "dprime", "response-signal", "trace"},
                 "parts of the report")
               .without_it("all that apply"),
           word("pairs", {"bradley-terry", "thurstone"},
                "how comparisons of pairs are scaled: in log odds, or in standard deviations of what one "
                "stimulus is "
                "felt as (case V)")
               .by_default("\"bradley-terry\""),
           word("incomplete_sessions", {"leave_out", "count"},
                "whether a report of a study counts sessions that were not completed")
               .without_it("as [sessions] says"),
           word(
               "holm", {"measure", "all"},
               "which differences between conditions have their p values corrected together for their number "
               "(Holm): those of each measure, or all of a table")
               .without_it("no correction"),
           table(
               "response_time_exclude",
               {number("below_s", {0, 10, Ends::closed, "s"}, "shorter times").by_default("0"),
                number(
                    "mad", {0, 100, Ends::open_low, "median absolute deviations"},
                    "times further from the median than this many median absolute deviations (times 1.4826)")
                    .without_it("none")},
               "times that means, medians and scores leave out; the fit of the diffusion model has all")},
          "what the report shows"),
      table(
          "exclusion",
          Keys{
              integer("fewer_trials_than", 1, 100000, "fewer answered trials"),
              number("accuracy_below", share, "a lower proportion of right answers"),
              number("catch_accuracy_below", {0, 1, Ends::open_low}, "the same, in catch trials"),
              number("timeouts_above", {0, 1, Ends::open_high}, "a larger share of trials answered too late"),
              number("anticipations_above", {0, 1, Ends::open_high},
                     "a larger share of trials answered too early"),
              number("median_time_below_s", {0, 600, Ends::open_low, "s"}, "a shorter median response time"),
              number("median_time_above_s", {0, 600, Ends::open_low, "s"}, "a longer median response time"),
              boolean("incomplete", "a session that was neither completed nor begun again later")}
              .holding(1),
          "participants that a report of a study leaves out: those with ... (over all trials but practice)"),
      table("resume",
            {word("incomplete", {"ask", "resume", "restart", "block"},
                  "what becomes of an interrupted session: the operator chooses, it goes on, it or its block "
                  "begins again")
                 .by_default("\"ask\""),
             number("max_age_h", {0, 8760, Ends::open_low, "h"},
                    "how long after its interruption it can be resumed")
                 .by_default("24"),
             integer("warmup", 0, 100, "easy trials after resuming, which do not count").by_default("0"),
             word("restart_unit", {"block"},
                  "a resumed session begins the interrupted block again; its rows are kept and marked")
                 .without_it("the next trial comes")},
            "interrupted sessions"),
      table(
          "sensing",
          {interval("normal_N", {0.1, 5, Ends::closed, "N"}, "normal force of the finger").without_it("any"),
           interval("speed_mm_s", {10, 1000, Ends::closed, "mm/s"}, "speed of the strokes").without_it("any"),
           number("fraction", {0, 1, Ends::open_low},
                  "share of the strokes' time for which force, and speed, must be in range")
               .by_default("0.8"),
           integer("strokes", 1, 100,
                   "least number of strokes of a trial; one is 30 mm or longer and faster than 10 mm/s")
               .by_default("2"),
           word("outside", {"mark", "repeat"},
                "a trial with another movement counts, and its row says what was wrong; or it is repeated")
               .by_default("\"mark\""),
           integer("repeats", 1, 10, "how often a trial is repeated at most; then it counts")
               .by_default("2")
               .only_with("outside", {"repeat"}),
           boolean("guidance",
                   "shows the participant bars of normal force and speed, and a block that slides at the "
                   "right speed"),
           boolean("live_guidance", "the bars move during stimuli, too").only_with("guidance", {"true"})},
          "how the finger should move"),
      table("triggers",
            {words("send", trigger_event_names(), "events that get a code")
                 .by_default("[\"trial\", \"onset\", \"change\", \"response\"]")
                 .holding(1),
             tables("code",
                    {word("event", trigger_event_names(), "the event").required(),
                     string("condition", "a level of by, or an instruction")
                         .without_it("trials that belong to none"),
                     integer("code", 1, 255, "its code").required()},
                    "codes that differ from the default ones")
                 .holding(0)},
            "codes for an EEG amplifier or a recorder"),
      tables("consent", consent(), "a page on which people agree"),
      tables("questionnaire", questionnaire(), "questions"),
      tables("explanation", explanation(), "pages that explain"),
      tables("screening", screening(), "ends the session of those who do not fit"),
      table("sessions",
            {integer("count", 2, 100, "planned sessions of each participant").required(),
             integer("min_days", 0, 366,
                     "calendar days from one session to the next, at least; 1: not on the same day")
                 .by_default("0"),
             word("incomplete", {"repeat", "count"},
                  "a session that was begun and is not resumed: it comes again from its beginning, or counts "
                  "as done")
                 .by_default("\"repeat\"")},
            "several visits"),
      table("assignment",
            {number("dropout_after_h", {0, 100000, Ends::open_low, "h"},
                    "how long after the last session a participant who has not completed is expected; then a "
                    "new participant gets the same group and orders")
                 .required()},
            "who gets which group and orders: those with the fewest participants who have completed or are "
            "expected"),
  };
  return keys;
}

}  // namespace
}  // namespace declarations

const core::Keys& protocol_keys() { return declarations::all(); }

}  // namespace turnpoint::protocol
