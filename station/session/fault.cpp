#include "station/session/fault.hpp"

#include <iterator>

namespace turnpoint::session {

namespace {

struct Texts {
  const char *happened, *safe, *to_do;
};

struct Entry {
  FaultKind kind;
  Texts en, de, ja;
};

constexpr const char* kOff_en = "The amplifier is off; the surface is still and safe to touch.";
constexpr const char* kOff_de = "Der Verstärker ist aus; die Oberfläche ruht und darf berührt werden.";
constexpr const char* kOff_ja = "アンプは切れています。表面は静止していて、触れても安全です。";

constexpr Entry kFaults[] = {
    {FaultKind::other,
     {"The station cannot continue by itself", kOff_en,
      "Call the experimenter. Solve the problem shown below, then press Continue; the trial is repeated."},
     {"Die Station kann nicht von selbst weitermachen", kOff_de,
      "Versuchsleitung rufen. Das unten genannte Problem beheben, dann Weiter; der Durchgang wird "
      "wiederholt."},
     {"装置だけでは続けられません", kOff_ja,
      "実験者を呼んでください。下の問題を直してから「次へ」を押すと、試行をもう一度行います。"}},
    {FaultKind::converter_gone,
     {"The sound device was disconnected", kOff_en,
      "Plug the sound device in again, arm the amplifier, then press Continue; the trial is repeated."},
     {"Der Wandler wurde getrennt", kOff_de,
      "Wandler wieder anschließen, Verstärker scharf schalten, dann Weiter; der Durchgang wird wiederholt."},
     {"変換器が外れました", kOff_ja,
      "変換器をつなぎ直し、アンプを有効にしてから「次へ」を押してください。試行をもう一度行います。"}},
    {FaultKind::converter_rate,
     {"The sound device runs at the wrong rate", kOff_en,
      "Stimuli would differ from what was asked for. Connect another sound device or use another port, arm "
      "the amplifier, then press Continue."},
     {"Der Wandler läuft mit falscher Abtastrate", kOff_de,
      "Die Reize wären nicht die verlangten. Anderes Gerät oder anderen Anschluss verwenden, Verstärker "
      "scharf schalten, dann Weiter."},
     {"変換器の標本化周波数が正しくありません", kOff_ja,
      "指定と異なる刺激になります。別の機器か端子を使い、アンプを有効にしてから「次へ」を押してください。"}},
    {FaultKind::converter_saturated,
     {"The drive signal was clipped", kOff_en,
      "The last stimulus was not what was asked for. Arm the amplifier, then press Continue. If it happens "
      "again, lower the levels in the protocol."},
     {"Das Ansteuersignal wurde abgeschnitten", kOff_de,
      "Der letzte Reiz war nicht der verlangte. Verstärker scharf schalten, dann Weiter. Bei Wiederholung "
      "die Pegel im Protokoll senken."},
     {"駆動信号が振り切れました", kOff_ja,
      "直前の刺激は指定どおりではありません。アンプを有効にしてから「次へ」を押してください。"
      "繰り返す場合はプロトコルのレベルを下げてください。"}},
    {FaultKind::audio_silent,
     {"The sound output stopped responding", kOff_en,
      "Check the sound device and its cable, arm the amplifier, then press Continue. If it happens again, "
      "end the session and run turnpoint doctor."},
     {"Die Tonausgabe reagierte nicht mehr", kOff_de,
      "Wandler und Kabel prüfen, Verstärker scharf schalten, dann Weiter. Bei Wiederholung Sitzung beenden "
      "und turnpoint doctor ausführen."},
     {"音声出力が応答しなくなりました", kOff_ja,
      "変換器とケーブルを確かめ、アンプを有効にしてから「次へ」を押してください。"
      "繰り返す場合はセッションを終えて turnpoint doctor を実行してください。"}},
    {FaultKind::session_silent,
     {"The station was busy for more than two seconds", kOff_en,
      "Arm the amplifier, then press Continue; the trial is repeated. If it happens again, check the memory "
      "card or disk."},
     {"Die Station war länger als zwei Sekunden beschäftigt", kOff_de,
      "Verstärker scharf schalten, dann Weiter; der Durchgang wird wiederholt. Bei Wiederholung "
      "Speicherkarte oder Platte prüfen."},
     {"装置が2秒以上応答しませんでした", kOff_ja,
      "アンプを有効にしてから「次へ」を押してください。試行をもう一度行います。"
      "繰り返す場合はメモリーカードかディスクを確かめてください。"}},
    {FaultKind::page_silent,
     {"The screen did not respond for more than two seconds", kOff_en,
      "Arm the amplifier, then press Continue; the trial is repeated. If it happens again, end the session "
      "and restart the station."},
     {"Der Bildschirm reagierte länger als zwei Sekunden nicht", kOff_de,
      "Verstärker scharf schalten, dann Weiter; der Durchgang wird wiederholt. Bei Wiederholung Sitzung "
      "beenden und die Station neu starten."},
     {"画面が2秒以上応答しませんでした", kOff_ja,
      "アンプを有効にしてから「次へ」を押してください。試行をもう一度行います。"
      "繰り返す場合はセッションを終えて装置を再起動してください。"}},
    {FaultKind::suspended,
     {"The computer was asleep", kOff_en,
      "Arm the amplifier, then press Continue; the trial is repeated. Switch automatic suspend off."},
     {"Der Rechner war im Ruhezustand", kOff_de,
      "Verstärker scharf schalten, dann Weiter; der Durchgang wird wiederholt. Automatischen Ruhezustand "
      "abschalten."},
     {"コンピューターがスリープしていました", kOff_ja,
      "アンプを有効にしてから「次へ」を押してください。試行をもう一度行います。"
      "自動スリープを切ってください。"}},
    {FaultKind::amplifier,
     {"The amplifier reports a fault", "The amplifier is off and stays off until it is armed again.",
      "Look for a short circuit or overheating. Then arm the amplifier and press Continue."},
     {"Der Verstärker meldet eine Störung",
      "Der Verstärker ist aus und bleibt aus, bis er wieder scharf geschaltet wird.",
      "Kurzschluss oder Überhitzung suchen. Dann Verstärker scharf schalten und Weiter drücken."},
     {"アンプが異常を知らせています", "アンプは切れていて、再び有効にするまで入りません。",
      "短絡や過熱がないか調べ、アンプを有効にしてから「次へ」を押してください。"}},
    {FaultKind::enable_line,
     {"The amplifier's enable line does not obey",
      "Do not touch the surface: the amplifier may still be on. The emergency stop switches it off.",
      "Press the emergency stop. Check the wiring of the enable line, release the stop, arm the amplifier, "
      "then press Continue."},
     {"Die Freigabeleitung des Verstärkers gehorcht nicht",
      "Oberfläche nicht berühren: Der Verstärker kann noch an sein. Der Stopp-Knopf schaltet ihn ab.",
      "Stopp drücken. Verdrahtung der Freigabeleitung prüfen, Stopp lösen, Verstärker scharf schalten, dann "
      "Weiter."},
     {"アンプの有効化信号が指示に従いません",
      "表面に触れないでください。アンプが入ったままかもしれません。停止ボタンで切れます。",
      "停止ボタンを押し、有効化信号の配線を調べてください。停止を戻し、アンプを有効にしてから"
      "「次へ」を押します。"}},
    {FaultKind::stop_pressed,
     {"The emergency stop was pressed", "The amplifier has no supply; the surface is still.",
      "Find out why. When all is well, release the stop, arm the amplifier, then press Continue."},
     {"Der Stopp-Knopf wurde gedrückt", "Der Verstärker ist ohne Strom; die Oberfläche ruht.",
      "Grund klären. Wenn alles in Ordnung ist: Stopp lösen, Verstärker scharf schalten, dann Weiter."},
     {"停止ボタンが押されました", "アンプの電源は切れていて、表面は静止しています。",
      "理由を確かめてください。問題がなければ停止を戻し、アンプを有効にしてから「次へ」を押します。"}},
    {FaultKind::lines_gone,
     {"Buttons, sensor or amplifier lines were disconnected", kOff_en,
      "Plug them in again, arm the amplifier if asked to, then press Continue; the trial is repeated."},
     {"Taster, Sensor oder Verstärkerleitungen fehlen", kOff_de,
      "Wieder anschließen, Verstärker scharf schalten, wenn verlangt, dann Weiter; der Durchgang wird "
      "wiederholt."},
     {"ボタン・センサー・アンプの配線が外れました", kOff_ja,
      "つなぎ直し、求められたらアンプを有効にしてから「次へ」を押してください。試行をもう一度行います。"}},
    {FaultKind::touch_gone,
     {"The touch panel was disconnected", "The surface is still. Every answer so far is saved.",
      "Plug the touch panel in again, then press Continue; the trial is repeated."},
     {"Das Touch-Panel wurde getrennt", "Die Oberfläche ruht. Alle Antworten bis hierher sind gespeichert.",
      "Touch-Panel wieder anschließen, dann Weiter; der Durchgang wird wiederholt."},
     {"タッチパネルが外れました", "表面は静止しています。ここまでの回答は保存されています。",
      "タッチパネルをつなぎ直してから「次へ」を押してください。試行をもう一度行います。"}},
    {FaultKind::disk_full,
     {"The disk is full", "The surface is still. Earlier answers are saved; the last one is kept in memory.",
      "Free some space on the disk, then press Continue: the last answer is saved and the session "
      "continues."},
     {"Die Festplatte ist voll",
      "Die Oberfläche ruht. Frühere Antworten sind gespeichert, die letzte liegt im Arbeitsspeicher.",
      "Platz schaffen, dann Weiter: Die letzte Antwort wird gespeichert, und die Sitzung geht weiter."},
     {"ディスクがいっぱいです",
      "表面は静止しています。これまでの回答は保存済みで、最後の回答はメモリーにあります。",
      "空き容量を作ってから「次へ」を押してください。最後の回答を保存して続けます。"}},
    {FaultKind::disarmed,
     {"The amplifier is not armed", kOff_en,
      "The experimenter arms the amplifier; then the session continues."},
     {"Der Verstärker ist nicht scharf geschaltet", kOff_de,
      "Die Versuchsleitung schaltet den Verstärker scharf; dann geht es weiter."},
     {"アンプが有効になっていません", kOff_ja, "実験者がアンプを有効にすると始まります。"}},
    {FaultKind::limits,
     {"A safety limit was reached", kOff_en,
      "The session ends here; every answer is saved. Press Continue for the summary."},
     {"Eine Sicherheitsgrenze ist erreicht", kOff_de,
      "Die Sitzung endet hier; alle Antworten sind gespeichert. Weiter zeigt die Zusammenfassung."},
     {"安全上の限度に達しました", kOff_ja,
      "セッションはここで終わります。回答はすべて保存されています。「次へ」で結果を表示します。"}},
    {FaultKind::stimulus_missed,
     {"The last stimulus was interrupted", "The surface is still and safe to touch.",
      "Press Continue; the trial is repeated, and the interrupted one does not count."},
     {"Der letzte Reiz war unvollständig", "Die Oberfläche ruht und darf berührt werden.",
      "Weiter drücken; der Durchgang wird wiederholt, der gestörte zählt nicht."},
     {"直前の刺激が正しく提示されませんでした", "表面は静止していて、触れても安全です。",
      "「次へ」を押すと試行をもう一度行います。今の試行は数えません。"}},
};
static_assert(std::size(kFaults) == terms::fault_kinds.size(), "a page for each kind of fault");

const Entry& entry(FaultKind kind) {
  for (const auto& candidate : kFaults)
    if (candidate.kind == kind) return candidate;
  return kFaults[0];
}

}  // namespace

FaultText fault_text(FaultKind kind, const std::string& language) {
  const auto& found = entry(kind);
  const auto& texts = language == "de" ? found.de : language == "ja" ? found.ja : found.en;
  return {texts.happened, texts.safe, texts.to_do};
}

}  // namespace turnpoint::session
