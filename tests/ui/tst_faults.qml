import QtQuick
import QtTest
import Turnpoint

// Tests a real session in which each fault happens that somebody in the room can cause.
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
        name: "Faults"
        when: windowShown

        readonly property PageModel page: session.bridge.page

        SignalSpy { id: shown; target: session.bridge; signalName: "shown" }

        function tap(name) {
            tryVerify(() => find(view, name) !== null, 20000, name)
            wait(400)
            tryVerify(() => find(view, name)?.armed, 20000, name)
            mouseClick(find(view, name))
        }
        function hold(name) {
            const button = find(view, name)
            mousePress(button)
            wait(1200)
            mouseRelease(button)
        }
        /// Waits for the next question. If the break after two trials comes first, continues after it.
        function untilAsked() {
            tryVerify(() => page.answersOpen && page.kind === PageModel.Stimulus
                            || page.kind === PageModel.Rest && page.remainingSeconds === 0, 20000)
            if (page.kind === PageModel.Rest) tap("proceed")
            tryVerify(() => page.answersOpen && page.kind === PageModel.Stimulus, 20000)
            wait(100)
        }
        function answer() {
            untilAsked()
            mouseClick(find(view, "answer1"))
            tryCompare(page, "answersOpen", false, 5000)
        }
        function explained(text) {
            tryVerify(() => page.kind === PageModel.Fault && page.text.includes(text), 20000, text)
            verify(page.safe !== "" && page.toDo !== "")
            wait(100)  // wait for the layout
            // A long path in the detail may be cut off on the page, because the log contains it in full.
            compare(inspector.cutTexts(view).filter(cut => cut !== page.detail), [])
        }
        function arm() {
            verify(find(view, "proceed") === null)
            if (!view.armable) {
                tap("operatorArms")
                view.armable = true
            }
            hold("holdToArm")
        }

        function test_after_each_fault_the_session_continues_where_it_was() {
            session.bridge.watch(stage.Window.window)
            session.start("short.toml")
            tap("proceed")

            untilAsked()
            session.setStop(true)
            explained("emergency stop")
            arm()
            // arming is refused while the stop is pressed
            tryVerify(() => page.detail.includes("refused"), 5000)
            session.setStop(false)
            arm()
            tryCompare(page, "kind", PageModel.Paused, 5000)
            tap("proceed")
            answer()

            untilAsked()
            session.setAmplifierFault(true)
            explained("amplifier reports")
            session.setAmplifierFault(false)
            arm()
            tryCompare(page, "kind", PageModel.Paused, 5000)
            tap("proceed")
            untilAsked()
            session.setDiskFull(true)
            mouseClick(find(view, "answer1"))
            explained("disk is full")
            const before = shown.count
            tap("proceed")
            tryVerify(() => shown.count > before, 5000)
            // the page appears again, because the disk is still full
            explained("disk is full")
            session.setDiskFull(false)
            tap("proceed")

            tryCompare(page, "kind", PageModel.Rest, 20000)
            session.find("converter_gone")
            explained("sound device was disconnected")
            tap("proceed")
            tryCompare(page, "kind", PageModel.Rest, 5000)

            untilAsked()
            session.find("touch_gone")
            explained("touch panel was disconnected")
            tap("proceed")
            answer()
            untilAsked()
            session.loseFrames(3)
            session.find("stimulus_missed")
            explained("was interrupted")
            tap("proceed")
            answer()

            tryCompare(session, "over", true, 20000)
            compare(session.failure, "")
            compare(page.kind, PageModel.End)
            compare(session.column("outcome"), "fault answered fault answered fault answered fault answered")
            const levels = session.column("level").split(" ")
            for (let i = 0; i < 8; i += 2) compare(levels[i + 1], levels[i])
            compare(session.events("frames_lost"), "3")
        }
    }
}
