import QtQuick
import QtTest
import Turnpoint

// Nine answers with labels as long as `check` accepts without a remark: all of them can be read in full, on buttons that a
// finger can hit.
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

    GalleryTest {
        name: "Labels"
        view: view
        when: windowShown

        function test_nine_long_answers_are_read_in_full_on_large_targets_data() {
            const rows = []
            for (const panel of [{ width: 800, height: 480, mm: 5.2 }, { width: 1280, height: 800, mm: 5.9 }, { width: 480, height: 800, mm: 5.2 }])
                for (const language of ["en", "de", "ja", "ar", "zh"])
                    rows.push({ tag: language + " " + panel.width, language: language, panel: panel })
            return rows
        }
        function test_nine_long_answers_are_read_in_full_on_large_targets(row) {
            resize(row.panel)
            show("choices-9-long", row.language)
            for (let i = 0; i < 9; ++i) {
                const button = findChild(view, "answer" + i), label = button.children[0]
                verify(button.visible)
                verify(Math.min(button.width, button.height) >= 20 * row.panel.mm, "size of button " + i)
                verify(label.font.pixelSize >= Math.floor(2.4 * row.panel.mm), "letters of " + label.font.pixelSize + " pixels")
                verify(label.contentHeight <= label.height + 1, label.contentHeight + " in " + label.height)
                verify(label.contentWidth <= label.width + 1, label.contentWidth + " in " + label.width)
                const corner = button.mapToItem(view, button.width, button.height)
                verify(corner.x <= view.width && corner.y <= view.height)
            }
            compare(inspector.cutTexts(view), [])
            compare(inspector.brokenWords(view), [])
        }
    }
}
