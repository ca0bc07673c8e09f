import QtQuick
import QtTest
import Turnpoint

Item {
    id: stage
    width: 800
    height: 480

    Theme { id: theme; width: stage.width; height: stage.height; pixelsPerMm: 5.2 }
    Texts { id: texts; language: "en" }
    CodePage {
        id: page
        anchors.fill: parent
        theme: theme
        texts: texts
    }

    TestCase {
        name: "Code"
        when: windowShown

        SignalSpy { id: accepted; target: page; signalName: "accepted" }

        function init() {
            page.known = false
            page.clear()
            accepted.clear()
        }

        function tap(name) {
            const key = findChild(page, name)
            verify(key, name)
            mouseClick(key)
        }

        function type(code) { for (const c of code) tap("key" + c) }

        function test_a_code_is_typed_on_the_stations_own_keypad() {
            type("P0")
            tap("backspace")
            type("17")
            tap("accept")
            compare(accepted.count, 1)
            compare(accepted.signalArguments[0][0], "P17")
        }

        function test_an_empty_code_is_not_accepted() {
            tap("accept")
            compare(accepted.count, 0)
        }

        function test_a_code_has_at_most_eight_characters_and_no_leading_hyphen() {
            type("-ABCDEFGHIJ")
            tap("accept")
            compare(accepted.signalArguments[0][0], "ABCDEFGH")
        }

        function test_a_known_code_is_confirmed() {
            page.known = true
            type("P1")
            tap("accept")
            compare(accepted.count, 0)
            tap("mine")  // this tap comes too early: nobody can have read the page yet
            compare(accepted.count, 0)
            wait(400)
            tap("notMine")
            type("P2")
            tap("accept")
            wait(400)
            tap("mine")
            compare(accepted.signalArguments[0][0], "P2")
        }
    }
}
