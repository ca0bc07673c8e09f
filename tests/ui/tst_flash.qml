import QtQuick
import QtTest
import Turnpoint

// A flash as response signal: whether it can be noticed on every panel, and whether it ends.
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
        name: "Flash"
        view: view
        when: windowShown

        function item(name) {
            const found = findChild(view, name)
            verify(found, name)
            return found
        }

        /// Luminance of the page at points of a grid, from 0 to 1 (WCAG 2).
        function luminances() {
            const image = grabImage(view), all = []
            const linear = value => value <= 0.04045 ? value / 12.92 : Math.pow((value + 0.055) / 1.055, 2.4)
            for (let row = 0; row < 30; ++row)
                for (let column = 0; column < 30; ++column) {
                    const color = image.pixel(Math.floor((column + 0.5) / 30 * view.width), Math.floor((row + 0.5) / 30 * view.height))
                    all.push(0.2126 * linear(color.r) + 0.7152 * linear(color.g) + 0.0722 * linear(color.b))
                }
            return all
        }

        /// Proportion of the page that changes from light to dark with a contrast of 7:1 or more. The answers are dark before.
        function darkened(before, after) {
            let count = 0
            for (let k = 0; k < before.length; ++k) count += (before[k] + 0.05) / (after[k] + 0.05) >= 7 ? 1 : 0
            return count / before.length
        }

        function test_a_flash_darkens_two_fifths_of_each_panel_says_what_to_do_and_ends_data() {
            const rows = []
            for (const panel of [{ width: 800, height: 480, mm: 5.2 }, { width: 1280, height: 800, mm: 5.9 }, { width: 480, height: 800, mm: 5.2 }, { width: 800, height: 1280, mm: 5.9 }])
                for (const language of ["en", "de", "ja", "ar"])
                    rows.push({ tag: language + " " + panel.width, language: language, panel: panel })
            return rows
        }
        function test_a_flash_darkens_two_fifths_of_each_panel_says_what_to_do_and_ends(row) {
            resize(row.panel)
            const timer = item("flash"), signal = item("signal"), answers = item("answer0").parent
            timer.interval = 10000 // long enough for a picture
            show("explore", row.language)
            const before = luminances()
            show("explore-flash", row.language)
            verify(signal.visible && signal.height === signal.parent.height && !answers.visible)
            const dark = darkened(before, luminances())
            verify(dark > 0.4, dark + " of the page becomes dark")
            compare(inspector.faintTexts(view, 7), [])
            compare(inspector.cutTexts(view), [])
            compare(inspector.texts(signal), 1)
            timer.triggered()
            verify(signal.visible && signal.height < signal.parent.height && answers.visible)
            verify(darkened(before, luminances()) < 0.1)
            compare(inspector.faintTexts(view, 7), [])
            compare(inspector.texts(signal), 1)
        }

        function test_a_flash_lasts_from_its_first_frame_for_a_tenth_of_a_second() {
            const timer = item("flash"), signal = item("signal")
            timer.interval = 100
            for (let trial = 0; trial < 2; ++trial) {
                show("between-trials")
                verify(!timer.running)
                show("explore-flash")
                compare(signal.height, signal.parent.height)
                tryVerify(() => signal.height < signal.parent.height, 5000)
                verify(!timer.running)
            }
        }
    }
}
