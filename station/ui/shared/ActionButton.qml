import QtQuick
import Turnpoint

// A button for everything except answers. It acts only if a press both begins and ends on it while the button
// is armed, so that a tap meant for the previous page never triggers it.
Rectangle {
    id: root
    required property Theme theme
    property string text
    property string glyph
    property real size: theme.textBody
    property bool armed: true
    property bool primary: true
    property bool quiet: false
    /// If above 0, the button must be held for this number of milliseconds. It fills up in that time.
    property int holdMs: 0
    signal activated()

    readonly property bool filled: holdMs > 0 ? primary && !area.pressed : primary !== area.pressed
    readonly property color foreground: filled ? theme.actionText : quiet ? theme.quiet : theme.action

    implicitHeight: theme.controlHeight
    implicitWidth: theme.dense ? row.implicitWidth + 3 * theme.unit : Math.max(row.implicitWidth + 5 * theme.unit, theme.targetMin)
    radius: theme.radius
    color: filled ? theme.action : quiet ? theme.paper : theme.raised
    border { color: quiet ? theme.line : theme.action; width: quiet ? theme.stroke / 2 : theme.stroke }
    opacity: enabled ? 1 : 0.35

    Rectangle {
        visible: root.holdMs > 0 && area.pressed
        anchors { left: parent.left; top: parent.top; bottom: parent.bottom }
        width: parent.width * root.held
        radius: root.radius
        color: root.theme.warning
    }
    property real held: 0
    NumberAnimation {
        target: root
        property: "held"
        running: root.holdMs > 0 && area.pressed
        from: 0
        to: 1
        duration: Math.max(1, root.holdMs)
        onFinished: {
            area.done = true
            root.activated()
        }
    }

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
        PlainText {
            visible: root.text !== ""
            text: root.text
            color: root.foreground
            font { pixelSize: root.size; weight: Font.DemiBold }
            anchors.verticalCenter: parent.verticalCenter
        }
    }
    MouseArea {
        id: area
        /// True if this press has already triggered the action, which may have changed the button into one
        /// that need not be held.
        property bool done: false
        anchors.fill: parent
        enabled: root.enabled && root.armed
        onPressed: done = false
        onClicked: if (root.holdMs === 0 && !done) root.activated()
    }
}
