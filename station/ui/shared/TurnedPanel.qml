import QtQuick

// Fills the window with its children, turned clockwise by `degrees` (a multiple of 90), for a panel that is not
// mounted upright. Touches need no correction, because Qt maps them from the window to each item.
Item {
    property int degrees: 0
    readonly property bool onItsSide: degrees % 180 !== 0
    anchors.centerIn: parent
    width: onItsSide ? parent.height : parent.width
    height: onItsSide ? parent.width : parent.height
    rotation: degrees
}
