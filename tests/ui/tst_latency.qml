import QtQuick
import QtTest
import Turnpoint

Item {
    id: stage
    width: 800
    height: 480

    LatencyPage {
        id: page
        anchors.fill: parent
        controller: desk.latency
        pixelsPerMm: 5.2
    }

    TestCase {
        name: "Latency"
        when: windowShown

        function tap() {
            const field = findChild(page, "latencyField")
            mousePress(field)
            mouseRelease(field)
        }
        function centre() {
            const field = findChild(page, "latencyField")
            const place = field.mapToItem(stage, field.width / 2, field.height / 2)
            return grabImage(stage).pixel(place.x, place.y).toString()
        }

        function test_taps_flash_and_their_latency_can_be_kept_once_there_are_enough() {
            const keep = findChild(page, "latencyKeep")
            tryVerify(() => centre() === "#000000")
            for (let k = 0; k < 10; ++k) {
                compare(keep.enabled, false)
                desk.pressed(50)
                tap()
                if (k === 0) tryVerify(() => centre() === "#ffffff")
                wait(410)  // wait until the edge is too old to be matched with a tap (400 ms)
            }
            tryCompare(desk.latency, "pairs", 10)
            compare(inspector.cutTexts(page), [])
            compare(inspector.faintTexts(page, 7), [])
            compare(desk.keptLatencyMs(), 0)
            mouseClick(keep)
            verify(desk.keptLatencyMs() >= 50 && desk.keptLatencyMs() < 150, desk.keptLatencyMs())
            // Only a long press deletes the taps.
            const again = findChild(page, "latencyAgain")
            mouseClick(again)
            compare(desk.latency.taps, 10)
            mousePress(again)
            tryCompare(desk.latency, "taps", 0, 3000)
            mouseRelease(again)
        }

        function test_every_text_has_room_in_every_language_data() {
            const rows = []
            for (const size of [[800, 480], [480, 800], [1280, 800]])
                for (const language of ["en", "de", "es", "ja", "zh", "ar"]) rows.push({ tag: language + " " + size[0] + "x" + size[1], language: language, size: size })
            return rows
        }
        function test_every_text_has_room_in_every_language(row) {
            stage.width = row.size[0]
            stage.height = row.size[1]
            OperatorScreen.language = row.language
            desk.latency.again()
            for (let k = 0; k < 3; ++k) {
                desk.pressed(50)
                tap()
                wait(120)
            }
            compare(inspector.cutTexts(page), [])
            compare(inspector.brokenWords(page), [])
            compare(inspector.overlaps(page), [])
            verify(findChild(page, "latencyField").height > 60, findChild(page, "latencyField").height)
        }
        function cleanup() {
            OperatorScreen.language = "en"
            desk.latency.again()
        }
    }
}
