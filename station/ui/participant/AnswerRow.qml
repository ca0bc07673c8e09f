import QtQuick
import Turnpoint

// Two or three answers of equal size, letter size and colour, at equal distances from the middle, so that
// nothing favours a side. This item only draws; a TouchField over the page judges the touches.
Item {
    id: root
    required property Theme theme
    required property var answers
    required property int pressed
    readonly property real gap: theme.targetGap
    readonly property int count: answers.length
    readonly property real buttonWidth: (width - (count - 1) * gap) / Math.max(1, count)
    /// The largest text size at which each answer fits its button without breaking a word.
    readonly property real letters: {
        let least = theme.textTitle
        for (let i = 0; i < count; ++i) least = Math.min(least, fits.itemAt(i)?.fontInfo.pixelSize ?? least)
        return least
    }

    Repeater {
        id: fits
        model: 6
        PlainText {
            required property int index
            visible: false
            width: root.buttonWidth - 4 * root.theme.unit
            height: root.height - 4 * root.theme.unit
            text: root.answers[index] ?? ""
            font { pixelSize: root.theme.textTitle; weight: Font.DemiBold }
            fontSizeMode: Text.Fit
            minimumPixelSize: root.theme.textSmall
            wrapMode: Text.WordWrap
        }
    }

    Repeater {
        // Create as many buttons as any trial can need once, so that no trial has to create one.
        model: 6
        Rectangle {
            id: button
            required property int index
            readonly property bool down: root.pressed === index
            objectName: "answer" + index
            visible: index < root.count
            width: root.buttonWidth
            height: root.height
            x: index * (width + root.gap)
            radius: root.theme.radius
            color: down ? root.theme.raised : root.theme.action
            border { color: root.theme.action; width: 3 * root.theme.stroke }
            PlainText {
                anchors { fill: parent; margins: 2 * root.theme.unit }
                text: root.answers[button.index] ?? ""
                color: button.down ? root.theme.action : root.theme.actionText
                font { pixelSize: root.letters; weight: Font.DemiBold }
                wrapMode: Text.Wrap
                horizontalAlignment: Text.AlignHCenter
                verticalAlignment: Text.AlignVCenter
            }
        }
    }
}
