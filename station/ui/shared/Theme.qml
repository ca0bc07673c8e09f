import QtQuick

// Sizes and colours of all pages. Sizes grow with the panel, but a control is never smaller than a finger
// needs, nor a text smaller than an eye needs (in millimetres, from the panel's own density). Text and its
// background have a contrast of 7:1 or more.
QtObject {
    required property real width
    required property real height
    required property real pixelsPerMm
    /// True for the operator's pages. They show more per page, because the operator knows them and is close
    /// to the screen.
    property bool dense: false

    readonly property real unit: Math.min(width / 80, height / 48)
    readonly property real margin: (dense ? 1.6 : 3) * unit
    readonly property real targetMin: 20 * pixelsPerMm
    readonly property real targetGap: Math.max(5 * pixelsPerMm, 3 * unit)
    readonly property real controlHeight: dense ? Math.max(8 * pixelsPerMm, 3.6 * unit) : Math.max(11 * pixelsPerMm, 7 * unit)
    readonly property real radius: (dense ? 0.7 : 1.2) * unit
    readonly property real stroke: Math.max(2, 0.3 * unit)

    readonly property real textHuge: 6 * unit
    readonly property real textTitle: (dense ? 2 : 4) * unit
    readonly property real textBody: dense ? Math.max(1.3 * unit, 2.5 * pixelsPerMm) : Math.max(2.5 * unit, 3.4 * pixelsPerMm)
    readonly property real textSmall: dense ? Math.max(1.1 * unit, 2.2 * pixelsPerMm) : Math.max(1.8 * unit, 2.4 * pixelsPerMm)

    readonly property color paper: "#f6f4ee"
    readonly property color raised: "#fffdf8"
    readonly property color ink: "#16202a"
    readonly property color quiet: "#3f4a54"
    readonly property color line: "#c9c5b8"
    readonly property color action: "#0f3d5c"
    readonly property color actionPressed: "#061f31"
    readonly property color actionText: "#ffffff"
    readonly property color right: "#0b5230"
    readonly property color wrong: "#8a1c1c"
    readonly property color warning: "#ffc233"
    readonly property color warningText: "#16202a"
    readonly property color simulated: "#4b2378"
}
