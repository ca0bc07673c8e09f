import QtQuick
import QtTest
import Turnpoint

// Tests that a scrolling area shows its current position, and whether there is more below its edge.
Item {
    id: stage
    width: 400
    height: 300

    Theme {
        id: look
        width: stage.width
        height: stage.height
        pixelsPerMm: 5
        dense: true
    }
    Rectangle {
        id: card
        anchors.fill: parent
        color: look.raised
        Flickable {
            id: place
            anchors { fill: parent; margins: 20 }
            contentHeight: 520
            clip: true
        }
        Item {
            id: above
            width: 100
            height: 100
            clip: true
            Rectangle { width: 100; height: 100; color: "white" }
            Glyph { id: sign; height: 40; name: "alert"; color: "black" }
        }
        ScrollCue { id: cue; theme: look; place: place }
    }

    TestCase {
        name: "Scrolling"
        when: windowShown

        function test_the_cue_shows_which_part_is_visible() {
            place.contentHeight = 520
            place.contentY = 0
            verify(cue.visible)
            fuzzyCompare(cue.height, 260 * 260 / 520, 0.5)
            fuzzyCompare(cue.y, 20, 0.5)
            place.contentY = 260
            fuzzyCompare(cue.y + cue.height, 20 + 260, 0.5)
            verify(cue.x >= place.x + place.width && cue.x + cue.width <= card.width)
        }
        /// Returns the darkness (0 to 1) of the darkest pixel near the middle of the symbol at (0, y).
        function darkest(y) {
            const image = grabImage(stage)
            let least = 1
            for (let x = 0; x < 40; ++x)
                for (let dy = 0; dy < 40; ++dy) least = Math.min(least, image.red(x, y + dy) / 255)
            return least
        }
        function test_a_symbol_stays_inside_the_area_that_clips_it() {
            sign.y = 30
            verify(darkest(30) < 0.3)
            sign.y = 110
            verify(darkest(110) > 0.5)
            sign.y = 30
            verify(darkest(30) < 0.3)
        }

        function test_there_is_no_cue_if_everything_is_visible() {
            place.contentHeight = 260
            verify(!cue.visible)
            place.contentHeight = 300
            verify(cue.visible)
        }
    }
}
