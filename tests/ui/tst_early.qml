import QtQuick
import QtTest
import Turnpoint

// Tests what the operator sees and does when a session would begin too early: the refusal in the language of the
// operator, and the dialog that asks for the reason.
Item {
    id: stage
    width: 800
    height: 480

    Loader {
        id: page
        anchors.fill: parent
        active: false
        LayoutMirroring.enabled: Catalogue.mirrored(OperatorScreen.language)
        LayoutMirroring.childrenInherit: true
        property real mm: 5.2
        sourceComponent: OperatorPage {
            operating: desk.early
            pixelsPerMm: page.mm
        }
    }
    Texts { id: words; language: "en" }

    PageTest {
        name: "Early"
        when: windowShown

        readonly property OperatorController operating: desk.early
        readonly property var panels: [{ width: 800, height: 480, mm: 5.2 }, { width: 1280, height: 800, mm: 5.9 },
                                       { width: 1920, height: 1080, mm: 5.6 }, { width: 800, height: 1280, mm: 5.9 }]
        readonly property var languages: ["en", "de", "ja", "es", "zh", "ar"]

        function cleanup() {
            page.active = false
            OperatorScreen.language = "en"
            OperatorScreen.textPercent = 100
        }
        function tap(name) {
            let button = null
            tryVerify(() => (button = find(page.item, name)) !== null, 5000, name)
            mouseClick(button, button.width / 2, button.height / 2)
        }
        function hold(name) {
            const button = find(page.item, name)
            mousePress(button)
            tryVerify(() => find(page.item, "keepEntry") !== null, 3000)
            mouseRelease(find(page.item, "early"))
        }
        function refuse(panel, language) {
            stage.width = panel.width
            stage.height = panel.height
            tryCompare(stage.Window.window, "width", panel.width)
            page.mm = panel.mm
            OperatorScreen.language = language
            page.active = true
            tryVerify(() => operating.mayBegin, 20000)
            operating.enterParticipant("P01")
            operating.begin()
            tryCompare(operating, "preparing", false, 20000)
            tryVerify(() => find(page.item, "beginEarly") !== null, 5000)
            wait(20)
        }

        function test_the_refusal_is_in_the_language_of_the_operator_data() {
            return [{ tag: "en", from: "Thursday, February 29, 2024", last: "Tuesday, February 27, 2024" },
                    { tag: "de", from: "Donnerstag, 29. Februar 2024", last: "Dienstag, 27. Februar 2024" },
                    { tag: "es", from: "jueves, 29 de febrero de 2024", last: "martes, 27 de febrero de 2024" },
                    { tag: "ja", from: "2024年2月29日木曜日", last: "2024年2月27日火曜日" },
                    { tag: "zh", from: "2024年2月29日星期四", last: "2024年2月27日星期二" },
                    { tag: "ar", from: "الخميس، 29 فبراير 2024", last: "الثلاثاء، 27 فبراير 2024" }]
        }
        function test_the_refusal_is_in_the_language_of_the_operator(row) {
            words.language = row.tag
            const refusal = { participant: "P07", session: 3, from: "2024-02-29", last: 2, lastDay: "2024-02-27", minDays: 5 }
            const said = words.tooEarly(refusal).replace(/\u2060/g, "")
            for (const fact of ["P07", "3", row.from, "2", row.last, "5"]) verify(said.includes(fact), said + ": " + fact)
            verify(!said.includes("%"))
            if (row.tag !== "en") verify(!/participant|session|days|allowed/.test(said), said)
            compare(words.tooEarly({}), "")
        }

        function test_page_and_dialog_show_the_refusal_data() { return languages.map(language => ({ tag: language })) }
        function test_page_and_dialog_show_the_refusal(row) {
            refuse(panels[1], row.tag)
            words.language = row.tag
            const said = words.tooEarly({ participant: "P01", session: 2, from: desk.tomorrow(), last: 1, lastDay: desk.today(), minDays: 1 })
                .replace(/\u2060/g, "")
            verify(texts(page.item).includes(said), texts(page.item).join("\n"))
            hold("beginEarly")
            verify(texts(find(page.item, "early")).includes(said))
        }

        function test_the_refusal_and_its_dialog_fit_on_each_panel_data() {
            const rows = []
            for (const panel of panels)
                for (const language of languages)
                    rows.push({ tag: language + " " + panel.width + "x" + panel.height, language: language, panel: panel })
            return rows
        }
        function test_the_refusal_and_its_dialog_fit_on_each_panel(row) {
            refuse(row.panel, row.language)
            compare(inspector.overlaps(page.item), [])
            compare(inspector.faintTexts(find(page.item, "refusedAsEarly"), 7), [])
            // The refusal and its button are in view without scrolling.
            const button = find(page.item, "beginEarly")
            const scroll = find(page.item, "summaryScroll")
            verify(button.mapToItem(scroll, 0, button.height).y <= scroll.height)
            // The button begins where the text does.
            compare(button.mapToItem(scroll, button.width, 0).x > scroll.width - 2, row.language === "ar")
            hold("beginEarly")
            wait(20)
            const dialog = find(page.item, "early")
            compare(inspector.overlaps(dialog), [])
            compare(inspector.cutTexts(dialog), [])
            // The strokes of ' and - are thinner than a pixel, so none of their pixels has the colour of the text,
            // which is that of the letters.
            compare(inspector.faintTexts(dialog, 7).filter(text => !/^['\-ء]: /.test(text)), [])
            // A keyboard has the same order of keys in every language; the buttons below it have not.
            verify(find(dialog, "letter1").mapToItem(dialog, 0, 0).x < find(dialog, "letter0").mapToItem(dialog, 0, 0).x)
            const keep = find(dialog, "keepEntry"), cancel = find(dialog, "cancelEntry")
            compare(keep.mapToItem(dialog, 0, 0).x > cancel.mapToItem(dialog, 0, 0).x, row.language === "ar")
        }

        function test_with_large_text_the_buttons_of_the_dialog_stay_in_view_and_the_keys_scroll() {
            refuse(panels[0], "de")
            OperatorScreen.textPercent = 200
            const dialog = findChild(page.item, "early")
            dialog.open("")
            wait(20)
            const scroll = find(dialog, "entryScroll"), keep = find(dialog, "keepEntry"), last = find(dialog, "letter ")
            verify(keep.mapToItem(dialog, 0, keep.height).y <= dialog.height)
            verify(last.mapToItem(dialog, 0, last.height).y > dialog.height)
            for (let i = 0; i < 5; ++i) mouseDrag(scroll, 2, scroll.height - 5, 0, 5 - scroll.height)
            tryVerify(() => last.mapToItem(dialog, 0, last.height).y <= dialog.height, 5000)
        }

        function test_the_reason_is_typed_and_goes_with_the_session() {
            refuse(panels[0], "en")
            hold("beginEarly")
            verify(!find(page.item, "keepEntry").enabled)
            for (const letter of "ill") tap("letter" + letter)
            tap("keepEntry")
            tryVerify(() => desk.reasonGiven() === "ill", 20000)
            compare(operating.tooEarly, {})
        }
    }
}
