import QtQuick
import QtTest
import Turnpoint

// Tests that the operator's pages say everything in the operator's language. Only messages of the system and of
// devices are in English, and names from a protocol stay as they are.
Item {
    id: stage
    width: 1280
    height: 800

    Theme { id: large; width: 1280; height: 800; pixelsPerMm: 5.9 }
    Texts { id: english; language: "en" }
    EndPage {
        id: ended
        anchors.fill: parent
        theme: large
        texts: english
        bridge: script.bridge
    }
    SignalSpy { id: told; target: script.bridge; signalName: "shown" }

    RoomTest {
        name: "Words"
        when: windowShown

        readonly property var languages: ["de", "es", "ja", "zh", "ar"]

        function init() { room.open("1234") }
        function cleanup() { room.close() }

        /// Parts of the pages that stay as they are: the program's name, names of languages, names from the files of
        /// the protocol and the rig, of file systems, times in minutes, and words that other languages share with English.
        function isName(text, language) {
            const names = ["Turnpoint", "English", "Deutsch", "Español", "short", "short.toml", "Four quick trials",
                           "Aluminium tapered plate, simulated", "edge"]
            const shared = { de: ["Text 100 %", "Block", "Fit", "Station", "PSE", "Finger", "Status", "Protocol"] }
            return names.includes(text) || (shared[language] ?? []).includes(text) || text.includes("/") || /^[0-9.]+ min$/.test(text) || /^(ext[234]|xfs|btrfs|f2fs|overlay|tmpfs|0x[0-9a-f]+)$/.test(text) || /^[0-9a-f-]{36}$/.test(text)
        }
        /// Texts with an English word that are also on the page in English.
        function untranslated(english, texts, messages, language) {
            return texts.filter(text => /[a-z]{3}/.test(text) && english.includes(text) && !isName(text, language)
                                        && !messages.some(message => message !== "" && text.includes(message)))
        }
        /// Shows a page in English and in each other language, and returns what was not translated.
        function englishOn(place, ready, messages) {
            const faults = []
            room.look.language = "en"
            tap("bar-" + place)
            tryVerify(ready, 20000)
            wait(50)
            const english = texts(room.screen)
            for (const language of languages) {
                room.look.language = language
                wait(50)
                for (const text of untranslated(english, texts(room.screen), messages(), language)) faults.push(language + ": " + text)
            }
            return faults.join("\n")
        }

        function test_a_check_is_described_in_the_language_of_the_operator_on_the_start_page() {
            compare(englishOn("run", () => !room.operating.checking && room.operating.facts.length > 0, () => []), "")
            room.look.language = "de"
            verify(texts(room.screen).includes("Dauer"), texts(room.screen).join("\n"))
            verify(texts(room.screen).some(text => text.includes("richtig nur mit diesem Hinweisreiz")))
        }
        function test_a_check_is_described_in_the_language_of_the_operator_on_the_page_of_studies() {
            const studies = () => find(room.screen, "studiesPage").studies
            compare(englishOn("studies", () => studies().facts.length > 0, () => []), "")
        }
        function test_doctor_and_self_test_speak_the_language_of_the_operator() {
            // What the system reports, such as why a file cannot be opened, stays as it is.
            const reported = ["No such", "Permission denied", "not permitted"]
            const rig = () => find(room.screen, "rigPage").rig
            tap("bar-rig")
            tap("examine")
            tryVerify(() => rig().busy === "" && rig().findings.length > 5, 30000)
            compare(englishOn("rig", () => find(room.screen, "finding5") !== null, () => reported), "")
            room.look.language = "de"
            wait(50)
            verify(texts(room.screen).includes("Echtzeitpriorität"), texts(room.screen).join("\n"))
            tap("selfTestTab")
            rig().selfTest()
            tryVerify(() => rig().busy === "" && rig().checks.length > 3, 60000)
            const faults = []
            room.look.language = "en"
            wait(50)
            const english = texts(room.screen)
            for (const language of languages) {
                room.look.language = language
                wait(50)
                for (const text of untranslated(english, texts(room.screen), [], language)) faults.push(language + ": " + text)
            }
            compare(faults.join("\n"), "")
        }
        function test_the_reason_against_a_live_session_is_in_the_language_of_the_operator() {
            tryVerify(() => room.operating.mayBegin, 20000)
            tap("live")
            tryVerify(() => !room.operating.preparing && !room.operating.mayBegin, 20000)
            room.look.language = "de"
            tryVerify(() => texts(room.screen).includes("Echte Sitzung nicht möglich: der Aufbau verwendet die Beispielkurve der Reibung, die nicht gemessen wurde"),
                      2000, texts(room.screen).join("\n"))
            compare(englishOn("run", () => !room.operating.checking, () => []), "")
        }

        function test_sessions_and_reports_are_in_the_language_of_the_operator() {
            compare(room.cutOffSession("pilot"), -9)
            const sessions = () => find(room.screen, "sessionsPage").sessions
            const said = () => [sessions().chosen.protocol ?? "", sessions().chosen.started ?? ""]
            compare(englishOn("sessions", () => find(room.screen, "session0") !== null, said), "")
            room.look.language = "de"
            verify(texts(room.screen).some(text => text.includes("Probelauf") && text.includes("nicht beendet")), texts(room.screen).join("\n"))
            tap("makeReport")
            tryVerify(() => find(room.screen, "saveFigure") !== null, 20000)
            wait(50)
            const report = texts(find(room.screen, "storedReport"))
            for (const word of ["Dargeboten", "Beantwortet", "Stufen", "Tempo und Genauigkeit"]) verify(report.includes(word), report.join("\n"))
            for (const word of ["Presented", "Levels", "Speed and accuracy", "Fit"]) verify(!report.includes(word), word)
            verify(report.some(text => text.startsWith("• ")), report.join("\n"))
            for (const text of report) verify(!/^• .*\b(the|is|are|of)\b/.test(text), text)
        }
        function test_what_became_of_backups_and_data_is_said_in_the_language_of_the_operator() {
            compare(room.cutOffSession("pilot"), -9)
            room.look.language = "de"
            tap("bar-sessions")
            tryVerify(() => find(room.screen, "session0") !== null, 5000)
            tap("backUp")
            tap("place0")
            tryVerify(() => texts(room.screen).some(text => text.includes("zurückgelesen und geprüft")), 20000)
            tap("withdraw")
            tryVerify(() => find(room.screen, "withdrawing") !== null, 20000)
            tryVerify(() => find(room.screen, "withdrawing").text.includes("Das würde von T1 gelöscht:"), 5000)
        }
        function test_the_end_of_a_session_in_numbers_is_in_the_language_of_the_operator() {
            const words = ["Durchgänge", "Zu spät", "Richtig", "main, Schwelle", "Die Sitzung in Zahlen", "Schließen"]
            OperatorScreen.language = "de"
            const before = told.count
            script.show("end-operator", "en")
            tryCompare(told, "count", before + 1)
            ended.counting = true
            const shown = texts(ended)
            OperatorScreen.language = "en"
            for (const word of words) verify(shown.includes(word), word + " in " + shown.join("; "))
        }

        function test_a_participant_who_comes_too_early_is_told_so_in_the_language_of_the_session() {
            room.planSessions()
            room.reopen("1234")
            tryVerify(() => room.operating.mayBegin, 20000)
            tap("begin")
            tryVerify(() => find(room.screen, "languagePage") !== null, 20000)
            tap("language1")                           // German
            for (const key of "T1") tap("key" + key)
            tap("accept")
            tap("mine")
            tryVerify(() => room.page.kind === PageModel.Failed, 20000)
            tryVerify(() => texts(room.screen).some(text => text.startsWith("Zu früh: Sitzung 2 von T1 beginnt frühestens am")), 2000, texts(room.screen).join("\n"))
            verify(texts(room.screen).includes("Bitte rufen Sie die Versuchsleitung"))
            verify(!texts(room.screen).some(text => text.includes("participant T1")))
            // Nothing was stored, so the page does not say that it is safe.
            verify(!texts(room.screen).some(text => text.includes("gespeichert")))
        }
    }
}
