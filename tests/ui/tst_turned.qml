import QtQuick
import QtTest
import Turnpoint

// Tests pages on a panel that is not mounted upright. A touch must reach what is seen under the finger, while its time
// comes from the kernel, which reports touches in the panel's own axes.
Item {
    id: stage
    width: 800
    height: 480

    TurnedPanel {
        id: panel
        ParticipantView {
            id: view
            anchors.fill: parent
            bridge: script.bridge
            pixelsPerMm: 5.2
        }
    }

    GalleryTest {
        name: "Turned"
        view: view
        when: windowShown

        function initTestCase() { script.bridge.watch(stage.Window.window) }
        function cleanupTestCase() { script.forgetKernel() }

        function test_pages_are_turned_and_touches_find_their_answer_data() {
            return [{ tag: "0", corner: Qt.point(0, 0), side: false }, { tag: "90", corner: Qt.point(800, 0), side: true },
                    { tag: "180", corner: Qt.point(800, 480), side: false }, { tag: "270", corner: Qt.point(0, 480), side: true }]
        }
        function test_pages_are_turned_and_touches_find_their_answer(row) {
            panel.degrees = parseInt(row.tag)
            compare(Qt.size(view.width, view.height), row.side ? Qt.size(480, 800) : Qt.size(800, 480))
            const corner = view.mapToItem(stage, 0, 0)
            fuzzyCompare(corner.x, row.corner.x, 0.01)
            fuzzyCompare(corner.y, row.corner.y, 0.01)
            for (let k = 0; k < 2; ++k) {
                show("between-trials")
                show("response")
                wait(400)  // a page ignores taps that were meant for the one before
                script.forget()
                compare(inspector.cutTexts(view), [])
                const answer = findChild(view, "answer" + k)
                const place = answer.mapToItem(stage, answer.width / 2, answer.height / 2)
                verify(place.x > 0 && place.x < 800 && place.y > 0 && place.y < 480, place)
                script.setKernelTouch(place.x / 800, place.y / 480)
                mouseClick(stage, place.x, place.y)
                tryCompare(script, "inputs", ["answer " + k])
                compare(script.quality(), "kernel")
            }
        }
    }
}
