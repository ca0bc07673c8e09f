#include "tests/ui/gallery.hpp"

#include <algorithm>
#include <utility>

#include "station/core/texts.hpp"
#include "tests/ui/gallery_parts.hpp"

namespace turnpoint::ui {

namespace {

Page oddity(const Words& words, PageKind kind, int interval) {
  Page page = base(words, kind);
  page.interval = {interval, 3, {}};
  if (kind == PageKind::response) {
    page.text = words.pick("Which of the three felt different?", "Welcher der drei fühlte sich anders an?",
                           "三つのうちどれが違いましたか?");
    page.answers = {{"1", words.pick("1st", "Erster", "1番目")},
                    {"2", words.pick("2nd", "Zweiter", "2番目")},
                    {"3", words.pick("3rd", "Dritter", "3番目")}};
    page.answers_open = true;
  }
  return page;
}

Page abx(const Words& words, PageKind kind) {
  Page page = oddity(words, kind, 3);
  page.interval.names = {"A", "B", "X"};
  page.text =
      words.pick("Was X like A or like B?", "War X wie A oder wie B?", "Xは、AとBのどちらと同じでしたか?");
  page.answers = {{"a", words.pick("Like A", "Wie A", "Aと同じ")},
                  {"b", words.pick("Like B", "Wie B", "Bと同じ")}};
  return page;
}

Page smoothness(const Words& words, PageKind kind) {
  Page page = base(words, kind);
  page.text = words.pick("How smooth does the strip feel?", "Wie glatt fühlt sich der Streifen an?",
                         "帯はどのくらいなめらかに感じますか?");
  page.answers_open = true;
  return page;
}

void add_judgements(std::vector<Exhibit>& all, const Words& words) {
  const auto none = words.pick("not smooth at all", "überhaupt nicht glatt", "全くなめらかでない");
  const auto most = words.pick("as smooth as can be", "so glatt wie nur möglich", "これ以上なくなめらか");
  for (const int points : {5, 7, 9}) {
    Page page = smoothness(words, PageKind::response);
    for (int i = 1; i <= points; ++i) page.answers.push_back({std::to_string(i), std::to_string(i)});
    page.answers.front().caption = words.pick("not at all", "überhaupt nicht", "全く");
    page.answers[static_cast<std::size_t>(points) / 2].caption = words.pick("medium", "mittel", "中間");
    page.answers.back().caption = words.pick("very", "außerordentlich", "とても");
    all.push_back({"rating-" + std::to_string(points), page});
    if (points == 7) {
      page.kind = PageKind::stimulus;
      all.push_back({"rating-7-explore", page});
    }
  }
  Page line = smoothness(words, PageKind::line);
  line.value = {0, 100, 0, {0, 1}, {none, most}, ""};
  all.push_back({"line", line});
  line.value.places = {0, 0.25, 0.5, 1};
  line.value.texts = {none, words.pick("a little", "ein wenig", "少し"),
                      words.pick("medium", "mittel", "中間"), most};
  all.push_back({"line-labels", line});
  Page number = smoothness(words, PageKind::number);
  number.text = words.pick("Which number fits its smoothness? Twice as smooth: twice the number.",
                           "Welche Zahl passt zur Glätte? Doppelt so glatt: doppelte Zahl.",
                           "なめらかさに合う数はいくつですか? 二倍なめらかなら二倍の数です。");
  number.value = {0.1, 1000, 1, {}, {}, ""};
  all.push_back({"number", number});
  number.again = number.offers_again = true;
  all.push_back({"number-again", number});
  number.again = number.offers_again = false;
  number.value.decimals = 0;
  number.value.first = core::text("first_is", words.language);
  number.value.first.replace(number.value.first.find("%1"), 2, "10");
  all.push_back({"number-standard", number});
  Page sure = base(words, PageKind::confidence);
  sure.answers_open = true;
  sure.text = words.pick("How sure are you?", "Wie sicher sind Sie?", "どのくらい確かですか?");
  sure.answers = {{"1", words.pick("guessed", "geraten", "勘")},
                  {"2", words.pick("not very", "nicht sehr", "あまり")},
                  {"3", words.pick("quite", "ziemlich", "かなり")},
                  {"4", words.pick("certain", "vollkommen", "確か")}};
  all.push_back({"confidence", sure});
  Page many = base(words, PageKind::response);
  many.answers_open = true;
  many.text = words.pick("Which pattern was it?", "Welches Muster war es?", "どの模様でしたか?");
  for (int i = 1; i <= 9; ++i)
    many.answers.push_back(
        {std::to_string(i), words.pick("Pattern ", "Muster ", "模様") + std::to_string(i)});
  all.push_back({"choices-9", many});
  many.answers.resize(4);
  all.push_back({"choices-4", many});
  // the longest labels about which `check` says nothing
  const auto label = words.pick("Unpredictable vibrations, intermediate roughness ",
                                "Ungleichmäßig raue Schwingungen, Wahrnehmungen ",
                                "全体に不規則な振動があり端のほうは少しざらざら");
  many.answers.clear();
  for (int i = 1; i <= 9; ++i) many.answers.push_back({std::to_string(i), label + std::to_string(i)});
  all.push_back({"choices-9-long", many});
}

/// Adds the bars that guide the finger, for a finger that presses well but moves too slowly.
Page guided(Page page, bool frozen = false) {
  session::Guidance bars;
  bars.force = session::Guidance::Bar{0.5, 0.36, 0.67};
  bars.speed = session::Guidance::Bar{0.12, 0.22, 0.67};
  bars.pace_mm_s = 80;
  bars.frozen = frozen;
  page.guidance = bars;
  return page;
}

/// Pages of a training block and of a friction-table block. Neither asks the participant a question.
void add_strokes(std::vector<Exhibit>& all, const Words& words) {
  const auto page = [&](PageKind kind, const char* text) {
    Page made = base(words, kind);
    made.text = core::text(text, words.language);
    return made;
  };
  Page training = page(PageKind::instructions, "training_text");
  training.title = core::text("training", words.language);
  all.push_back({"training", training});
  Page measuring = page(PageKind::instructions, "measuring_text");
  measuring.title = core::text("measuring", words.language);
  all.push_back({"measuring", measuring});
  all.push_back({"stroke", guided(page(PageKind::stimulus, "stroke_now"))});
  Page good = page(PageKind::feedback, "movement_ok"), bad = page(PageKind::feedback, "movement_hard");
  good.correct = true, bad.correct = false;
  all.push_back({"stroke-right", good});
  all.push_back({"stroke-wrong", bad});
  all.push_back({"cue-guided", guided(boundary(words, PageKind::cue))});
  all.push_back({"explore-guided", guided(boundary(words, PageKind::stimulus), true)});
  all.push_back({"gap-guided", guided(oddity(words, PageKind::pause, 2))});
  all.push_back({"response-guided", guided(oddity(words, PageKind::response, 3))});
}

void add_trials(std::vector<Exhibit>& all, const Words& words) {
  Page cue = boundary(words, PageKind::cue);
  cue.text.clear();
  cue.answers_open = false;
  all.push_back({"cue", cue});
  cue.cue = boundary(words, PageKind::stimulus).text;  // what a task of several says before its trials
  all.push_back({"cue-task", cue});
  all.push_back({"explore", boundary(words, PageKind::stimulus)});
  all.push_back({"response", boundary(words, PageKind::response)});
  Page now = boundary(words, PageKind::stimulus);
  now.answer_now = true;
  all.push_back({"explore-signal", now});
  now.flash_ns = 0;
  all.push_back({"explore-flash", now});
  all.push_back({"explore-speed", instructed(boundary(words, PageKind::stimulus), words, "speed")});
  all.push_back({"explore-accuracy", instructed(boundary(words, PageKind::stimulus), words, "accuracy")});
  all.push_back({"abx-cue", abx(words, PageKind::cue)});
  all.push_back({"abx-x", abx(words, PageKind::stimulus)});
  all.push_back({"abx-answers", abx(words, PageKind::response)});
  all.push_back({"interval-2-of-3", oddity(words, PageKind::stimulus, 2)});
  all.push_back({"gap", oddity(words, PageKind::pause, 2)});
  all.push_back({"response-3", oddity(words, PageKind::response, 3)});
  // with the button that presents the intervals again, beside the longest badge
  Page again = instructed(oddity(words, PageKind::response, 3), words, "accuracy");
  again.again = again.offers_again = true;
  all.push_back({"response-again", again});
  all.push_back({"between-trials", base(words, PageKind::interval)});
  Page feedback = base(words, PageKind::feedback);
  feedback.correct = true;
  all.push_back({"feedback-right", feedback});
  feedback.correct = false;
  all.push_back({"feedback-wrong", feedback});
  const auto said = [&](const char* key, const char* value = "") {
    return core::say(core::phrase(key, {core::plain(value)}), words.language);
  };
  feedback.text = said("wrong") + "  \u221210\n" + said("points", "1240");
  all.push_back({"feedback-points", feedback});
  feedback.correct.reset();
  feedback.text = words.pick("Too slow", "Zu langsam", "遅すぎました");
  all.push_back({"too-slow", feedback});
  Page over = base(words, PageKind::instructions);
  over.title = said("block_over");
  over.surface = {};
  for (const auto& [key, value] : {std::pair{"block_right", "83"},
                                   {"block_time", "0.55"},
                                   {"goal_right", "85"},
                                   {"goal_time", "0.6"},
                                   {"goal_missed", ""},
                                   {"points", "120"}})
    over.text += (over.text.empty() ? "" : "\n") + said(key, value);
  all.push_back({"block-over", over});
}

void add_faults(std::vector<Exhibit>& all, const Words& words) {
  using session::FaultKind;
  const std::pair<FaultKind, const char*> faults[] = {
      {FaultKind::converter_gone, "No such device"},
      {FaultKind::converter_rate, "191713.4 Hz instead of 192000 Hz"},
      {FaultKind::converter_saturated, "384 samples clipped"},
      {FaultKind::audio_silent, ""},
      {FaultKind::session_silent, ""},
      {FaultKind::page_silent, ""},
      {FaultKind::suspended, "the computer was suspended for 5421.3 s"},
      {FaultKind::amplifier, "the amplifier was switched off after 85 us"},
      {FaultKind::enable_line, "the line was set low but reads high"},
      {FaultKind::stop_pressed, "the amplifier was switched off after 85 us"},
      {FaultKind::lines_gone,
       "refused: GPIO lines disconnected: gpio line AMP_EN: no GPIO chip has a line with this name: No such "
       "file or "
       "directory"},
      {FaultKind::touch_gone, "/dev/input/by-id/usb-panel-event: No such device"},
      {FaultKind::disk_full, "lab.sqlite: database or disk is full"},
      {FaultKind::disarmed, ""},
      {FaultKind::limits, "1.8 s of stimulus would exceed the session's time"},
      {FaultKind::stimulus_missed, "384 frames lost"},
      {FaultKind::capture, "the pilot on output channel 2 is not heard on captured channel 0"},
      {FaultKind::vibration, "the surface does not move; level -62.1 dB; residual -21 dB"},
      {FaultKind::sounding, "a tone of 29.6 kHz at -46 dB of full drive"},
      {FaultKind::self_test, "gate: the gate stays open although the heartbeat has stopped"},
      {FaultKind::program,
       "program /home/lab/one_up_two_down.py: ended with status 1: \"KeyError: 'start'\""},
      {FaultKind::other, "panel: 3 edges of line 0 were lost"},
  };
  for (const auto& [kind, detail] : faults) {
    Page page = base(words, PageKind::fault);
    const auto text = core::fault_text(kind, words.language);
    page.title = core::text("please_wait", words.language);
    page.fault = {kind, detail};
    page.text = text.happened;
    page.safe = text.safe;
    page.to_do = text.to_do;
    if (kind == FaultKind::disarmed) page.amplifier = "disarmed";
    // These faults do not put the amplifier into the state "faulted".
    const auto armed = {FaultKind::disarmed,  FaultKind::limits,          FaultKind::touch_gone,
                        FaultKind::disk_full, FaultKind::stimulus_missed, FaultKind::vibration,
                        FaultKind::capture,   FaultKind::self_test,       FaultKind::program,
                        FaultKind::other};
    if (std::find(armed.begin(), armed.end(), kind) == armed.end()) page.amplifier = "faulted";
    all.push_back({std::string("fault-") + core::name(kind), page});
  }
}

void add_notices(std::vector<Exhibit>& all, const Words& words) {
  Page rest = base(words, PageKind::rest);
  rest.remaining_s = 17.4;
  all.push_back({"rest", rest});
  rest.remaining_s = 0;
  all.push_back({"rest-over", rest});
  add_faults(all, words);
  all.push_back({"paused", base(words, PageKind::paused)});
  Page failed = base(words, PageKind::failed);
  failed.text = "lab.sqlite: database or disk is full";
  all.push_back({"failed", failed});
  failed.text.clear();
  failed.early = session::EarlySession{"P07", 2, "2026-11-26", 1, "2026-11-25", 1};
  all.push_back({"failed-early", failed});
  Page end = base(words, PageKind::end);
  end.title = core::text("thanks_early", words.language);
  end.resumable = true;
  all.push_back({"end-early", end});
  end.resumable = false;
  end.title = core::text("thanks", words.language);
  end.trials_done = end.trials_total = 88;
  all.push_back({"end", end});
  const auto add = [&end](const char* key, const char* value) {
    end.summary.push_back({{key, "", {}}, value});
  };
  add("operator.trials", "88");
  add("report.too_late", "2");
  add("report.right", "81.4 %");
  end.summary.push_back({{"", "main, ", {{"report.threshold", "", {}}}}, "-1.2 mm (SD 0.6)"});
  all.push_back({"end-operator", end});
}

void add_starts(std::vector<Exhibit>& all, const Words& words) {
  Page page = base(words, PageKind::instructions);
  page.trials_done = 0;
  page.mark_mm = 160;
  page.title = words.pick("Practice", "Übung", "練習");
  page.text = words.pick(
      "Slide one finger to and fro along the strip. Part of it feels smooth. Say on which side of the mark "
      "the smooth "
      "part ends.",
      "Gleiten Sie mit einem Finger auf dem Streifen hin und her. Ein Teil fühlt sich glatt an. Sagen Sie, "
      "auf welcher "
      "Seite der Markierung der glatte Teil endet.",
      "一本の指を帯の上で左右にすべらせてください。一部がなめらかに感じられます。なめらかな部分が印のどちら側"
      "で終わるかを答えてください。");
  all.push_back({"instructions", page});
  page.mark_mm.reset();
  page.instruction = "speed";
  page.text = words.pick("Answer as FAST as you can. Some errors are fine.",
                         "So SCHNELL wie möglich. Einige Fehler sind in Ordnung.",
                         "できるだけ速く答えてください。多少の間違いは構いません。");
  all.push_back({"instructions-speed", page});
  page.instruction = "accuracy";
  page.text =
      words.pick("Be as ACCURATE as you can. Take your time.", "So GENAU wie möglich. Nehmen Sie sich Zeit.",
                 "できるだけ正確に答えてください。時間をかけて構いません。");
  all.push_back({"instructions-accuracy", page});
  // as long as an instruction can be, with the badge
  page.text += " " + words.pick(
                         "Slide one finger to and fro along the strip. Part of it feels smooth. Say on which "
                         "side of the mark "
                         "the smooth "
                         "part ends.",
                         "Gleiten Sie mit einem Finger auf dem Streifen hin und her. Ein Teil fühlt sich "
                         "glatt an. Sagen Sie, "
                         "auf welcher "
                         "Seite der Markierung der glatte Teil endet.",
                         "一本の指を帯の上で左右にすべらせてください。一部がなめらかに感じられます。なめらか"
                         "な部分が印のどちら側"
                         "で終わるかを答えてください。");
  page.text += "\n\n" + page.text;
  page.mark_mm = 160;
  all.push_back({"instructions-long", page});
  Page adjust = boundary(words, PageKind::adjust);
  adjust.text = words.pick("Move the slider until the smooth part ends at the mark.",
                           "Den Regler schieben, bis der glatte Teil an der Markierung endet.",
                           "なめらかな部分が印で終わるように、つまみを動かしてください。");
  adjust.answers.clear();
  adjust.slider = {31, 0, 100, 1};
  all.push_back({"adjust", adjust});
  adjust.again = adjust.offers_again = true;
  all.push_back({"adjust-again", adjust});
  adjust.again = adjust.offers_again = false;
  adjust.answers_open = true;
  all.push_back({"adjust-silent", adjust});
}

}  // namespace

std::vector<Exhibit> gallery(const std::string& language) {
  const Words words{language};
  std::vector<Exhibit> all;
  add_starts(all, words);
  add_trials(all, words);
  add_strokes(all, words);
  add_judgements(all, words);
  add_interludes(all, words);
  add_notices(all, words);
  return all;
}

std::vector<Exhibit> gallery_in_mode(const std::string& language, const std::string& mode) {
  auto all = gallery(language);
  for (auto& exhibit : all) {
    exhibit.page.run_mode = mode;
    if (mode != "live") exhibit.name += "-" + mode;
  }
  return all;
}

}  // namespace turnpoint::ui
