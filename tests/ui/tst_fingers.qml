import QtQuick
import QtTest
import Turnpoint

// Tests taps that nobody meant: double taps, taps with a second finger, and taps of a hand that is moved
// while a page is shown. None of them may end a session, skip a page, or keep somebody from pausing.
Item {
    id: stage
    width: 800
    height: 480

    ParticipantView {
        id: view
        anchors.fill: parent
        bridge: script.bridge
        pixelsPerMm: 5.2
    }

    GalleryTest {
        name: "Fingers"
        view: view
        when: windowShown

        readonly property var panels: [{ width: 800, height: 480, mm: 5.2 }, { width: 1280, height: 800, mm: 5.9 },
                                       { width: 480, height: 800, mm: 5.2 }, { width: 800, height: 1280, mm: 5.9 }]

        function initTestCase() { script.bridge.watch(stage.Window.window) }
        function init() {
            view.leftHanded = false
            resize(panels[0])
            show("between-trials")
            script.forget()
        }
        function button(name) {
            const found = named(view, name)
            compare(found.length, 1, name)
            return found[0]
        }
        function untilArmed() { wait(400) }
        function centre(item) { return item.mapToItem(stage, item.width / 2, item.height / 2) }
        function tapTwice(item) {
            const place = centre(item)
            mouseClick(stage, place.x, place.y)
            mouseClick(stage, place.x, place.y)
        }

        function test_pause_keeps_its_size_if_the_hand_changes_while_a_page_is_shown_data() {
            return panels.map(panel => ({ tag: panel.width + "x" + panel.height, panel: panel }))
        }
        function test_pause_keeps_its_size_if_the_hand_changes_while_a_page_is_shown(row) {
            resize(row.panel)
            show("explore-speed")
            const pause = button("pause"), badge = all(view, item => item.instruction === "speed")[0]
            const width = pause.width
            compare(pause.mapToItem(view, pause.width, 0).x > 0.9 * view.width, true)
            for (const left of [true, false, true]) {
                view.leftHanded = left
                compare(pause.width, width)
                compare(centre(pause).x < view.width / 2, left)
                compare(centre(badge).x > view.width / 2, left)
                verify(badge.width < 0.6 * view.width)
            }
        }

        function test_pause_acts_when_the_finger_comes_down() {
            show("explore")
            const pause = button("pause")
            mousePress(pause)
            compare(script.inputs, ["pause"])
            mouseRelease(pause)
            compare(script.inputs, ["pause"])
        }

        function test_pause_acts_although_another_finger_rests_on_the_page_data() {
            return [{ tag: "on an answer", page: "explore", under: "answer0" },
                    { tag: "on the slider", page: "adjust", under: "slider" },
                    { tag: "on Continue", page: "instructions", under: "proceed" }]
        }
        function test_pause_acts_although_another_finger_rests_on_the_page(row) {
            show(row.page)
            untilArmed()
            const place = centre(button(row.under)), pause = centre(button("pause"))
            const touch = touchEvent(stage)
            touch.press(1, stage, place.x, place.y).commit()
            wait(60)
            script.forget()
            touch.stationary(1).press(2, stage, pause.x, pause.y).commit()
            touch.stationary(1).release(2, stage, pause.x, pause.y).commit()
            verify(script.inputs.includes("pause"))
            touch.release(1, stage, place.x, place.y).commit()
        }

        function test_no_double_tap_ends_the_session_or_leaves_two_pages_data() {
            const rows = []
            for (const panel of panels)
                for (const page of ["instructions", "rest-over", "adjust", "paused", "fault-other", "fault-disarmed",
                                    "fault-disk_full", "failed", "end"])
                    rows.push({ tag: page + " " + panel.width + "x" + panel.height, page: page, panel: panel })
            return rows
        }
        function test_no_double_tap_ends_the_session_or_leaves_two_pages(row) {
            resize(row.panel)
            show(row.page)
            closed.clear()
            const count = all(view, item => item.holdMs !== undefined).length
            verify(count > 0)
            for (let i = 0; i < count; ++i) {
                show("between-trials")
                show(row.page)
                tapTwice(all(view, item => item.holdMs !== undefined)[i])
                // these taps come too early and must be ignored
                compare(script.inputs.filter(input => input !== "pause"), [])
                untilArmed()
                tapTwice(all(view, item => item.holdMs !== undefined)[i])
                verify(!script.inputs.includes("stop"))
                verify(script.inputs.filter(input => input === "next").length <= 1, script.inputs)
                script.forget()
            }
        }

        function test_a_second_fault_is_not_dismissed_by_a_tap_meant_for_the_first() {
            show("fault-stimulus_missed")
            untilArmed()
            show("fault-limits")
            tapTwice(button("proceed"))
            compare(script.inputs, [])
        }

        function test_ending_the_session_takes_two_taps_at_different_places_data() {
            const rows = []
            for (const panel of panels)
                for (const page of ["paused", "fault-other", "fault-disarmed"])
                    rows.push({ tag: page + " " + panel.width + "x" + panel.height, page: page, panel: panel })
            return rows
        }
        function test_ending_the_session_takes_two_taps_at_different_places(row) {
            resize(row.panel)
            show(row.page)
            untilArmed()
            const end = button("end"), place = centre(end)
            mouseClick(end)
            untilArmed()
            compare(script.inputs, [])
            const keep = button("keep"), confirm = button("confirm")
            const inside = confirm.mapFromItem(stage, place.x, place.y)
            verify(!confirm.contains(Qt.point(inside.x, inside.y)))
            // the safe choice must be to the left or above
            verify(centre(keep).x < centre(confirm).x || centre(keep).y < centre(confirm).y)
            mouseClick(stage, place.x, place.y)
            compare(script.inputs, [])
            untilArmed()
            if (!find(view, "confirm")) {
                mouseClick(button("end"))
                untilArmed()
            }
            mouseClick(button("keep"))
            compare(script.inputs, [])
            mouseClick(button("end"))
            untilArmed()
            mouseClick(button("confirm"))
            compare(script.inputs, ["stop"])
        }

        function test_who_ends_the_session_while_the_disk_is_full_reads_what_is_lost() {
            show("fault-disk_full")
            untilArmed()
            mouseClick(button("end"))
            verify(says(view, "last answer"))
        }

        function test_the_end_page_ignores_taps_that_were_meant_for_an_answer() {
            show("explore")
            show("end")
            closed.clear()
            mouseClick(button("close"))
            compare(closed.count, 0)
            untilArmed()
            mouseClick(button("close"))
            compare(closed.count, 1)
        }

        SignalSpy { id: closed; target: view; signalName: "closed" }
    }
}
