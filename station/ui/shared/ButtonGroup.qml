import QtQuick
import Turnpoint

// Buttons side by side or, if the place is too narrow for that, below each other.
Grid {
    id: root
    required property Theme theme
    /// The width that the buttons may take.
    required property real room
    readonly property var shown: Array.from(children).filter(child => child.visible)
    readonly property real needed: shown.reduce((sum, child) => sum + child.width, (shown.length - 1) * theme.targetGap)
    columns: needed <= room ? Math.max(1, shown.length) : 1
    columnSpacing: theme.targetGap
    rowSpacing: Math.round(2.5 * theme.pixelsPerMm)
    horizontalItemAlignment: Grid.AlignHCenter
}
