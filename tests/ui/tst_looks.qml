import QtQuick
import QtTest
import Turnpoint

// Checks every rendered page on a small and on a larger panel. No text may be faint or cut off, and no word
// may be broken.
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
    Rectangle {
        id: control
        anchors.fill: parent
        visible: false
        color: "white"
        Text {
            id: sample
            property real cut: 0
            width: 300 - cut
            text: "faint or cut"
            font.pixelSize: 30
            color: "#777777"
            elide: Text.ElideRight
        }
        Text {
            id: longWord
            visible: false
            y: 100
            width: 200
            text: "Reibungsreicher geworden"
            font.pixelSize: 30
            wrapMode: Text.Wrap
        }
        Rectangle {
            id: drawing
            y: 300
            width: 200
            height: 100
            Rectangle { id: drawn; x: 20; y: 20; width: 100; height: 20; color: "black" }
        }
    }

    GalleryTest {
        name: "Looks"
        view: view
        when: windowShown

        function place(row) {
            resize(row.panel)
            show(row.page, row.language)
        }

        function test_answers_on_one_page_have_the_same_font_size_however_long_they_are_data() {
            return [{ tag: "long", page: "explore-speed", language: "de", panel: { width: 800, height: 480, mm: 5.2 } },
                    { tag: "short", page: "explore", language: "en", panel: { width: 800, height: 480, mm: 5.2 } }]
        }
        function test_answers_on_one_page_have_the_same_font_size_however_long_they_are(row) {
            place(row)
            const first = findChild(view, "answer0").children[0], second = findChild(view, "answer1").children[0]
            compare(first.font.pixelSize, second.font.pixelSize)
            verify(first.font.pixelSize >= 3.4 * row.panel.mm)
            // Answers have their normal size only if all of them are short.
            compare(first.font.pixelSize === Math.round(4 * Math.min(row.panel.width / 80, row.panel.height / 48)), row.tag === "short")
        }

        function test_text_that_is_faint_or_cut_off_is_detected() {
            control.visible = true
            compare(inspector.texts(control), 1)
            compare(inspector.faintTexts(control, 7), ["faint or cut: 4.48"])
            compare(inspector.faintTexts(control, 4.4), [])
            sample.color = "#555555"
            compare(inspector.faintTexts(control, 7), [])
            compare(inspector.cutTexts(control), [])
            sample.cut = 200
            compare(inspector.cutTexts(control), ["faint or cut"])
            sample.visible = false
            longWord.visible = true
            compare(inspector.brokenWords(control), ["Reibungsreicher"])
            longWord.font.pixelSize = 20
            compare(inspector.brokenWords(control), [])
            verify(!inspector.reachesEdge(drawing))
            drawn.x = 120
            verify(inspector.reachesEdge(drawing))
            control.visible = false
        }

        function test_a_tall_panel_shows_faults_in_large_type_data() {
            const rows = []
            for (const panel of [{ width: 800, height: 1280, mm: 5.9 }, { width: 480, height: 800, mm: 5.2 }])
                for (const language of ["de", "ar", "ja"])
                    for (const page of script.pages.filter(name => name.startsWith("fault-")))
                        rows.push({ tag: page + " " + language + " " + panel.width, page: page, language: language, panel: panel })
            return rows
        }
        function test_a_tall_panel_shows_faults_in_large_type(row) {
            place(row)
            const scale = findChild(view, "explanation").scale
            const told = named(view, "told")
            compare(told.length, 3)
            for (const text of told) verify(scale * text.font.pixelSize >= 4 * row.panel.mm, text.text)
        }

        function test_every_text_has_a_contrast_of_seven_to_one_and_is_complete_data() {
            const rows = []
            for (const panel of [{ width: 800, height: 480, mm: 5.2 }, { width: 1280, height: 800, mm: 5.9 }])
                for (const language of ["en", "de", "ja", "ar"])
                    for (const page of script.pages)
                        rows.push({ tag: page + " " + language + " " + panel.width, page: page, language: language, panel: panel })
            return rows
        }
        function test_every_text_has_a_contrast_of_seven_to_one_and_is_complete(row) {
            place(row)
            compare(inspector.faintTexts(view, 7), [])
            // The text of a long consent form is cut off on purpose: it scrolls, and a symbol shows that.
            if (row.page !== "consent-form-long") compare(inspector.cutTexts(view), [])
            compare(inspector.brokenWords(view), [])
            for (const drawing of all(view, item => item.xOf !== undefined))
                verify(!inspector.reachesEdge(drawing))
            const headings = named(view, "heading")
            compare(headings.length, row.page.startsWith("fault-") ? 3 : 0)
            for (const heading of headings) compare(heading.lineCount, 1)
        }
    }
}
