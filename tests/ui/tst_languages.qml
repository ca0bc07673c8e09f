import QtQuick
import QtTest
import Turnpoint

// Tests pages in languages that are written from right to left, and in those that need a font of their own.
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
    Theme { id: theme; width: 800; height: 480; pixelsPerMm: 5.2 }
    Texts { id: words; language: "en" }
    Item {
        id: questions
        anchors.fill: parent
        LayoutMirroring.enabled: words.mirrored
        LayoutMirroring.childrenInherit: true
        ConsentPage {
            id: consent
            anchors.fill: parent
            theme: theme
            texts: words
            version: "1"
        }
    }

    GalleryTest {
        name: "Languages"
        view: view
        when: windowShown

        function leftOf(parent, name) {
            const item = findChild(parent, name)
            return item.mapToItem(stage, 0, 0).x
        }

        function test_questions_are_mirrored_data() {
            return [{ tag: "en", right: false }, { tag: "zh", right: false }, { tag: "ar", right: true },
                    { tag: "he-IL", right: true }, { tag: "fa", right: true }]
        }
        function test_questions_are_mirrored(row) {
            words.language = row.tag
            compare(leftOf(questions, "back") > 400, row.right)
            compare(leftOf(questions, "declined") > leftOf(questions, "agreed"), row.right)
        }
        function test_answers_keep_their_order_data() { return [{ tag: "en" }, { tag: "ar" }] }
        function test_answers_keep_their_order(row) {
            show("response", row.tag)
            verify(leftOf(view, "answer0") < leftOf(view, "answer1"))
            show("rating-7", row.tag)
            for (let i = 1; i < 7; ++i) verify(leftOf(view, "answer" + (i - 1)) < leftOf(view, "answer" + i))
        }
        function test_the_progress_begins_where_reading_begins() {
            show("response", "en")
            verify(findChild(view, "progressDone").x === 0)
            show("response", "ar")
            const bar = findChild(view, "progressDone")
            compare(bar.x + bar.width, bar.parent.width)
        }
        function test_values_are_isolated_in_texts_that_are_read_from_right_to_left() {
            words.language = "ar"
            for (const said of [words.fill("operator.found", 3, 7), words.say({ key: "operator.found", values: ["3", "7"] })])
                verify(said.includes("\u20683\u2069") && said.includes("\u20687\u2069"), said)
            words.language = "en"
            compare(words.fill("operator.found", 1, 7), "Sessions found: 1 of 7")
        }
        function test_fonts_of_languages_data() {
            return [{ tag: "en", family: "Inter" }, { tag: "ja", family: "Inter" }, { tag: "ar", family: "Inter" },
                    { tag: "ko", family: "Noto Sans CJK KR" }, { tag: "zh", family: "Noto Sans CJK SC" },
                    { tag: "zh-Hant", family: "Noto Sans CJK TC" }, { tag: "zh-TW", family: "Noto Sans CJK TC" },
                    { tag: "zh-HK", family: "Noto Sans CJK HK" }]
        }
        function test_fonts_of_languages(row) {
            Catalogue.shown = row.tag
            compare(Catalogue.family, row.family)
        }
    }
}
