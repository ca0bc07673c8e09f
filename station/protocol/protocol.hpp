#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "station/core/problem.hpp"
#include "station/core/trial.hpp"
#include "station/procedure/spec.hpp"
#include "station/protocol/meaning.hpp"
#include "station/protocol/scene.hpp"
#include "station/protocol/session_plan.hpp"

namespace turnpoint::protocol {

/// A text in each of the protocol's languages.
using Localised = std::map<std::string, std::string>;

/// A fixed value, a uniform distribution between two values, or an expression of the trial's factors.
struct Distribution {
  double low = 0, high = 0;          ///< of an expression: the smallest and the largest value
  std::optional<Linear> expression;  ///< empty if the value does not depend on factors
};

enum class TaskKind {
  single_interval,
  two_interval,
  several_intervals,  ///< 3ifc and 4ifc: one of the intervals presents the target, the others the standard
  same_different,
  oddity,
  abx,              ///< standard and target in either order, then one of them again: which was it?
  match_to_sample,  ///< the same, but the one to be matched comes first
  /// two to four intervals in a fixed order: which of two is more, or which of two differences is larger? No
  /// answer is right
  comparison,
  adjustment
};
enum class Device { touch, buttons, either };
enum class Sound { none, masking_noise };
enum class Odd { target, standard, either };

/// The largest number of answers to one question.
constexpr int most_choices = 9;

struct Choice {
  std::string id;
  Localised label;
};

/// The text at one value of a rating scale.
struct Anchor {
  double at = 0;
  Localised text;
};

/// An answer that is a number: a mark on a line, or a number typed on a pad.
struct ValueAnswer {
  bool typed = false;
  double low = 0, high = 1;
  int decimals = 0;             ///< values are multiples of 10^-decimals
  std::vector<Anchor> anchors;  ///< texts along the line, in the order of their values
};

/// The id of the answer Task::unsure.
inline constexpr const char* kUnsure = "unsure";

/// Asks after each answer how sure the participant is.
struct Confidence {
  Localised question;
  std::vector<Localised> labels;  ///< the possible answers, from the least sure to the surest
};

/// A part of an interval that is presented without a pause: a scene, or two of which the second follows the
/// first.
struct Part {
  std::vector<std::string> scenes;
  /// its length; empty if it is that of the task, or if it lasts until the answer
  std::optional<Linear> duration_s;
  /// its length in the first trial of a block, after a break, and after an interruption
  std::optional<double> first_s;
  std::vector<Linear> silences_s;  ///< silences before it
};

/// How long the page shows the get-ready cue, the feedback, and the message after a late answer.
inline constexpr double kCue_s = 0.8, kFeedback_s = 0.8, kLate_s = 1.0;

struct Task {
  std::string name;  ///< "" if the file has one task
  /// What the page says before each trial; if empty, the station's own words.
  Localised cue;
  Linear cue_s{kCue_s, {}, {}, false, {}, {}};  ///< how long it does so: at least kCue_s
  TaskKind kind = TaskKind::single_interval;
  /// The scene of each interval, or two scenes of which the second follows the first, or the name of `parts`
  std::vector<std::vector<std::string>> intervals;
  std::map<std::string, std::vector<Part>> parts;  ///< intervals of several parts, by their names
  /// parts that a trial presents once, before its first interval, and the silences between them and it
  std::vector<Part> before;
  std::vector<Linear> before_silences_s;
  /// the two scenes that the task compares, if its kind has a standard and a target
  std::string standard, target;
  Odd odd = Odd::either;
  /// length of each interval or part that has no length of its own, and silence between two intervals
  std::optional<Linear> duration_s, gap_s;
  std::optional<Distribution> foreperiod_s;  ///< time from the start of an interval to its second scene
  std::optional<double> transition_ms;
  int again = 0;  ///< how often a participant may ask for the intervals of a trial again
  Device device = Device::touch;
  Place device_place;
  Sound sound = Sound::none;  ///< sound that is played while the surface vibrates
  Place sound_place;
  Localised question;
  std::string question_shows;  ///< the factor whose value stands for %1 in the question; "" if there is none
  /// If the answer is a value, there is one choice, which says that a value was given.
  std::vector<Choice> choices;
  /// What the participant may answer instead of guessing; empty if everybody must choose. It is no choice,
  /// but comes after the choices on the page, and its index is their number.
  Localised unsure;
  /// for a rating: texts at some of the choices, which are the points 1, 2, ...
  std::vector<Anchor> anchors;
  bool rating = false;  ///< true if the choices are the points of a scale, in ascending order
  /// for a rating from the surest no to the surest yes: the trials that have a signal; the others are noise
  std::optional<Comparison> present;
  std::optional<ValueAnswer> value;
  /// the number that stands for `standard`, the scene at the start of each trial
  std::optional<double> modulus;
  std::optional<Confidence> confidence;
  std::string correct_scene;  ///< 2ifc: the interval that contains this scene is the correct answer
  /// Id of each choice, with the condition under which the choice is right. For 2ifc without `correct_scene`,
  /// the name of each scene, with the condition under which its interval is right
  std::vector<std::pair<std::string, Comparison>> correct_answer;
  /// For adjustment only: the factor that the slider moves, its range and step.
  std::string adjusts;
  std::optional<double> step;
};

using core::ResponseZero;

/// A signal to answer at once, for measuring how accuracy grows with the time for which people may think. An
/// answer counts from the signal to the end of the window; earlier and later ones make the trial void, and it
/// is repeated.
struct ResponseSignal {
  Linear after_s;  ///< time of the signal in s, counted from response_zero
  double window_s = 0;
  /// A band on the screen, a flash of the whole screen, a tone on the rig's headphones, or a buzz of the
  /// surface. Tone and buzz are part of the stimulus and begin on the very frame.
  enum class By { screen, flash, tone, buzz };
  By by = By::screen;
  Place by_place;
  std::string scene;    ///< buzz: the scene that the surface presents, in place of the last scene
  double length_s = 0;  ///< buzz: how long it does so; then the last scene returns
};

/// True if the signal is part of the stimulus, so that it begins on the very frame.
inline bool in_stimulus(const ResponseSignal& signal) {
  return signal.by == ResponseSignal::By::tone || signal.by == ResponseSignal::By::buzz;
}

/// What the pause before the next trial is longer by, after a trial that was not right.
struct Delay {
  Linear wrong, late, early;
};

struct Timing {
  ResponseZero response_zero = ResponseZero::go_cue;
  Place response_zero_place;
  /// for a single interval: the longest time for which the tones are presented
  std::optional<double> explore_s;
  /// deadline of the answer, counted from response_zero; empty if each instruction gives its own deadline, or
  /// if there is a response signal
  std::optional<Linear> deadline_s;
  Distribution iti_s;
  Delay delay_s;
  Linear anticipation_s;
  std::optional<ResponseSignal> signal;
};

/// What a trial is worth to the participant, in points. The score is the sum over all trials outside
/// practice.
struct Payoff {
  /// points of a right answer, of a wrong one, of one that came too late, and of one that came too early
  Linear right, wrong, late, early;
  Linear unsure;  ///< points of the answer Task::unsure
  /// points that a right answer is worth beyond `right` if its response time is below `below_s`
  struct Fast {
    Linear below_s, points;
  };
  std::optional<Fast> fast;
  Localised text;    ///< how pages say a score, with %1 for its worth; if empty, "%1 points"
  double worth = 1;  ///< what one point is worth in `text`, such as an amount of money
  int decimals = 0;  ///< decimals of the worth
};

enum class Feedback { none, trial, block };
enum class Interleave {
  none,       ///< one after the other
  random,     ///< any procedure that has not ended
  alternate,  ///< each in turn
  passes      ///< each once per pass, in random order
};

struct Catch {
  double rate = 0;
  std::string factor;
  std::vector<double> levels;
};

struct Pass {
  double accuracy = 0;
  int retries = 0;
};

struct Break {
  int trials = 0;
  double min_s = 0;
};

/// What a block is for. In blocks other than `trials` nothing is asked: the finger strokes the surface.
enum class BlockKind {
  trials,
  training,       ///< practice of the movement that [sensing] asks for, on the surface at rest
  friction_table  ///< measures friction at several displacements, with this finger on this surface
};

/// How the finger strokes in a block of strokes (any block that is not of the kind `trials`).
struct Strokes {
  double duration_s = 0;  ///< length of each trial
  std::string scene;      ///< friction table: the scene whose strength is changed
  /// Friction table: the part of the surface in which displacement and friction are averaged.
  double from_mm = 0, to_mm = 0;
  std::vector<double> levels_um;  ///< friction table: displacements, as rms from from_mm to to_mm, ascending
  int repeats = 0;                ///< friction table: number of trials at each displacement
  /// Friction table: trials after the block are planned with the measured table instead of the rig's.
  bool used = false;
  bool operator==(const Strokes&) const = default;
};

/// A block as it runs for one participant. block_order() makes such blocks from the `sequence` tables of the
/// file.
struct Block {
  std::string name;
  BlockKind kind = BlockKind::trials;
  Strokes strokes;  ///< how the finger strokes, in blocks of a kind other than `trials`
  std::vector<std::string> procedures;
  std::string task;            ///< with fixed levels: the name of their task, if the file has several
  std::string level;           ///< for practice with fixed levels: the factor to which the levels belong
  std::vector<double> levels;  ///< the fixed levels, presented in shuffled order
  std::optional<int> trials;
  /// The block ends with the trial in which its trials have lasted this long together, pauses between them
  /// included. Breaks, waits that the rig's limits impose, and void trials do not count.
  std::optional<double> lasts_s;
  Feedback feedback = Feedback::none;
  bool practice = false;
  std::optional<Pass> pass;
  Interleave interleave = Interleave::none;
  std::optional<Catch> catch_trials;
  std::optional<Break> break_after;
  Audience audience;  ///< the sessions and groups that have this block
  Factors fixed;      ///< factors that the sequence sets for the whole block, such as instruction = "speed"
  /// index of the part of the plan (a block or a sequence) from which block_order() made the block
  std::size_t part = 0;
  Place place;
};

struct Sequence {
  std::string name;
  std::string over;  ///< the factor whose level differs between the blocks of the sequence
  int cycles = 1;
  bool mirror = false;
  bool one_per_session = false;  ///< each session has one level; the Latin square orders the sessions
  Block block;
};

/// What the participant is to reach in a block: a higher proportion of right answers, and a shorter median
/// response time.
struct Goal {
  std::optional<double> accuracy_above, median_time_below_s;
};

struct Instruction {
  Localised text, late_message;
  std::optional<Linear> deadline_s;
  std::optional<std::pair<double, double>> target_accuracy;  ///< for the researcher
  std::optional<Goal> goal;  ///< for the participant, who learns at the end of a block whether it was reached
};

/// A condition on an earlier answer ("about-you.age") or on the proportion correct in a block
/// ("practice.accuracy").
struct AnswerCondition {
  std::string about;
  Relation relation = Relation::equal;
  bool unequal = false;  ///< true for the comparison `!=`; `relation` is then `equal`
  FactorValue value;
  std::string source;
  Place place;
};

/// A scale of points (`choices`, which are 1, 2, ...) or a line (`value`).
struct Scale {
  std::vector<Choice> choices;
  std::vector<Anchor> anchors;  ///< texts at some of the points of the scale
  std::optional<ValueAnswer> value;
};

/// One question of a questionnaire. It has choices or, if the answer is a number, a `value`.
struct Item {
  std::string id;
  Localised question;
  std::vector<Choice> choices;
  bool rating = false;          ///< true if the choices are the points of a scale, in ascending order
  std::vector<Anchor> anchors;  ///< texts at some of the points of the scale
  std::optional<ValueAnswer> value;
  std::vector<AnswerCondition> when;  ///< the item is asked only if all of these conditions hold
  /// what a simulated participant answers; if empty, the answer is drawn at random
  std::optional<FactorValue> simulated;
  Place place;
};

/// A stimulus that the participant can feel as often as wished.
struct Example {
  Localised label;
  std::string scene;
  Factors with;  ///< values of the factors on which the scene depends
  double duration_s = 2;
};

/// One page of an explanation.
struct ExplanationPage {
  Localised text;
  std::string picture;  ///< path of a picture, relative to the protocol file; "" if there is none
  std::vector<Example> examples;
  Place place, picture_place;
};

enum class InterludeKind { questionnaire, consent, explanation, screening };

/// A part of the session before, between or after the blocks, such as a questionnaire.
struct Interlude {
  InterludeKind kind = InterludeKind::questionnaire;
  std::string name;
  /// number of parts of the plan (blocks and sequences) that are above the interlude in the file
  std::size_t above = 0;
  Audience audience;       ///< the sessions and groups that have this interlude
  std::string after_each;  ///< name of a block or sequence: the interlude comes after each of its blocks
  /// items of a questionnaire; a consent has a single item, "consent", with the choices agree and refuse
  std::vector<Item> items;
  std::vector<ExplanationPage> pages;
  /// for a screening: the session continues if all of these conditions hold
  std::vector<AnswerCondition> pass;
  /// text for a participant who has refused the consent, or did not pass the screening
  Localised farewell;
  Place place;
};

/// Which comparisons of a report are corrected together for their number, by Holm's method.
enum class Holm { none, measure, all };

struct Analysis {
  std::vector<std::string> by;  ///< factors with levels: each combination of them is analysed separately
  std::optional<Linear> difficulty;
  /// parts of the report to show; if empty, all parts that suit the task are shown
  std::optional<std::vector<std::string>> show;
  /// Whether the report of a study counts sessions that were not completed. A session that was superseded
  /// (the participant began the same session again later) never counts.
  bool count_incomplete = false;
  Holm holm = Holm::none;
  /// how pairs are scaled: logistic for Bradley and Terry, normal for Thurstone
  core::Function pairs = core::Function::logistic;
  double exclude_below_s = 0;
  std::optional<double> exclude_mad;
};

/// The rules by which the report of a study leaves out participants. Shares and medians are over all trials
/// of a participant, without practice. An empty rule excludes nobody.
struct Exclusion {
  std::optional<int> fewer_trials_than;  ///< number of answered experimental trials
  /// proportion correct in the answered experimental trials
  std::optional<double> accuracy_below;
  /// proportion correct in the answered catch trials
  std::optional<double> catch_accuracy_below;
  std::optional<double> timeouts_above, anticipations_above;  ///< proportions of the experimental trials
  std::optional<double> median_time_below_s, median_time_above_s;
  bool incomplete = false;  ///< exclude participants who did not complete a session
};

enum class ResumePolicy { ask, resume, restart, block };

struct Resume {
  ResumePolicy incomplete = ResumePolicy::ask;
  double max_age_h = 24;
  int warmup = 0;
  std::string restart_unit;  ///< "block" if a resumed session restarts the interrupted block, otherwise ""
};

/// Events for which the station can send a trigger code: a trial begins, an interval begins, an interval
/// changes to its next scene, the participant answers.
enum class TriggerEvent { trial, onset, change, response };

/// The trigger code of one event in the trials of one condition.
struct TriggerCode {
  TriggerEvent event = TriggerEvent::trial;
  /// the condition's name, as in conditions(); "" for trials that belong to no condition
  std::string condition;
  int code = 0;  ///< the code, from 1 to 255
};

/// Which events get a trigger code, and the codes that the file gives explicitly instead of the defaults.
struct Triggers {
  std::vector<TriggerEvent> send{TriggerEvent::trial, TriggerEvent::onset, TriggerEvent::change,
                                 TriggerEvent::response};
  std::vector<TriggerCode> stated;
  Place place;
};

/// The movement that the protocol asks for, on rigs that measure the finger.
struct Sensing {
  /// range of the normal force and of the speed; empty: any value is accepted
  std::optional<std::pair<double, double>> normal_N, speed_mm_s;
  double fraction = 0.8;  ///< required fraction of the strokes' time with force and speed in range
  int strokes = 2;        ///< least number of strokes in a trial
  /// How often a trial with a wrong movement is presented again. If the movement is still wrong in the last
  /// repetition (or in the first presentation, if `repeats` is 0), the trial counts, and its row says what
  /// was wrong.
  int repeats = 0;
  /// Whether pages show bars with normal force and speed, and whether the bars also move during stimuli.
  bool guidance = false, live_guidance = false;
  Place place;
};

/// A complete and checked protocol file. Everything that it refers to by name exists.
struct Protocol {
  std::string path, source, sha256;
  std::string id, version;
  std::string title;
  std::vector<std::string> languages;
  /// seed of the random numbers; empty if each session has its own ("per-session")
  std::optional<std::uint64_t> seed;
  std::vector<Factor> factors;  ///< factors in the order of the file
  std::map<std::string, Scene> scenes;
  Task task;
  /// If the file has several tasks: this protocol as each of them sees it, in the order of the file. `task`
  /// of such a part is that task, and it has only the procedures and blocks that ask it, with meanings of
  /// their own. Empty if the file has one task. See tasks.hpp.
  std::vector<Protocol> by_task;
  Timing timing;
  std::optional<Payoff> payoff;
  std::vector<procedure::Spec> procedures;
  std::optional<SessionPlan> sessions;  ///< empty: the protocol does not say how many sessions there are
  /// time after which a participant who has not completed is replaced (assignment()); empty: never
  std::optional<double> dropout_after_h;
  std::vector<std::variant<Block, Sequence>> plan;  ///< blocks and sequences in the order of the file
  std::map<std::string, Instruction> instructions;
  std::vector<Interlude> interludes;  ///< all interludes in the order of the file
  Analysis analysis;
  std::optional<Exclusion> exclusion;
  Triggers triggers;
  std::optional<Sensing> sensing;
  Resume resume;
  std::vector<std::string> defaults_used;
  /// what the trials measure, one entry for each analysis; follows from everything above (meanings_of())
  std::vector<Meaning> meanings;
};

/// Reads and checks a protocol file (format "friction-protocol/1"): syntax, keys, types, ranges, references.
/// Throws core::BadInput with all problems at once, or std::system_error if the file cannot be read.
Protocol load(const std::string& path);

/// Like load(), for text that is already in memory (a resumed session). `path` is only used in messages.
Protocol parse(const std::string& source, const std::string& path);

/// Returns the blocks of this visit's session in order: those for its session number and group. Each sequence
/// is expanded by its Latin square, its cycles and `mirror`.
std::vector<Block> block_order(const Protocol& protocol, const Visit& visit);

}  // namespace turnpoint::protocol
