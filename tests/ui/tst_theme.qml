import QtQuick
import QtTest
import Turnpoint

TestCase {
    name: "Theme"

    Component {
        id: made
        Theme {}
    }

    // Computes relative luminance and contrast as WCAG 2.1 defines them.
    function linear(c) { return c <= 0.04045 ? c / 12.92 : Math.pow((c + 0.055) / 1.055, 2.4) }
    function luminance(c) { return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b) }
    function contrast(a, b) {
        const la = luminance(a), lb = luminance(b)
        return (Math.max(la, lb) + 0.05) / (Math.min(la, lb) + 0.05)
    }

    function test_contrast_is_computed_as_defined() {
        fuzzyCompare(contrast(Qt.color("#000000"), Qt.color("#ffffff")), 21, 1e-9)
        fuzzyCompare(contrast(Qt.color("#777777"), Qt.color("#ffffff")), 4.48, 0.01)
    }

    function test_texts_have_a_contrast_of_seven_to_one_data() {
        const pairs = [["ink", "paper"], ["ink", "raised"], ["quiet", "paper"], ["quiet", "raised"],
                ["actionText", "action"], ["action", "raised"], ["action", "paper"], ["right", "paper"],
                ["right", "raised"], ["wrong", "paper"], ["wrong", "raised"], ["actionText", "right"],
                ["actionText", "wrong"], ["actionText", "ink"], ["warningText", "warning"],
                ["actionText", "simulated"]]
        const rows = []
        for (const [text, under] of pairs)
            for (const dark of [false, true])
                rows.push({ tag: text + " on " + under + (dark ? ", dark" : ""), text: text, under: under, dark: dark })
        return rows
    }
    function cleanup() { OperatorScreen.dark = false }
    function themed(dark) {
        OperatorScreen.dark = dark
        const theme = made.createObject(null, { width: 800, height: 480, pixelsPerMm: 5.2, dense: dark })
        compare(theme.dark, dark)
        return theme
    }
    function test_borders_have_a_contrast_of_three_to_one_data() {
        const rows = []
        for (const under of ["paper", "raised"])
            for (const dark of [false, true]) rows.push({ tag: under + (dark ? ", dark" : ""), under: under, dark: dark })
        return rows
    }
    function test_borders_have_a_contrast_of_three_to_one(row) {
        const theme = themed(row.dark)
        const found = contrast(theme.line, theme[row.under])
        verify(found >= 3, row.tag + ": " + found.toFixed(2))
    }
    function test_the_theme_of_the_operator_does_not_change_the_participants_pages() {
        OperatorScreen.dark = true
        OperatorScreen.textPercent = 200
        const theme = made.createObject(null, { width: 800, height: 480, pixelsPerMm: 5.2 })
        const dense = made.createObject(null, { width: 800, height: 480, pixelsPerMm: 5.2, dense: true })
        verify(luminance(theme.paper) > 0.8 && luminance(dense.paper) < 0.05)
        const large = dense.textBody, large_participant = theme.textBody
        OperatorScreen.textPercent = 100
        fuzzyCompare(large, 2 * dense.textBody, 1e-9)
        compare(large_participant, theme.textBody)
    }
    function test_texts_have_a_contrast_of_seven_to_one(row) {
        const theme = themed(row.dark)
        const found = contrast(theme[row.text], theme[row.under])
        verify(found >= 7, row.tag + ": " + found.toFixed(2))
    }

    function test_a_larger_screen_shows_the_operator_more_and_not_larger_letters() {
        const shown = (w, h, mm) => made.createObject(null, { width: w, height: h, pixelsPerMm: mm, dense: true })
        const ten = shown(1280, 800, 5.9)
        for (const large of [shown(1920, 1080, 5.6), shown(1920, 1080, 3.6)]) {
            verify(large.height / large.controlHeight > 1.2 * ten.height / ten.controlHeight)
            verify(large.textBody / large.pixelsPerMm <= 1.3 * ten.textBody / ten.pixelsPerMm)
            verify(large.textSmall >= 2.2 * large.pixelsPerMm)
        }
    }
    function test_targets_have_their_size_in_millimetres_data() {
        return [{ tag: "7 inch", w: 800, h: 480, mm: 5.2 }, { tag: "10 inch", w: 1280, h: 800, mm: 5.9 },
                { tag: "15 inch", w: 1920, h: 1080, mm: 5.6 }, { tag: "dense 5 inch", w: 1280, h: 720, mm: 11.6 }]
    }
    function test_targets_have_their_size_in_millimetres(row) {
        const theme = made.createObject(null, { width: row.w, height: row.h, pixelsPerMm: row.mm })
        verify(theme.targetMin >= 20 * row.mm)
        verify(theme.targetGap >= 5 * row.mm)
        verify(theme.textSmall >= 2.4 * row.mm)
    }
}
