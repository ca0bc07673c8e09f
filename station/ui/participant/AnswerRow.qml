import QtQuick
import Turnpoint

// Up to nine answers of equal size, letter size and colour, so that nothing favours one of them. They stand in
// one row or, if they would become smaller than a finger needs, in several. This item only draws; a TouchField
// over the page judges the touches.
Item {
    id: root
    required property Theme theme
    required property var answers
    /// Smaller texts below the answers. The list may be shorter than `answers`.
    property var captions: []
    required property int pressed
    /// Gap between the buttons. The points of a scale may be closer together than other answers, so that more
    /// of them fit into one row.
    readonly property real gap: !captioned ? theme.targetGap
        : Math.max(2, Math.min(theme.unit, (width - columns * theme.targetMin) / Math.max(1, columns - 1)))
    readonly property int count: answers.length
    readonly property int fitting: Math.max(1, captioned ? Math.floor((width + 2) / (theme.targetMin + 2)) : Math.floor((width + gap) / (theme.targetMin + gap)))
    readonly property int rows: Math.max(1, Math.ceil(count / fitting))
    readonly property int columns: Math.max(1, Math.ceil(count / rows))
    readonly property real buttonWidth: (width - (columns - 1) * gap) / columns
    readonly property real buttonHeight: (height - (rows - 1) * gap) / rows
    /// The smallest height at which each answer is still as high as a finger needs.
    readonly property real leastHeight: rows * (theme.targetMin + gap) - gap
    readonly property bool captioned: captions.some(caption => caption !== "")
    readonly property real labelHeight: (captioned ? 0.5 : 1) * (buttonHeight - 2 * theme.unit)
    /// The largest text size at which each answer fits its button without breaking a word.
    readonly property real letters: {
        let least = theme.textTitle
        for (let i = 0; i < count; ++i) least = Math.min(least, fits.itemAt(i)?.fontInfo.pixelSize ?? least)
        return least
    }

    Repeater {
        id: fits
        model: 9
        PlainText {
            required property int index
            visible: false
            width: root.buttonWidth - (root.columns > 3 ? 1.2 : 4) * root.theme.unit
            height: root.labelHeight - (root.captioned ? 0 : 2) * root.theme.unit
            text: root.answers[index] ?? ""
            font { pixelSize: root.theme.textTitle; weight: Font.DemiBold }
            fontSizeMode: Text.Fit
            minimumPixelSize: root.theme.textLeast
            wrapMode: Text.WordWrap
        }
    }

    Repeater {
        // Create as many buttons as any trial can need once, so that no trial has to create one.
        model: 9
        Rectangle {
            id: button
            required property int index
            readonly property bool down: root.pressed === index
            objectName: "answer" + index
            Accessible.role: Accessible.Button
            Accessible.name: (root.answers[index] ?? "") + ((root.captions[index] ?? "") === "" ? "" : ", " + root.captions[index])
            visible: index < root.count
            width: root.buttonWidth
            height: root.buttonHeight
            x: index % root.columns * (width + root.gap)
            y: Math.floor(index / root.columns) * (height + root.gap)
            radius: root.theme.radius
            color: down ? root.theme.raised : root.theme.action
            border { color: root.theme.action; width: 3 * root.theme.stroke }
            PlainText {
                readAloud: false
                anchors { left: parent.left; right: parent.right; top: parent.top; margins: root.theme.unit * (root.columns > 3 ? 0.6 : 1) }
                height: root.labelHeight
                text: root.answers[button.index] ?? ""
                color: button.down ? root.theme.action : root.theme.actionText
                font { pixelSize: root.letters; weight: Font.DemiBold }
                wrapMode: Text.Wrap
                horizontalAlignment: Text.AlignHCenter
                verticalAlignment: Text.AlignVCenter
            }
            PlainText {
                readAloud: false
                visible: root.captioned
                anchors { left: parent.left; right: parent.right; bottom: parent.bottom; margins: 0.6 * root.theme.unit }
                height: root.labelHeight
                text: root.captions[button.index] ?? ""
                color: button.down ? root.theme.action : root.theme.actionText
                font { pixelSize: root.theme.textBody; weight: Font.Medium }
                fontSizeMode: Text.Fit
                minimumPixelSize: root.theme.textLeast
                wrapMode: Text.WordWrap
                horizontalAlignment: Text.AlignHCenter
                verticalAlignment: Text.AlignVCenter
            }
        }
    }
}
