import QtQuick
import QtTest
import Turnpoint

Item {
    id: stage
    width: 800
    height: 480

    ParticipantView {
        id: view
        anchors.fill: parent
        bridge: session.bridge
        pixelsPerMm: 5.2
    }

    PageTest {
        name: "Session"
        when: windowShown

        readonly property PageModel page: session.bridge.page

        function answer(choice) {
            tryCompare(page, "answersOpen", true, 20000)
            wait(150)
            const button = findChild(view, "answer" + choice)
            const touch = touchEvent(stage)
            touch.press(1, button).commit()
            touch.release(1, button).commit()
            tryCompare(page, "answersOpen", false, 5000)
        }

        function proceed() {
            wait(400)
            const found = named(view, "proceed")
            compare(found.length, 1)
            tryCompare(found[0], "armed", true, 20000)
            mouseClick(found[0])
        }

        // The answers do not depend on the levels, so that each row can be compared with the answer that was
        // tapped.
        function test_a_whole_session_answered_by_taps_is_in_the_database() {
            session.bridge.watch(stage.Window.window)
            session.start("short.toml")
            tryCompare(page, "kind", PageModel.Instructions, 30000)
            compare(page.runMode, "pilot")
            proceed()
            answer(0)
            answer(1)
            tryCompare(page, "kind", PageModel.Rest, 20000)
            tryCompare(page, "remainingSeconds", 0, 5000)
            proceed()
            answer(1)
            answer(1)
            tryCompare(session, "over", true, 20000)
            compare(session.failure, "")
            compare(page.kind, PageModel.End)
            compare(session.column("response"), "left right right right")
            compare(session.column("outcome"), "answered answered answered answered")
            compare(session.column("run_mode"), "pilot pilot pilot pilot")
            compare(session.column("response_time_quality"), "toolkit toolkit toolkit toolkit")
            compare(session.column("extra_touches"), "0 0 0 0")
            const times = session.column("response_time").split(" ")
            for (let i = 0; i < times.length; ++i) verify(Number(times[i]) > 0.1 && Number(times[i]) < 2, times[i])
        }

        // Both pages have a second answer at the same place. A finger that taps there all the time must not say with the
        // next tap how sure the answer was.
        function test_confidence_is_never_a_tap_that_followed_the_answer_at_once() {
            session.bridge.watch(stage.Window.window)
            session.start("sure.toml")
            tryCompare(page, "kind", PageModel.Instructions, 30000)
            proceed()
            for (let trial = 0; trial < 2; ++trial) {
                tryCompare(page, "answersOpen", true, 20000)
                wait(150)
                // the answers of the second page open as soon as the first is answered
                while (page.answersOpen) {
                    const touch = touchEvent(stage)
                    touch.press(1, findChild(view, "answer1")).commit()
                    touch.release(1, findChild(view, "answer1")).commit()
                    wait(60)
                }
            }
            tryCompare(session, "over", true, 20000)
            compare(session.failure, "")
            compare(session.column("response"), "right right")
            compare(session.column("confidence"), "2 2")
            for (const time of session.column("confidence_time").split(" ")) verify(Number(time) >= 0.35, time)
        }
    }
}
