import QtQuick
import Turnpoint

// Two or three answers of one size, one colour and one distance from the middle: nothing favours a side. It draws
// only; a TouchField over the page judges the touches.
Item {
    id: root
    required property Theme theme
    required property var answers
    required property int pressed
    readonly property real gap: theme.targetGap
    readonly property int count: answers.length

    Repeater {
        model: root.answers
        Rectangle {
            id: button
            required property int index
            required property string modelData
            readonly property bool down: root.pressed === index
            objectName: "answer" + index
            width: (root.width - (root.count - 1) * root.gap) / root.count
            height: root.height
            x: index * (width + root.gap)
            radius: root.theme.radius
            color: down ? root.theme.raised : root.theme.action
            border { color: root.theme.action; width: 3 * root.theme.stroke }
            Text {
                anchors { fill: parent; margins: 2 * root.theme.unit }
                text: button.modelData
                color: button.down ? root.theme.action : root.theme.actionText
                font { pixelSize: root.theme.textTitle; weight: Font.DemiBold }
                fontSizeMode: Text.Fit
                minimumPixelSize: root.theme.textSmall
                wrapMode: Text.Wrap
                horizontalAlignment: Text.AlignHCenter
                verticalAlignment: Text.AlignVCenter
            }
        }
    }
}
