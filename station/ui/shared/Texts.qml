import QtQuick

// The station's own texts in each supported language; the protocol brings its own. An unsupported language
// falls back to English.
QtObject {
    required property string language

    function pick(en: string, de: string, ja: string) : string {
        return language.startsWith("de") ? de : language.startsWith("ja") ? phrased(ja) : en
    }

    /// Prepares a text of this language for display. Japanese may break a line between almost any two
    /// characters, even inside a word. Inserted word joiners (U+2060) leave only the breaks after
    /// punctuation, and those between hiragana, which end a phrase, and a character that begins one. A phrase
    /// longer than a line still breaks anywhere.
    function phrased(text: string) : string {
        if (!language.startsWith("ja")) return text
        const japanese = /[\u3001-\u30ff\u3400-\u9fff\uff01-\uff9f]/
        let shown = ""
        for (let i = 0; i < text.length; ++i) {
            const whole = i + 1 < text.length && japanese.test(text[i]) && japanese.test(text[i + 1])
            shown += text[i] + (whole && !endsPhrase(text, i) ? "\u2060" : "")
        }
        return shown
    }
    function endsPhrase(text: string, i: int) : bool {
        const hiragana = /[\u3041-\u309f]/, begins = /[\u30a1-\u30fa\u3400-\u9fff\u300c\u300e\uff08]/
        const polite = at => /[おご]/.test(text[at]) && /[\u3400-\u9fff]/.test(text[at + 1] ?? "")
        if (/[、。・!?]/.test(text[i])) return true
        if (/[」』)]/.test(text[i])) return !hiragana.test(text[i + 1])  // otherwise its particle follows
        return hiragana.test(text[i]) && !polite(i) && (begins.test(text[i + 1]) || polite(i + 1))
    }

    // {state: none | recent | old | ahead, hours}
    function lastBackup(backup) {
        if (backup.state === "none") return pick("No backup yet", "Noch keine Sicherung", "バックアップはまだありません")
        if (backup.state === "ahead")
            return pick("Last backup: in the future, check the clock", "Letzte Sicherung: in der Zukunft, bitte Uhr prüfen",
                        "最後のバックアップが未来の日時です。時計を確認してください")
        if (backup.state === "old")
            return pick("Last good backup: %1 days ago, older than 7 days", "Letzte gute Sicherung: vor %1 Tagen, älter als 7 Tage",
                        "最後のバックアップは%1日前です。7日より前です").arg(Math.floor(backup.hours / 24))
        if (backup.hours < 48)
            return pick("Last good backup: %1 h ago", "Letzte gute Sicherung: vor %1 h", "最後のバックアップは%1時間前です").arg(backup.hours)
        return pick("Last good backup: %1 days ago", "Letzte gute Sicherung: vor %1 Tagen", "最後のバックアップは%1日前です").arg(Math.floor(backup.hours / 24))
    }

    readonly property string proceed: pick("Continue", "Weiter", "次へ")
    readonly property string done: pick("Done", "Fertig", "決定")
    readonly property string pressDone: pick("Press Done.", "Bitte auf Fertig tippen.", "「決定」を押してください。")
    readonly property string pause: pick("Pause", "Pause", "休止")
    readonly property string getReady: pick("Get ready", "Gleich geht es los", "準備してください")
    readonly property string slideHere: pick("Slide your finger to and fro here", "Hier mit dem Finger hin und her gleiten",
                                             "ここで指を左右にすべらせてください")
    readonly property string slideNow: pick("Slide now", "Jetzt gleiten", "すべらせてください")
    readonly property string keepStill: pick("Wait", "Warten", "待ってください")
    readonly property string right: pick("Right", "Richtig", "正解")
    readonly property string wrong: pick("Wrong", "Falsch", "不正解")
    readonly property string noted: pick("Noted", "Notiert", "記録しました")
    readonly property string failedTitle: pick("The session had to stop", "Die Sitzung musste enden", "セッションを中断しました")
    readonly property string failedText: pick("Whatever has been stored is safe.", "Was gespeichert wurde, ist sicher.",
                                              "保存された内容は安全です。")
    readonly property string speed: pick("Fast", "Schnell", "速さ優先")
    readonly property string accuracy: pick("Accurate", "Genau", "正確さ優先")
    readonly property string breakTitle: pick("Time for a break", "Zeit für eine Pause", "休憩しましょう")
    readonly property string breakRunning: pick("Rest your hand. You can go on in", "Ruhen Sie die Hand aus. Weiter geht es in",
                                                "手を休めてください。再開まで")
    readonly property string breakOver: pick("Go on whenever you are ready.", "Weiter, sobald Sie bereit sind.",
                                             "準備ができたら続けてください。")
    readonly property string seconds: pick("s", "s", "秒")
    readonly property string paused: pick("Paused", "Angehalten", "一時停止中")
    readonly property string pausedText: pick("Everything so far is saved.", "Alles bisher ist gespeichert.",
                                              "ここまでの結果は保存されています。")
    readonly property string endSession: pick("End the session", "Sitzung beenden", "終了する")
    readonly property string reallyEnd: pick("End the session now?", "Sitzung jetzt beenden?", "本当に終了しますか?")
    readonly property string keepGoing: pick("Go on", "Weitermachen", "続ける")
    readonly property string faultTitle: pick("Please tell the experimenter", "Bitte der Versuchsleitung Bescheid geben",
                                              "実験者に知らせてください")
    readonly property string whatHappened: pick("What happened", "Was geschehen ist", "起きたこと")
    readonly property string whatIsSafe: pick("What is safe", "Was sicher ist", "安全なこと")
    readonly property string whatToDo: pick("What to do", "Was zu tun ist", "すること")
    readonly property string holdToArm: pick("Hold to arm the amplifier", "Halten: Verstärker scharf schalten", "長押しでアンプを有効にする")
    readonly property string thanks: pick("Thank you!", "Vielen Dank!", "ありがとうございました")
    readonly property string thanksText: pick("All of your answers are saved.", "Alle Ihre Antworten sind gespeichert.",
                                              "回答はすべて保存されました。")
    readonly property string forOperator: pick("For the experimenter", "Für die Versuchsleitung", "実験者用")
    readonly property string close: pick("Close", "Schließen", "閉じる")
    readonly property string consentTitle: pick("Before we begin", "Bevor wir beginnen", "始める前に")
    readonly property string consentText: pick("Have you read and signed the consent form, version %1?",
                                               "Haben Sie die Einwilligung, Fassung %1, gelesen und unterschrieben?",
                                               "同意書(版 %1)を読み、署名しましたか?")
    readonly property string consentYes: pick("Yes, I have", "Ja", "はい")
    readonly property string consentNo: pick("No", "Nein", "いいえ")
    readonly property string results: pick("Results", "Ergebnisse", "結果")
    readonly property string rightHand: pick("Tapping with\nright hand", "Es tippt die\nrechte Hand", "操作する手:\n右手")
    readonly property string leftHand: pick("Tapping with\nleft hand", "Es tippt die\nlinke Hand", "操作する手:\n左手")
    readonly property string codeTitle: pick("Your participant code", "Ihr Teilnahme-Code", "参加者コード")
    readonly property string codeHelp: pick("Type the code that you were given. No names.", "Bitte den Code eingeben, den Sie erhalten haben. Keine Namen.",
                                            "渡されたコードを入力してください。名前は入力しないでください。")
    readonly property string codeKnown: pick("This code has been here before. Is it yours?", "Dieser Code war schon hier. Ist es Ihrer?",
                                             "このコードは以前に使われています。あなたのコードですか?")
    readonly property string codeYes: pick("Yes, mine", "Ja, meiner", "はい")
    readonly property string codeNo: pick("No, change it", "Nein, ändern", "いいえ、直します")
    readonly property string pilot: pick("PILOT RUN", "PROBELAUF", "予備実験")
    readonly property string pilotText: pick("not study data", "keine Studiendaten", "本番データではありません")
    readonly property string simulated: pick("SIMULATED", "SIMULIERT", "シミュレーション")
    readonly property string simulatedText: pick("no person answers", "es antwortet kein Mensch", "人は回答していません")
}
