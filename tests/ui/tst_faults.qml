import QtQuick
import QtTest
import Turnpoint

// A real session with every fault that can happen in the room.
Item {
    id: stage
    width: 800
    height: 480

    ParticipantView {
        id: view
        anchors.fill: parent
        bridge: sitting.bridge
        pixelsPerMm: 5.2
    }

    TestCase {
        name: "Faults"
        when: windowShown

        readonly property PageModel page: sitting.bridge.page

        SignalSpy { id: shown; target: sitting.bridge; signalName: "shown" }

        function find(parent, name) {
            for (let i = 0; i < parent.children.length; ++i) {
                const child = parent.children[i]
                if (!child.visible) continue
                const found = child.objectName === name ? child : find(child, name)
                if (found) return found
            }
            return null
        }
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
        /// Continues past the break after two trials, if it comes.
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
            // A long path in the detail may be cut off on the page; the log contains all of it.
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

        function test_after_each_fault_the_session_goes_on_where_it_was() {
            sitting.bridge.watch(stage.Window.window)
            sitting.start("short.toml")
            tap("proceed")

            untilAsked()
            sitting.setStop(true)
            explained("emergency stop")
            arm()
            tryVerify(() => page.detail.includes("refused"), 5000)   // the stop is still pressed
            sitting.setStop(false)
            arm()
            tryCompare(page, "kind", PageModel.Paused, 5000)
            tap("proceed")
            answer()

            untilAsked()
            sitting.setAmplifierFault(true)
            explained("amplifier reports")
            sitting.setAmplifierFault(false)
            arm()
            tryCompare(page, "kind", PageModel.Paused, 5000)
            tap("proceed")
            untilAsked()
            sitting.setDiskFull(true)
            mouseClick(find(view, "answer1"))
            explained("disk is full")
            const before = shown.count
            tap("proceed")
            tryVerify(() => shown.count > before, 5000)
            explained("disk is full")                                // the disk is still full
            sitting.setDiskFull(false)
            tap("proceed")

            tryCompare(page, "kind", PageModel.Rest, 20000)
            sitting.find("converter_gone")
            explained("sound device was disconnected")
            tap("proceed")
            tryCompare(page, "kind", PageModel.Rest, 5000)

            untilAsked()
            sitting.find("touch_gone")
            explained("touch panel was disconnected")
            tap("proceed")
            answer()
            untilAsked()
            sitting.loseFrames(3)
            sitting.find("stimulus_missed")
            explained("was interrupted")
            tap("proceed")
            answer()

            tryCompare(sitting, "over", true, 20000)
            compare(sitting.failure, "")
            compare(page.kind, PageModel.End)
            compare(sitting.column("outcome"), "fault answered fault answered fault answered fault answered")
            const levels = sitting.column("level").split(" ")
            for (let i = 0; i < 8; i += 2) compare(levels[i + 1], levels[i])
            compare(sitting.events("frames_lost"), "3")
        }
    }
}
