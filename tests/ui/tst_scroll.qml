import QtQuick
import QtTest
import Turnpoint

// What is below the edge of a place that scrolls is told, and where one is in it.
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
        ScrollCue { id: cue; theme: look; place: place }
    }

    TestCase {
        name: "Scrolling"
        when: windowShown

        function test_the_cue_shows_what_part_is_seen_and_where_it_is() {
            place.contentHeight = 520
            place.contentY = 0
            verify(cue.visible)
            fuzzyCompare(cue.height, 260 * 260 / 520, 0.5)
            fuzzyCompare(cue.y, 20, 0.5)
            place.contentY = 260
            fuzzyCompare(cue.y + cue.height, 20 + 260, 0.5)
            verify(cue.x >= place.x + place.width && cue.x + cue.width <= card.width)
        }
        function test_where_all_is_seen_there_is_no_cue() {
            place.contentHeight = 260
            verify(!cue.visible)
            place.contentHeight = 300
            verify(cue.visible)
        }
    }
}
