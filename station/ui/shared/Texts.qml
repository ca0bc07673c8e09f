import QtQuick
import Turnpoint

// The station's own texts, from the catalogue of the chosen language. (Texts of the protocol come from its
// file.) An unsupported language falls back to English.
QtObject {
    required property string language
    readonly property bool mirrored: Catalogue.mirrored(language)
    /// What stands before a piece of advice.
    readonly property string arrow: mirrored ? "← " : "→ "

    function text(key: string) : string { return phrased(Catalogue.text(key, language)) }

    /// A text of the catalogue with values in the places %1, %2 and so on. In a text that is read from right to left, each value
    /// is isolated (U+2068, U+2069), so that numbers, dates, names and file names keep their order.
    function fill(key: string, ...values) : string {
        return text(key).replace(/%([1-9])/g, (place, number) => values[number - 1] === undefined ? place
            : mirrored ? "\u2068" + values[number - 1] + "\u2069" : String(values[number - 1]))
    }

    /// Prepares a text for display. By default, a line may break between almost any two Japanese characters,
    /// even inside a word. This function inserts word joiners (U+2060), so that lines break only after
    /// punctuation, or after hiragana (the end of a phrase) if the next character begins a phrase. A phrase
    /// that is longer than a line still breaks anywhere.
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
        // a closing bracket ends the phrase, unless a particle in hiragana follows it
        if (/[」』)]/.test(text[i])) return !hiragana.test(text[i + 1])
        return hiragana.test(text[i]) && !polite(i) && (begins.test(text[i + 1]) || polite(i + 1))
    }

    // Says a phrase that C++ gives: a string, or {key, values}, whose values are phrases as well. Without a key, the
    // values follow one another.
    function say(phrase) : string {
        if (phrase === undefined || typeof phrase === "string") return phrase ?? ""
        const values = phrase.values.map(value => say(value))
        if (phrase.key === "") return values.join("")
        return fill(phrase.key, ...values)
    }

    // What the run mode or the status of a session is called; a word that is not known stays as it is.
    function named(word: string) : string {
        const keys = { live: "operator.mode_live", pilot: "operator.mode_pilot", simulated: "operator.mode_simulated",
                       running: "operator.status_running", "not ended": "operator.status_running", completed: "operator.status_completed", interrupted: "operator.status_interrupted",
                       abandoned: "operator.status_abandoned", stopped: "operator.status_stopped" }
        return word in keys ? text(keys[word]) : word
    }

    // `backup` is {state: none | recent | old | ahead, hours}
    function lastBackup(backup) {
        if (backup.state === "none") return text("backup_none")
        if (backup.state === "ahead")
            return text("backup_ahead")
        if (backup.state === "old")
            return fill("backup_old", Math.floor(backup.hours / 24))
        if (backup.hours < 48)
            return fill("backup_hours", backup.hours)
        return fill("backup_days", Math.floor(backup.hours / 24))
    }

    // `session` is {participant, protocol, trials, ageS}, or empty
    function interrupted(session) {
        if (session.participant === undefined) return ""
        return fill("operator.interrupted", session.participant, session.protocol, session.trials, ago(session.ageS))
    }
    function ago(seconds: real) : string {
        if (seconds < 0) return text("operator.ago_ahead")
        if (seconds < 120) return text("operator.ago_now")
        if (seconds < 7200) return fill("operator.ago_minutes", Math.floor(seconds / 60))
        if (seconds < 172800) return fill("operator.ago_hours", Math.floor(seconds / 3600))
        return fill("operator.ago_days", Math.floor(seconds / 86400))
    }

    // A day such as 2026-11-24 in words. Chinese and Japanese have no spaces, so word joiners keep the day on one
    // line.
    function day(date: string) : string {
        const said = Catalogue.day(date, language)
        return /^(ja|zh)/.test(language) ? said.split("").join("\u2060") : said
    }

    // `early` is {participant, session, from, last, lastDay, minDays}, or empty
    function tooEarly(early) {
        if (early.session === undefined) return ""
        return fill("operator.too_early", early.session, early.participant, day(early.from), early.last, day(early.lastDay), early.minDays)
    }

    readonly property string proceed: text("proceed")
    readonly property string done: text("done")
    readonly property string pressDone: text("press_done")
    readonly property string pause: text("pause")
    readonly property string getReady: text("get_ready")
    readonly property string slideHere: text("slide_here")
    readonly property string slideNow: text("slide_now")
    readonly property string right: text("right")
    readonly property string wrong: text("wrong")
    readonly property string answerNow: text("answer_now")
    readonly property string noted: text("noted")
    readonly property string failedTitle: text("failed_title")
    readonly property string failedText: text("failed_text")
    readonly property string speed: text("speed")
    readonly property string accuracy: text("accuracy")
    readonly property string breakTitle: text("break_title")
    readonly property string breakRunning: text("break_running")
    readonly property string breakOver: text("break_over")
    readonly property string seconds: text("seconds")
    readonly property string paused: text("paused")
    readonly property string pausedText: text("paused_text")
    readonly property string endSession: text("end_session")
    readonly property string reallyEnd: text("really_end")
    readonly property string endText: text("end_text")
    readonly property string endUnsaved: text("end_unsaved")
    readonly property string keepGoing: text("keep_going")
    readonly property string back: text("back")
    readonly property string faultTitle: text("please_wait")
    readonly property string whatHappened: text("what_happened")
    readonly property string whatIsSafe: text("what_is_safe")
    readonly property string whatToDo: text("what_to_do")
    readonly property string holdToArm: text("hold_to_arm")
    readonly property string thanks: text("thanks")
    readonly property string thanksText: text("thanks_text")
    readonly property string stoppedText: text("stopped_text")
    readonly property string forOperator: text("for_operator")
    readonly property string close: text("close")
    readonly property string consentTitle: text("consent_title")
    readonly property string declinedTitle: text("declined_title")
    readonly property string declinedText: text("declined_text")
    readonly property string consentYes: text("consent_yes")
    readonly property string consentNo: text("consent_no")
    readonly property string rightHand: text("right_hand")
    readonly property string leftHand: text("left_hand")
    readonly property string codeTitle: text("code_title")
    readonly property string codeHelp: text("code_help")
    readonly property string codeKnown: text("code_known")
    readonly property string codeYes: text("code_yes")
    readonly property string codeNo: text("code_no")
    readonly property string pilot: text("pilot")
    readonly property string pilotText: text("pilot_text")
    readonly property string simulated: text("simulated")
    readonly property string simulatedText: text("simulated_text")
}
