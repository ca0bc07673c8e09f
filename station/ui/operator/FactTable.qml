import QtQuick
import Turnpoint

// A table of labels and values under a heading, for the operator's pages. Both are phrases (see Texts.say). In a
// language that is read from right to left, English values are at the right as well, so that both columns have a
// straight edge.
Column {
    id: root
    required property Theme theme
    required property Texts texts
    required property var facts
    property string heading
    property real labelWidth: 0.4 * width
    spacing: 0.35 * theme.unit

    PlainText {
        visible: root.heading !== "" && root.facts.length > 0
        width: root.width
        text: root.heading
        color: root.theme.action
        font { pixelSize: root.theme.textBody; weight: Font.Bold }
    }
    Repeater {
        model: root.facts
        Item {
            id: line
            required property var modelData
            width: root.width
            height: Math.max(label.implicitHeight, value.implicitHeight)
            PlainText {
                id: label
                anchors.left: parent.left
                width: root.labelWidth - root.theme.unit
                text: root.texts.say(line.modelData.label)
                color: root.theme.quiet
                font.pixelSize: root.theme.textSmall
                horizontalAlignment: Text.AlignLeft
                wrapMode: Text.Wrap
            }
            PlainText {
                id: value
                anchors { left: label.right; leftMargin: root.theme.unit; right: parent.right }
                text: root.texts.say(line.modelData.value)
                color: root.theme.ink
                font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
                horizontalAlignment: Text.AlignLeft
                wrapMode: Text.Wrap
            }
        }
    }
}
