import QtQuick
import Turnpoint

// A bar that guides the finger. The range that is asked for is an open frame, and a solid block shows the
// finger's value. The block lies below, in or above the frame, so the bar can be read without colour.
Item {
    id: root
    required property Theme theme
    required property string label
    /// The finger's value and the two ends of the range that is asked for, each from 0 to 1 along the bar. A value
    /// below 0 is not shown.
    required property list<double> bar
    property bool frozen: false
    readonly property bool known: bar.length === 3 && bar[0] >= 0 && !frozen
    implicitHeight: name.height + Math.round(0.4 * theme.unit) + track.height

    PlainText {
        id: name
        anchors { left: parent.left; right: parent.right; top: parent.top }
        text: root.label
        color: root.theme.ink
        font { pixelSize: root.theme.textSmall; weight: Font.Medium }
        elide: Text.ElideRight
        horizontalAlignment: Text.AlignHCenter
    }
    Item {
        id: track
        LayoutMirroring.enabled: false
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        height: Math.round(Math.max(4 * root.theme.pixelsPerMm, 2.6 * root.theme.unit))
        Rectangle {
            anchors { left: parent.left; right: parent.right; verticalCenter: parent.verticalCenter }
            height: root.theme.stroke
            color: root.theme.quiet
        }
        Rectangle {
            objectName: "wanted"
            x: root.bar.length === 3 ? root.bar[1] * parent.width : 0
            width: root.bar.length === 3 ? (root.bar[2] - root.bar[1]) * parent.width : 0
            height: parent.height
            radius: Math.round(0.4 * root.theme.unit)
            color: root.theme.raised
            border { color: root.theme.ink; width: root.theme.stroke }
        }
        Rectangle {
            objectName: "finger"
            visible: root.known
            readonly property real share: root.bar.length === 3 ? root.bar[0] : 0
            x: Math.max(0, Math.min(parent.width - width, share * parent.width - width / 2))
            y: 2 * root.theme.stroke
            width: Math.round(1.6 * root.theme.unit)
            height: parent.height - 4 * root.theme.stroke
            color: root.theme.action
        }
    }
}
