import QtQuick
import QtTest
import Turnpoint

// Tests that text from a file or a person is shown literally: tags have no effect, and no picture is opened.
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
    Text { id: rich }

    PageTest {
        name: "Text"
        when: windowShown

        function saysPlainly(parent, wanted) {
            return all(parent, item => item.text === wanted && item.textFormat === Text.PlainText).length > 0
        }
        function hostile() { return "<b>bold</b><img src=\"file://" + inspector.picture() + "\">" }

        function test_text_in_qts_automatic_format_opens_the_picture() {
            rich.text = hostile()
            tryVerify(() => inspector.opened() > 0, 5000)
            rich.text = ""
        }

        function test_pages_show_markup_literally_data() {
            return ["instructions", "explore", "response", "feedback-right", "too-slow", "rest", "fault-disk_full",
                    "fault-other", "end-operator"].map(name => ({ tag: name }))
        }
        function test_pages_show_markup_literally(row) {
            const text = hostile()
            script.showWith(row.tag, text)
            waitForRendering(stage)
            if (row.tag.startsWith("instructions") || row.tag.startsWith("fault")) verify(saysPlainly(view, text))
            compare(inspector.opened(), 0)
        }

        function test_the_start_page_shows_a_protocols_title_literally() {
            room.open("7391")
            const text = hostile()
            room.entitle(text)
            room.reopen("7391")
            tryVerify(() => room.operating.mayBegin, 20000)
            tryVerify(() => saysPlainly(room.screen, text), 5000)
            compare(inspector.opened(), 0)
            room.close()
        }
    }
}
