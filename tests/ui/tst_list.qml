import QtQuick
import QtTest
import Turnpoint

// Tests that the chosen protocol is in view in its list.
Item {
    id: stage
    width: 800
    height: 480

    Theme { id: look; width: 800; height: 480; pixelsPerMm: 5.2; dense: true }
    Loader {
        id: page
        width: 280
        height: 300
        active: false
        property int selected: 0
        property var protocols: []
        sourceComponent: ProtocolList {
            theme: look
            protocols: page.protocols
            selected: page.selected
            emptyText: "none"
            unusableText: "unusable"
            onChosen: index => page.selected = index
        }
    }

    TestCase {
        name: "List"
        when: windowShown

        function many(count = 30) {
            const list = []
            for (let i = 0; i < count; ++i) list.push({ id: "protocol-" + i, title: "Title of the protocol " + i, usable: true })
            return list
        }
        function init() {
            page.protocols = many()
            page.selected = 0
            page.height = 300
        }
        function cleanup() { page.active = false }
        function inView(index) {
            const list = findChild(page.item, "protocols"), card = findChild(list, "protocol" + index)
            if (!card) return false
            const top = card.mapToItem(list, 0, 0).y
            return top >= -1 && top + card.height <= list.height + 1
        }

        function test_a_protocol_that_was_chosen_before_the_page_was_opened_is_in_view() {
            page.selected = 20
            page.active = true
            tryVerify(() => inView(20))
        }
        function test_a_protocol_that_is_chosen_elsewhere_is_scrolled_into_view() {
            page.active = true
            tryVerify(() => inView(0))
            page.selected = 27
            tryVerify(() => inView(27))
            page.selected = 2
            tryVerify(() => inView(2))
        }
        function test_the_chosen_protocol_stays_in_view_if_the_list_is_read_again_or_becomes_lower() {
            page.active = true
            page.selected = 20
            tryVerify(() => inView(20))
            page.protocols = many()
            wait(50)
            verify(inView(20))
            page.height = 150
            tryVerify(() => inView(20))
            page.protocols = many(40)
            wait(50)
            verify(inView(20))
        }
        function test_the_list_stays_where_the_operator_scrolled_it() {
            page.active = true
            tryVerify(() => inView(0))
            const list = findChild(page.item, "protocols")
            list.contentY = 400
            page.protocols = many()
            wait(50)
            compare(list.contentY, 400)
        }
    }
}
