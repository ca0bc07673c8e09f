#include "station/session/words.hpp"

#include <array>

namespace turnpoint::session {

namespace {

struct Entry {
  Word word;
  const char *en, *de, *ja;
};

constexpr std::array kWords{
    Entry{Word::practice, "Practice", "Übung", "練習"},
    Entry{Word::practice_again, "Let us practise once more", "Wir üben noch einmal",
          "もう一度練習しましょう"},
    Entry{Word::get_ready, "Get ready", "Machen Sie sich bereit", "準備してください"},
    Entry{Word::right, "Right", "Richtig", "正解"},
    Entry{Word::wrong, "Wrong", "Falsch", "不正解"},
    Entry{Word::too_early, "Too early: feel first, then answer", "Zu früh: erst fühlen, dann antworten",
          "早すぎます。感じてから答えてください"},
    Entry{Word::too_late, "Too slow", "Zu langsam", "時間切れです"},
    Entry{Word::rest, "Take a break", "Machen Sie eine Pause", "休憩してください"},
    Entry{Word::rest_text, "Rest your hand. Go on when you are ready.",
          "Ruhen Sie die Hand aus. Weiter, wenn Sie bereit sind.",
          "手を休めてください。準備ができたら続けましょう。"},
    Entry{Word::fault, "Please wait for the experimenter", "Bitte warten Sie auf die Versuchsleitung",
          "実験者をお待ちください"},
    Entry{Word::paused, "Paused", "Angehalten", "一時停止"},
    Entry{Word::thanks, "Thank you. You have finished.", "Vielen Dank. Sie sind fertig.",
          "ありがとうございました。終了です。"},
    Entry{Word::thanks_early, "Thank you. We stop here.", "Vielen Dank. Wir hören hier auf.",
          "ありがとうございました。ここまでにします。"},
};

}  // namespace

std::string word(Word wanted, const std::string& language) {
  for (const auto& entry : kWords)
    if (entry.word == wanted) return language == "de" ? entry.de : language == "ja" ? entry.ja : entry.en;
  return "";
}

}  // namespace turnpoint::session
