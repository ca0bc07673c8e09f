import QtQuick

// Fills the window with its children, turned clockwise by `degrees` (a multiple of 90), for a panel that is not
// mounted upright. Touches need no correction, because Qt maps them from the window to each item.
Item {
    property int degrees: 0
    /// The size of the window. It is known before the content of the window has it, so that pages in a window are laid
    /// out only once.
    property real across: parent.width
    property real down: parent.height
    readonly property bool onItsSide: degrees % 180 !== 0
    anchors.centerIn: parent
    width: onItsSide ? down : across
    height: onItsSide ? across : down
    rotation: degrees
}
