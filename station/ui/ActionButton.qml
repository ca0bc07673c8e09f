import QtQuick
import Turnpoint

// A button for everything but answers. It acts on a press that both began and ended on it, and only while armed,
// so a tap meant for the page before never lands on this one.
Rectangle {
    id: root
    required property Theme theme
    property string text
    property string glyph
    property real size: theme.textBody
    property bool armed: true
    property bool primary: true
    property bool quiet: false
    signal activated()

    readonly property bool filled: primary !== area.pressed
    readonly property color foreground: filled ? theme.actionText : quiet ? theme.quiet : theme.action

    implicitHeight: theme.controlHeight
    implicitWidth: Math.max(row.implicitWidth + 5 * theme.unit, theme.targetMin)
    radius: theme.radius
    color: filled ? theme.action : quiet ? theme.paper : theme.raised
    border { color: quiet ? theme.line : theme.action; width: quiet ? theme.stroke / 2 : theme.stroke }
    opacity: enabled ? 1 : 0.35

    Row {
        id: row
        anchors.centerIn: parent
        spacing: root.theme.unit
        Glyph {
            visible: root.glyph !== ""
            name: root.glyph
            color: root.foreground
            height: root.size * 1.1
            anchors.verticalCenter: parent.verticalCenter
        }
        Text {
            visible: root.text !== ""
            text: root.text
            color: root.foreground
            font { pixelSize: root.size; weight: Font.DemiBold }
            anchors.verticalCenter: parent.verticalCenter
        }
    }
    MouseArea {
        id: area
        anchors.fill: parent
        enabled: root.enabled && root.armed
        onClicked: root.activated()
    }
}
