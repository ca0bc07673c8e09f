import QtQuick
import QtTest
import Turnpoint

Item {
    id: stage
    width: 1280
    height: 800

    Loader {
        id: page
        anchors.fill: parent
        active: false
        sourceComponent: OperatorPage {
            operating: desk.operating
            pixelsPerMm: 5.9
        }
    }
    LiveView {
        id: liveView
        anchors.fill: parent
        visible: false
        live: desk.live
        bridge: script.bridge
        pixelsPerMm: 5.9
    }

    Texts { id: words; language: "en" }
    Theme { id: dense; width: stage.width; height: stage.height; pixelsPerMm: 5.9; dense: true }
    StationLine {
        id: line
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        visible: false
        theme: dense
        texts: words
        operating: desk.operating
    }

    PageTest {
        name: "Operator"
        when: windowShown

        readonly property OperatorController operating: desk.operating

        function initTestCase() { script.bridge.watch(stage.Window.window) }


        function tap(parent, name) {
            let button = null
            tryVerify(() => (button = find(parent, name)) !== null, 5000, name)
            mouseClick(button, button.width / 2, button.height / 2)
        }

        function test_a_backup_that_is_missing_or_old_is_marked_in_words_and_by_a_sign() {
            line.visible = true
            liveView.visible = false
            words.language = "en"
            tryVerify(() => says(line, "No backup yet"), 5000)
            verify(find(line, "backupDue") !== null)
            line.visible = false
        }
        function test_the_line_says_whether_the_station_is_fit_for_a_session() {
            line.visible = true
            words.language = "en"
            for (const name of ["sign-database", "sign-disk", "sign-clock", "sign-amplifier"]) tryVerify(() => find(line, name) !== null, 5000, name)
            verify(says(line, "Database: good"))
            verify(says(line, "Amplifier: off"))
            verify(says(line, desk.operating.station))
            desk.operating.setArmed(true)
            verify(says(line, "Amplifier: will be armed"))
            desk.operating.setArmed(false)
            compare(inspector.cutTexts(line), [])
            line.visible = false
        }
        function test_the_age_of_the_last_backup_is_shown_in_each_language_data() {
            return [{ tag: "en", age: "3 h ago", old: "9 days ago, older than 7 days" },
                    { tag: "de", age: "vor 3 h", old: "vor 9 Tagen, älter als 7 Tage" },
                    { tag: "ja", age: "3時間前", old: "9日前" }]
        }
        function test_the_age_of_the_last_backup_is_shown_in_each_language(row) {
            words.language = row.tag
            const told = backup => words.lastBackup(backup).replace(/\u2060/g, "")
            verify(told({ state: "recent", hours: 3 }).includes(row.age))
            verify(told({ state: "old", hours: 9 * 24 + 5 }).includes(row.old))
            verify(told({ state: "none", hours: 0 }) !== told({ state: "ahead", hours: 0 }))
        }


        function indexOf(id) {
            return operating.protocols.findIndex(protocol => protocol.id === id)
        }

        function test_an_operator_chooses_participant_protocol_and_mode() {
            page.active = true
            liveView.visible = false
            operating.select(indexOf("demo"))
            tryCompare(operating, "checking", false, 20000)
            verify(operating.facts.some(fact => fact.label.key === "operator.trials" && fact.value.startsWith("10")))
            verify(operating.cues.length > 0)
            compare(operating.mayBegin, true)
            verify(says(page.item, "Unwanted cues"))

            compare(operating.live, false)
            verify(says(page.item, "Begin pilot"))
            tap(page.item, "live")
            // The simulated rig has no measured friction, so choosing a live session is refused at once, with
            // that reason.
            tryVerify(() => operating.notLive.length > 0, 20000)
            verify(says(page.item, "Begin LIVE session"))
            compare(operating.notLive[0].key, "refusal.friction")
            verify(says(page.item, "Live is not possible: the rig uses the illustrative friction curve, which was not measured"))
            compare(operating.mayBegin, false)
            tap(page.item, "begin")
            compare(desk.chosen, "")
            operating.enterParticipant("T6")
            compare(operating.mayBegin, false)
            operating.enterParticipant("")
            tap(page.item, "pilot")
            compare(operating.notLive, [])
            compare(operating.mayBegin, true)

            tap(page.item, "language1")
            tap(page.item, "enterCode")
            const keypad = find(page.item, "operatorCode")
            for (const key of "T7") tap(keypad, "key" + key)
            tap(keypad, "accept")
            compare(operating.participant, "T7")
            verify(says(page.item, "T7 (new)"))

            operating.select(indexOf("demo"))
            tryCompare(operating, "checking", false, 20000)
            tap(page.item, "language1")
            tap(page.item, "begin")
            tryCompare(desk, "chosen", "demo T7 de pilot", 20000)
            page.active = false
        }

        function test_arming_takes_a_long_press() {
            page.active = true
            liveView.visible = false
            compare(operating.armed, false)
            tap(page.item, "arm")
            wait(50)
            compare(operating.armed, false)
            const arm = find(page.item, "arm")
            mousePress(arm)
            tryCompare(operating, "armed", true, 3000)
            mouseRelease(arm)
            wait(50)
            compare(operating.armed, true)
            tap(page.item, "arm")
            compare(operating.armed, false)
            page.active = false
        }

        function test_a_protocol_with_mistakes_lists_them_and_cannot_begin() {
            page.active = true
            operating.select(indexOf("mistaken.toml"))
            tryVerify(() => operating.problems.length > 0)
            // All problems are listed, because the first one may only follow from another one.
            const problems = operating.problems.map(problem => words.say(problem))
            verify(problems.length > 3, problems)
            verify(problems.every(problem => problem.includes("mistaken.toml:")))
            verify(problems.some(problem => problem.includes("protocl")))
            for (const problem of problems) verify(says(page.item, problem))
            compare(operating.mayBegin, false)
            page.active = false
        }

        function test_the_operator_pauses_repeats_annotates_and_stops() {
            liveView.visible = true
            const shown = spy.count
            script.show("explore", "en")
            tryVerify(() => spy.count > shown)
            script.forget()
            waitForRendering(liveView)
            tap(liveView, "livePause")
            const repeat = find(liveView, "liveRepeat")
            mousePress(repeat)
            tryVerify(() => script.inputs.includes("repeat"), 3000)
            mouseRelease(repeat)
            tap(liveView, "liveNote")
            tap(liveView, "quickNote1")
            tap(liveView, "keepNote")
            compare(script.inputs, ["pause", "repeat", "note noise in the room"])
            script.forget()
            const stop = find(liveView, "liveStop")
            const place = stop.mapToItem(stage, stop.width / 2, stop.height / 2)
            for (let i = 0; i < 3; ++i) mouseClick(stage, place.x, place.y)
            wait(400)
            for (let i = 0; i < 3; ++i) mouseClick(stage, place.x, place.y)
            compare(script.inputs, [])
            tap(liveView, "keep")
            compare(script.inputs, [])
            tap(liveView, "liveStop")
            wait(400)
            tap(liveView, "confirm")
            compare(script.inputs, ["stop"])
            script.show("end-early", "en")
            tryVerify(() => says(liveView, "It can be continued"))
            script.show("end", "en")
            tryVerify(() => says(liveView, "The session has ended."))
            liveView.visible = false
        }

        function test_where_three_pictures_do_not_fit_buttons_choose_one() {
            liveView.visible = true
            verify(find(liveView, "livePicture1") === null)
            stage.width = 800
            stage.height = 480
            tryVerify(() => find(liveView, "livePicture1") !== null)
            compare(liveView.shown, 0)
            tap(liveView, "livePicture1")
            compare(liveView.shown, 1)
            compare(inspector.cutTexts(liveView), [])
            stage.width = 1280
            stage.height = 800
            liveView.visible = false
        }

        function test_nothing_new_is_shown_to_the_operator_during_a_stimulus() {
            const shown = spy.count
            script.show("explore", "en")
            tryVerify(() => spy.count > shown)
            desk.tellLive("level 7")
            wait(100)
            verify(!desk.live.heading.includes("level 7"))
            compare(desk.live.held, true)
            script.show("between-trials", "en")
            tryVerify(() => desk.live.heading.includes("level 7"), 2000)
        }

        function test_in_an_adjustment_the_texts_are_updated_at_once_and_the_pictures_later() {
            liveView.visible = true
            script.show("between-trials", "en")
            tryCompare(desk.live, "held", false)
            script.show("adjust", "en")
            tryCompare(desk.live, "held", true)
            const drawn = pictures.count
            for (const setting of ["now 3.5", "now 4", "now -12"]) {
                desk.tellLive(setting)
                tryVerify(() => desk.live.heading.includes(setting), 2000)
            }
            compare(pictures.count, drawn)
            verify(find(liveView, "picturesLater") !== null)
            script.show("between-trials", "en")
            tryCompare(pictures, "count", drawn + 1)
            compare(find(liveView, "picturesLater"), null)
            liveView.visible = false
        }

        SignalSpy { id: spy; target: script.bridge; signalName: "shown" }
        SignalSpy { id: pictures; target: desk.live; signalName: "picturesChanged" }
    }
}
