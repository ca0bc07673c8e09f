#include "station/core/texts.hpp"
#include "tests/ui/gallery_parts.hpp"

namespace turnpoint::ui {

void add_interludes(std::vector<Exhibit>& all, const Words& words) {
  Page consent = base(words, PageKind::question);
  consent.trials_done = 0;
  const std::string form = words.pick(
      "You will feel vibrations of a surface with one finger and answer questions about them. This takes "
      "about "
      "15 minutes. Your answers are stored under a code, without your name. You may stop at any time, "
      "without "
      "giving a reason and without any disadvantage. Do you want to take part?",
      "Sie werden mit einem Finger Schwingungen einer Oberfläche fühlen und Fragen dazu beantworten. Das "
      "dauert "
      "etwa 15 Minuten. Ihre Antworten werden unter einem Code gespeichert, ohne Namen. Sie können jederzeit "
      "aufhören, ohne Angabe von Gründen und ohne Nachteil. Möchten Sie teilnehmen?",
      "一本の指で表面の振動を感じ、質問に答えていただきます。約15分かかります。回答はお名前ではなく番号で保存"
      "されます。"
      "理由を述べずにいつでもやめることができ、不利益はありません。参加されますか?");
  consent.text = form;
  consent.answers_open = true;
  consent.answers = {
      {"agree", words.pick("Yes, I take part", "Ja, ich nehme teil", "はい、参加します")},
      {"refuse", words.pick("No, I do not", "Nein, ich nehme nicht teil", "いいえ、参加しません")}};
  all.push_back({"consent-form", consent});
  consent.text = form + "\n\n" + form + "\n\n" + form;
  all.push_back({"consent-form-long", consent});
  Page question = base(words, PageKind::question);
  question.back = true;
  question.answers_open = true;
  question.text = words.pick("Which hand do you write with?", "Mit welcher Hand schreiben Sie?",
                             "どちらの手で字を書きますか?");
  question.answers = {{"left", words.pick("Left", "Links", "左")},
                      {"right", words.pick("Right", "Rechts", "右")},
                      {"both", words.pick("Both", "Mit beiden", "両方")}};
  all.push_back({"question-choices", question});
  question.answers.clear();
  for (int i = 1; i <= 7; ++i) question.answers.push_back({std::to_string(i), std::to_string(i)});
  question.answers.front().caption = words.pick("not at all", "überhaupt nicht", "全く");
  question.answers.back().caption = words.pick("very", "außerordentlich", "とても");
  all.push_back({"question-rating", question});
  Page age = question;
  age.kind = PageKind::number;
  age.answers.clear();
  age.text = words.pick("How old are you, in years?", "Wie alt sind Sie, in Jahren?", "おいくつですか?");
  age.value = {1, 120, 0, {}, {}, ""};
  all.push_back({"question-number", age});
  Page explained = base(words, PageKind::explanation);
  explained.back = true;
  explained.text = words.pick(
      "Press a button, then slide your finger over the surface. You can feel each example as often as you "
      "wish.",
      "Drücken Sie einen Knopf und gleiten Sie dann mit dem Finger über die Oberfläche. Sie können jedes "
      "Beispiel "
      "beliebig oft fühlen.",
      "ボタンを押してから、指を表面の上ですべらせてください。それぞれの例は何度でも感じることができます。");
  all.push_back({"explanation", explained});
  explained.answers = {{"a", words.pick("This is smooth", "Das ist glatt", "これはなめらか")},
                       {"b", words.pick("This is rough", "Das ist rau", "これはざらざら")}};
  all.push_back({"explanation-examples", explained});
  explained.picture = TURNPOINT_SOURCE_DIR "/tests/ui/finger.png";
  all.push_back({"explanation-picture", explained});
  explained.picture.clear();
  explained.playing = true;
  all.push_back({"explanation-playing", explained});
}

}  // namespace turnpoint::ui
