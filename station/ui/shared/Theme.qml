import QtQuick
import Turnpoint

// Sizes and colours of all pages. Sizes grow with the panel, but a control is never smaller than a finger
// needs, and a text never smaller than an eye needs. (These limits are in millimetres; the panel's own
// density converts them to pixels.) All sizes are whole pixels, so that lines are equally thick everywhere. Text and its background have a contrast of 7:1 or more, borders and their
// background 3:1 or more.
QtObject {
    required property real width
    required property real height
    required property real pixelsPerMm
    /// True for the operator's pages. They show more per page, because the operator knows them and is close
    /// to the screen.
    property bool dense: false
    /// The operator chooses a light or a dark theme and the size of the text (see OperatorScreen). The participant's
    /// pages always look the same, because they are part of the study.
    readonly property bool dark: dense && OperatorScreen.dark
    readonly property real textScale: dense ? OperatorScreen.textPercent / 100 : 1

    /// On the operator's pages a unit is at most 2.5 mm: a larger screen shows more, not larger letters.
    readonly property real unit: Math.max(1, Math.floor(Math.min(width / 80, height / 48, dense ? 2.5 * pixelsPerMm : Infinity)))
    readonly property real margin: Math.round((dense ? 1.6 : 3) * unit)
    readonly property real targetMin: Math.ceil(20 * pixelsPerMm)
    /// The smallest target on a panel that has no room for larger ones; long answers may be three quarters as high.
    readonly property real targetLeast: Math.ceil(12 * pixelsPerMm)
    readonly property real targetGap: Math.round(Math.max(5 * pixelsPerMm, 3 * unit))
    readonly property real controlHeight: Math.round(dense ? Math.max(8 * pixelsPerMm, 3.6 * unit) * Math.max(1, 0.75 * textScale) : Math.max(11 * pixelsPerMm, 7 * unit))
    readonly property real radius: Math.round((dense ? 0.7 : 1.2) * unit)
    readonly property real stroke: Math.max(2, Math.round(0.3 * unit))

    /// The least height of capitals on a participant's page. A small panel is held closer to the eye.
    readonly property real inches: Math.hypot(width, height) / pixelsPerMm / 25.4
    readonly property real capitalsMm: inches < 6 ? 2 : inches < 8 ? 2.5 : 3
    /// The smallest text that can be read. Capitals of Inter are 0.727 of the size of the font. A text that does not fit at
    /// this size is shown on several pages (PagedText).
    readonly property real textLeast: Math.ceil((dense ? 1.75 : capitalsMm) * pixelsPerMm / 0.727)
    readonly property real textHuge: 6 * unit
    readonly property real textTitle: Math.round(dense ? 2 * Math.min(1.4, textScale) * unit : Math.max(4 * unit, 1.4 * textLeast))
    readonly property real textBody: Math.round(dense ? textScale * Math.max(1.3 * unit, 2.5 * pixelsPerMm) : Math.max(2.5 * unit, 3.4 * pixelsPerMm, 1.15 * textLeast))
    readonly property real textSmall: Math.round(dense ? textScale * Math.max(1.1 * unit, 2.2 * pixelsPerMm) : Math.max(1.8 * unit, textLeast))

    readonly property color paper: dark ? "#11161b" : "#f6f4ee"
    readonly property color raised: dark ? "#1a2128" : "#fffdf8"
    readonly property color ink: dark ? "#f0f3f5" : "#16202a"
    readonly property color quiet: dark ? "#bcc6ce" : "#3f4a54"
    readonly property color line: dark ? "#7d8790" : "#8a8678"
    readonly property color action: dark ? "#8ecbf0" : "#0f3d5c"
    readonly property color actionText: dark ? "#0b1a26" : "#ffffff"
    readonly property color right: dark ? "#8fe0b0" : "#0b5230"
    readonly property color wrong: dark ? "#ffb0a8" : "#8a1c1c"
    readonly property color warning: "#ffc233"
    readonly property color warningText: "#16202a"
    readonly property color simulated: dark ? "#d9b8ff" : "#4b2378"
}
