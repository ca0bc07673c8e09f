#include "station/session/fault.hpp"

#include <array>

namespace turnpoint::session {

namespace {

struct Texts {
  const char *happened, *safe, *to_do;
};

struct Entry {
  FaultKind kind;
  const char* name;
  Texts en, de, ja;
};

constexpr const char* kSurfaceOff = "The amplifier is off; the surface is still and safe to touch.";

constexpr std::array kFaults{
    Entry{FaultKind::other,
          "other",
          {"The station cannot go on by itself", kSurfaceOff,
           "Call the experimenter. Mend what stands below, then press Continue; the trial comes again."},
          {"Die Station kann nicht von selbst weitermachen",
           "Der Verstärker ist aus; die Oberfläche ruht und darf berührt werden.",
           "Versuchsleitung rufen. Beheben, was unten steht, dann Weiter; der Durchgang wird wiederholt."},
          {"装置だけでは続けられません", "アンプは切れています。表面は静止していて、触れても安全です。",
           "実験者を呼んでください。下の問題を直してから「次へ」を押すと、試行をもう一度行います。"}},
    Entry{FaultKind::converter_gone,
          "converter_gone",
          {"The sound converter is gone", kSurfaceOff,
           "Plug the converter in again, arm the amplifier, then press Continue; the trial comes again."},
          {"Der Wandler ist weg", "Der Verstärker ist aus; die Oberfläche ruht und darf berührt werden.",
           "Wandler wieder anschließen, Verstärker scharf schalten, dann Weiter; der Durchgang wird "
           "wiederholt."},
          {"変換器が外れました", "アンプは切れています。表面は静止していて、触れても安全です。",
           "変換器をつなぎ直し、アンプを有効にしてから「次へ」を押してください。試行をもう一度行います。"}},
    Entry{
        FaultKind::converter_rate,
        "converter_rate",
        {"The sound converter runs at a wrong rate", kSurfaceOff,
         "What would be felt is not what was asked for. Use another port or device; turnpoint doctor says "
         "more."},
        {"Der Wandler läuft mit falscher Abtastrate",
         "Der Verstärker ist aus; die Oberfläche ruht und darf berührt werden.",
         "Zu fühlen wäre nicht, was verlangt ist. Anderen Anschluss oder anderes Gerät verwenden; turnpoint "
         "doctor sagt mehr."},
        {"変換器の標本化周波数が正しくありません",
         "アンプは切れています。表面は静止していて、触れても安全です。",
         "指定と異なる刺激になります。別の端子か機器を使ってください。turnpoint doctor "
         "で詳細を確認できます。"}},
    Entry{FaultKind::amplifier,
          "amplifier",
          {"The amplifier reports a fault", "The amplifier is off and stays off until it is armed again.",
           "Look for a short circuit or heat, clear the fault, arm the amplifier, then press Continue."},
          {"Der Verstärker meldet eine Störung",
           "Der Verstärker ist aus und bleibt aus, bis er wieder scharf geschaltet wird.",
           "Kurzschluss oder Hitze suchen, Störung quittieren, Verstärker scharf schalten, dann Weiter."},
          {"アンプが異常を知らせています", "アンプは切れていて、再び有効にするまで入りません。",
           "短絡や過熱がないか調べ、異常を解除し、アンプを有効にしてから「次へ」を押してください。"}},
    Entry{FaultKind::stop_pressed,
          "stop_pressed",
          {"The stop button was pressed", "The amplifier has no supply; the surface is still.",
           "Find out why. When all is well, release the stop, arm the amplifier, then press Continue."},
          {"Der Stopp-Knopf wurde gedrückt", "Der Verstärker ist ohne Strom; die Oberfläche ruht.",
           "Grund klären. Wenn alles in Ordnung ist: Stopp lösen, Verstärker scharf schalten, dann Weiter."},
          {"停止ボタンが押されました", "アンプの電源は切れていて、表面は静止しています。",
           "理由を確かめてください。問題がなければ停止を戻し、アンプを有効にしてから「次へ」を押します。"}},
    Entry{FaultKind::touch_gone,
          "touch_gone",
          {"The touch panel is gone", "The surface is still. Every answer up to here is saved.",
           "Plug the touch panel in again, then press Continue; the trial comes again."},
          {"Das Touch-Panel ist weg", "Die Oberfläche ruht. Alle Antworten bis hierher sind gespeichert.",
           "Touch-Panel wieder anschließen, dann Weiter; der Durchgang wird wiederholt."},
          {"タッチパネルが外れました", "表面は静止しています。ここまでの回答は保存されています。",
           "タッチパネルをつなぎ直してから「次へ」を押してください。試行をもう一度行います。"}},
    Entry{
        FaultKind::lines_gone,
        "lines_gone",
        {"Buttons, sensor or amplifier lines are gone", kSurfaceOff,
         "Plug them in again, arm the amplifier where that is asked, then press Continue; the trial comes "
         "again."},
        {"Taster, Sensor oder Verstärkerleitungen fehlen",
         "Der Verstärker ist aus; die Oberfläche ruht und darf berührt werden.",
         "Wieder anschließen, Verstärker scharf schalten, wenn verlangt, dann Weiter; der Durchgang wird "
         "wiederholt."},
        {"ボタン・センサー・アンプの配線が外れました",
         "アンプは切れています。表面は静止していて、触れても安全です。",
         "つなぎ直し、求められたらアンプを有効にしてから「次へ」を押してください。試行をもう一度行います。"}},
    Entry{FaultKind::disk_full,
          "disk_full",
          {"The disk is full",
           "The surface is still. Earlier answers are stored; the last one is kept in memory.",
           "Make room on the disk, then press Continue: the last answer is stored and the session goes on."},
          {"Die Festplatte ist voll",
           "Die Oberfläche ruht. Frühere Antworten sind gespeichert, die letzte liegt im Arbeitsspeicher.",
           "Platz schaffen, dann Weiter: Die letzte Antwort wird gespeichert, und die Sitzung geht weiter."},
          {"ディスクがいっぱいです",
           "表面は静止しています。これまでの回答は保存済みで、最後の回答はメモリーにあります。",
           "空き容量を作ってから「次へ」を押してください。最後の回答を保存して続けます。"}},
    Entry{
        FaultKind::disarmed,
        "disarmed",
        {"The amplifier is not armed", kSurfaceOff, "The experimenter arms the amplifier; then it goes on."},
        {"Der Verstärker ist nicht scharf geschaltet",
         "Der Verstärker ist aus; die Oberfläche ruht und darf berührt werden.",
         "Die Versuchsleitung schaltet den Verstärker scharf; dann geht es weiter."},
        {"アンプが有効になっていません", "アンプは切れています。表面は静止していて、触れても安全です。",
         "実験者がアンプを有効にすると始まります。"}},
    Entry{FaultKind::stimulus_missed,
          "stimulus_missed",
          {"The last stimulus was not whole", "The surface is still and safe to touch.",
           "Press Continue; the trial comes again and the spoilt one does not count."},
          {"Der letzte Reiz war unvollständig", "Die Oberfläche ruht und darf berührt werden.",
           "Weiter drücken; der Durchgang wird wiederholt, der gestörte zählt nicht."},
          {"直前の刺激が正しく提示されませんでした", "表面は静止していて、触れても安全です。",
           "「次へ」を押すと試行をもう一度行います。今の試行は数えません。"}},
};

const Entry& entry(FaultKind kind) {
  for (const auto& candidate : kFaults)
    if (candidate.kind == kind) return candidate;
  return kFaults.front();
}

}  // namespace

FaultText fault_text(FaultKind kind, const std::string& language) {
  const auto& found = entry(kind);
  const auto& texts = language == "de" ? found.de : language == "ja" ? found.ja : found.en;
  return {texts.happened, texts.safe, texts.to_do};
}

FaultKind fault_of_amplifier(std::string_view reason) {
  if (reason == kConverterGone) return FaultKind::converter_gone;
  if (reason.starts_with("the stop")) return FaultKind::stop_pressed;
  if (reason.starts_with("its lines are gone")) return FaultKind::lines_gone;
  return FaultKind::amplifier;
}

const char* name(FaultKind kind) { return entry(kind).name; }

}  // namespace turnpoint::session
