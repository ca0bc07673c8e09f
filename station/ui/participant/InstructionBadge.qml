import QtQuick
import Turnpoint

// Shows the instruction of this block. Speed and accuracy differ in symbol, word, shape and filling, so that
// they can be told apart without colour.
Rectangle {
    id: root
    required property Theme theme
    required property Texts texts
    required property string instruction
    property real size: theme.textBody

    readonly property bool fast: instruction === "speed"
    readonly property bool known: fast || instruction === "accuracy"
    readonly property color foreground: fast ? theme.actionText : theme.ink

    visible: instruction !== ""
    implicitHeight: 1.7 * size
    implicitWidth: row.implicitWidth + 1.6 * size
    radius: fast ? 0.25 * size : height / 2
    color: fast ? theme.ink : theme.raised
    border { color: theme.ink; width: theme.stroke }

    Row {
        id: row
        anchors.centerIn: parent
        spacing: 0.45 * root.size
        Glyph {
            visible: root.known
            name: root.fast ? "chevrons" : "rings"
            color: root.foreground
            height: root.size
            anchors.verticalCenter: parent.verticalCenter
        }
        PlainText {
            text: !root.known ? root.instruction : root.fast ? root.texts.speed : root.texts.accuracy
            color: root.foreground
            font { pixelSize: root.size; weight: Font.Bold }
            anchors.verticalCenter: parent.verticalCenter
        }
    }
}
