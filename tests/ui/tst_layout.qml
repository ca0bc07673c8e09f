import QtQuick
import QtTest
import Turnpoint

// Checks on wide and on tall screens that nothing lies over anything else: with the longest texts of each
// language, and on the operator's pages.
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
    Loader {
        id: page
        anchors.fill: parent
        active: false
        property real mm: 5.2
        sourceComponent: OperatorPage {
            operating: desk.operating
            pixelsPerMm: page.mm
        }
    }
    LiveView {
        id: liveView
        anchors.fill: parent
        visible: false
        live: desk.live
        bridge: script.bridge
        pixelsPerMm: page.mm
    }
    Rectangle {
        id: control
        anchors.fill: parent
        visible: false
        Text { text: "one"; font.pixelSize: 20 }
        Text { id: second; text: "two"; font.pixelSize: 20 }
    }
    Texts { id: words; language: "en" }
    Theme { id: large; width: stage.width; height: stage.height; pixelsPerMm: page.mm }
    Loader {
        id: start
        anchors.fill: parent
    }
    Component {
        id: language
        LanguagePage { theme: large; texts: words; names: ["English", "Deutsch", "日本語"] }
    }
    Component {
        id: consent
        ConsentPage { theme: large; texts: words; version: "2026-03" }
    }
    Component {
        id: code
        CodePage { theme: large; texts: words; asksHand: true }
    }

    TestCase {
        name: "Layout"
        when: windowShown

        readonly property var panels: [{ width: 800, height: 480, mm: 5.2 }, { width: 800, height: 480, mm: 7.36 },
                                       { width: 1280, height: 800, mm: 5.9 }, { width: 480, height: 800, mm: 5.2 },
                                       { width: 600, height: 1024, mm: 6.7 }, { width: 800, height: 1280, mm: 5.9 }]
        // ... and 5 inches upright, 7 inches with small pixels, and a desktop
        readonly property var participantsPanels: panels.concat([{ width: 480, height: 800, mm: 7.36 }, { width: 1024, height: 600, mm: 6.67 }, { width: 1920, height: 1080, mm: 5.6 }])

        // On these pages the text scrolls, and a symbol shows that.
        readonly property var scrolling: ["consent-form-long"]

        SignalSpy { id: shown; target: script.bridge; signalName: "shown" }

        // A size that depends on itself depends on the order in which it was computed.
        function init() { failOnWarning(/Binding loop/) }
        function cleanup() {
            page.active = false
            liveView.visible = false
            OperatorScreen.language = "en"
            start.sourceComponent = undefined
            view.visible = true
        }
        function resize(panel) {
            stage.width = panel.width
            stage.height = panel.height
            tryCompare(stage.Window.window, "width", panel.width)
            tryCompare(stage.Window.window, "height", panel.height)
            view.pixelsPerMm = panel.mm
            page.mm = panel.mm
        }
        function show(name, language) {
            const before = shown.count
            script.show(name, language)
            tryCompare(shown, "count", before + 1)
            wait(1)
        }
        function rows(names, of = panels) {
            const rows = []
            for (const panel of of)
                for (const name of names)
                    rows.push({ tag: name + " " + panel.width + "x" + panel.height + " " + panel.mm, name: name, panel: panel })
            return rows
        }

        function test_what_overlaps_is_detected() {
            control.visible = true
            compare(inspector.overlaps(control).length, 1)
            second.y = 100
            compare(inspector.overlaps(control), [])
            control.visible = false
        }

        function inches(panel) { return Math.hypot(panel.width, panel.height) / panel.mm / 25.4 }
        function capitalsMm(panel) { return inches(panel) < 6 ? 2 : inches(panel) < 8 ? 2.5 : 3 }

        /// What is missing on a page with a text that speaks of the mark: the drawing of the surface with its mark.
        function missing() {
            const speaks = /\bmark\b|Markierung|\bmarca\b|العلامة|印/
            const any = (item, is) => item.visible && (is(item) || Array.from(item.children).some(child => any(child, is)))
            if (!any(view, item => typeof item.text === "string" && speaks.test(item.text))) return []
            const least = 0.08 * Math.max(stage.width, stage.height)
            return any(view, item => item.xOf !== undefined && item.hasMark && item.height >= least) ? [] : ["no surface with a mark"]
        }
        function test_a_missing_mark_is_detected() {
            resize(panels[0])
            show("response", "de")
            compare(missing(), [])
            const surface = findChild(view, "surface")
            surface.hasMark = false
            compare(missing(), ["no surface with a mark"])
            surface.hasMark = Qt.binding(() => script.bridge.page.hasMark)
            show("response-3", "de")
            compare(missing(), [])
        }

        // Every participant's page, in live, pilot and simulated sessions: nothing lies over anything else, nothing is cut off,
        // no word is broken, no letters are too small, and the mark is there when a text speaks of it.
        function test_every_page_of_a_session_can_be_read_data() {
            const rows = []
            for (const panel of participantsPanels)
                for (const language of ["de", "es", "ar", "ja"])
                    for (const mode of language === "de" || language === "ar" ? ["", "-pilot", "-simulated"] : panel.width === 800 && panel.mm < 6 ? ["-simulated"] : [])
                        rows.push({ tag: language + mode + " " + panel.width + "x" + panel.height + " " + panel.mm, language: language, mode: mode, panel: panel })
            return rows
        }
        function test_every_page_of_a_session_can_be_read(row) {
            resize(row.panel)
            const faults = []
            for (const name of script.pages) {
                show(name + row.mode, row.language)
                for (const pair of inspector.overlaps(view)) faults.push(name + ": " + pair)
                for (const what of missing()) faults.push(name + ": " + what)
                // nine answers of several long words have no room for such letters on 5 inches below the band of a pilot run
                const smaller = name === "choices-9-long" && row.mode !== "" && inches(row.panel) < 6 && row.panel.width > row.panel.height
                if (name === "choices-9-long" && shownItem(view, "answer0").height < 11 * row.panel.mm) faults.push(name + ": buttons of " + shownItem(view, "answer0").height / row.panel.mm + " mm")
                for (const text of inspector.smallTexts(view, (smaller ? 0.65 : 1) * capitalsMm(row.panel) * row.panel.mm)) faults.push(name + ": " + text)
                for (const edge of inspector.blurredEdges(view).slice(0, 1)) faults.push(name + ": blurred: " + edge)
                for (const word of inspector.brokenWords(view)) faults.push(name + ": broken: " + word)
                if (!scrolling.includes(name)) for (const text of inspector.cutTexts(view)) faults.push(name + ": cut: " + text)
            }
            compare(faults.join("\n"), "")
        }

        function test_small_letters_are_detected() {
            control.visible = true
            compare(inspector.smallTexts(control, 20 * 0.727), [])
            compare(inspector.smallTexts(control, 21 * 0.727).length, 2)
            control.scale = 0.9
            compare(inspector.smallTexts(control, 20 * 0.727).length, 2)
            control.scale = 1
            control.visible = false
        }

        function shownItem(item, name) {
            if (!item.visible || item.objectName === name) return item.visible ? item : null
            for (const child of Array.from(item.children)) {
                const found = shownItem(child, name)
                if (found) return found
            }
            return null
        }
        function test_a_text_without_a_drawing_has_the_room_of_the_drawing_data() { return rows(["block-over", "block-over-pilot"], participantsPanels) }
        function test_a_text_without_a_drawing_has_the_room_of_the_drawing(row) {
            resize(row.panel)
            const unit = Math.floor(Math.min(row.panel.width / 80, row.panel.height / 48))   // the gap above the button
            for (const language of ["de", "ar"]) {
                show(row.name, language)
                const text = shownItem(view, "pagedText"), button = shownItem(view, "proceed")
                const below = button.mapToItem(view, 0, 0).y - text.mapToItem(view, 0, text.height).y
                verify(below >= 0 && below <= unit, language + ": " + below)
            }
        }

        // A picture of an explanation is large enough to be seen, and a long form has room beside its answers.
        function test_pictures_and_long_forms_have_room_data() { return rows(["-pilot"], panels.slice(0, 2)) }
        function test_pictures_and_long_forms_have_room(row) {
            resize(row.panel)
            show("explanation-picture" + row.name, "de")
            const picture = shownItem(view, "picture")
            verify(picture.paintedWidth >= 18 * row.panel.mm, "picture of " + picture.paintedWidth / row.panel.mm + " mm")
            show("consent-form-long" + row.name, "de")
            const form = shownItem(view, "questionText"), answer = shownItem(view, "answer0")
            verify(form.height >= 0.35 * row.panel.height, "text of " + form.height)
            verify(answer.height >= 11.9 * row.panel.mm, "answers of " + answer.height / row.panel.mm + " mm")
            verify(form.contentHeight > form.height)
            fuzzyCompare(form.height / form.line, Math.round(form.height / form.line), 0.05)      // no line is cut in half
        }

        // A tall screen has room for keys that a finger hits.
        function test_the_keys_for_a_code_on_a_tall_screen_are_large_targets_data() {
            return participantsPanels.filter(panel => panel.height > panel.width).map(panel => ({ tag: panel.width + "x" + panel.height + " " + panel.mm, panel: panel }))
        }
        function test_the_keys_for_a_code_on_a_tall_screen_are_large_targets(row) {
            resize(row.panel)
            view.visible = false
            start.sourceComponent = code
            const page = start.item
            for (const keyLayer of ["digits", "letters", "ABC"]) {
                page.keyLayer = keyLayer
                wait(20)
                let keys = 0
                const look = item => {
                    if (!item.visible) return
                    if (/^(key|group|letters$|digits$|accept$)/.test(item.objectName)) {
                        ++keys
                        verify(Math.min(item.width, item.height) >= 20 * row.panel.mm, item.objectName + ": " + item.width + " x " + item.height)
                    }
                    for (let i = 0; i < item.children.length; ++i) look(item.children[i])
                }
                look(page)
                verify(keys >= 5, keys)
                compare(inspector.overlaps(page), [])
                compare(inspector.cutTexts(page), [])
            }
            page.keyLayer = "digits"
            page.clear()
        }

        function test_the_surface_and_its_mark_are_there_before_a_trial_data() {
            return rows(["cue", "cue-pilot", "cue-simulated"], participantsPanels)
        }
        function test_the_surface_and_its_mark_are_there_before_a_trial(row) {
            resize(row.panel)
            for (const language of ["en", "de", "es", "ar"]) {
                show(row.name, language)
                const surface = findChild(view, "surface")
                verify(surface.visible && surface.hasMark, language)
                verify(surface.height >= 0.08 * Math.max(row.panel.width, row.panel.height), language + ": " + surface.height)
            }
        }

        function test_no_texts_or_buttons_before_a_session_overlap_data() {
            const rows = []
            for (const panel of participantsPanels)
                for (const language of ["en", "de", "ja", "es", "zh", "ar"])
                    rows.push({ tag: language + " " + panel.width + "x" + panel.height + " " + panel.mm, language: language, panel: panel })
            return rows
        }
        function test_no_texts_or_buttons_before_a_session_overlap(row) {
            resize(row.panel)
            words.language = row.language
            view.visible = false
            for (const question of [language, consent, code]) {
                start.sourceComponent = question
                wait(20)
                compare(inspector.overlaps(start.item), [])
                compare(inspector.cutTexts(start.item), [])
                compare(inspector.smallTexts(start.item, capitalsMm(row.panel) * row.panel.mm), [])
                if (question !== consent) continue
                start.item.refused = true
                wait(20)
                compare(inspector.overlaps(start.item), [])
                compare(inspector.cutTexts(start.item), [])
            }
        }

        function test_no_texts_or_buttons_of_the_start_page_overlap_data() { return rows(["demo", "boundary-constant", "mistaken.toml"]) }
        function test_no_texts_or_buttons_of_the_start_page_overlap(row) {
            resize(row.panel)
            view.visible = false
            page.active = true
            desk.operating.select(desk.operating.protocols.findIndex(protocol => protocol.id === row.name))
            tryCompare(desk.operating, "checking", false, 20000)
            for (const armed of [false, true]) {
                desk.operating.setArmed(armed)
                if (armed) { desk.operating.setLive(true); tryCompare(desk.operating, "preparing", false, 20000) }
                wait(20)
                compare(inspector.overlaps(page.item), [])
                compare(inspector.blurredEdges(page.item).join("\n"), "")
            }
            desk.operating.setArmed(false)
            desk.operating.setLive(false)
        }

        function test_no_texts_or_buttons_of_the_live_view_overlap_data() { return rows(["between-trials", "paused", "end-early"]) }
        function test_no_texts_or_buttons_of_the_live_view_overlap(row) {
            resize(row.panel)
            view.visible = false
            liveView.visible = true
            liveView.closable = true
            show(row.name, "en")
            desk.tellLive("Block main, trial 35, level -10: zone")
            wait(50)
            compare(inspector.overlaps(liveView), [])
        }

        function test_the_figures_of_the_live_view_are_beside_its_facts_in_every_language_data() {
            const rows = []
            for (const panel of panels)
                for (const language of ["en", "de", "ar"])
                    rows.push({ tag: language + " " + panel.width + "x" + panel.height + " " + panel.mm, language: language, panel: panel })
            return rows
        }
        function test_the_figures_of_the_live_view_are_beside_its_facts_in_every_language(row) {
            resize(row.panel)
            view.visible = false
            liveView.visible = true
            OperatorScreen.language = row.language
            show("between-trials", "en")
            desk.tellLive("Block main, trial 35, level -10: zone", row.language)
            wait(50)
            const facts = findChild(liveView, "facts"), figures = findChild(liveView, "figures")
            const left = facts.mapToItem(liveView, 0, 0).x, place = figures.mapToItem(liveView, 0, 0)
            verify(place.x >= 0 && place.x + figures.width <= liveView.width, place.x + " + " + figures.width)
            verify(figures.width > 0.4 * liveView.width && figures.height > 0.2 * liveView.height)
            if (row.panel.width > row.panel.height)
                verify(row.language === "ar" ? left + facts.width <= place.x : place.x + figures.width <= left)
            compare(inspector.overlaps(liveView), [])
            compare(inspector.brokenWords(liveView), [])
        }
    }
}
