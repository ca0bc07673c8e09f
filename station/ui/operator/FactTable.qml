import QtQuick
import Turnpoint

// A table of labels and values under a heading, and remarks below it, for the operator's pages. All but the heading are
// phrases (see Texts.say). In a language that is read from right to left, English values are at the right as well, so
// that both columns have a straight edge.
Column {
    id: root
    required property Theme theme
    required property Texts texts
    required property var facts
    property var remarks: []
    property string heading
    /// Share of the width that the labels have, or more if a word needs it.
    property real labelShare: 0.4
    readonly property real labelWidth: {
        let widest = 0
        for (const fact of facts)
            for (const word of texts.say(fact.label).split(/[\s\u00ad]+/)) widest = Math.max(widest, metrics.advanceWidth(word))
        return Math.max(labelShare * width, Math.min(0.6 * width, widest + Math.round(1.2 * theme.unit)))
    }
    spacing: Math.round(0.35 * theme.unit)

    FontMetrics { id: metrics; font.pixelSize: root.theme.textSmall }
    PlainText {
        visible: root.heading !== "" && root.facts.length + root.remarks.length > 0
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
    Repeater {
        model: root.remarks
        PlainText {
            required property var modelData
            width: root.width
            text: "• " + root.texts.say(modelData)
            color: root.theme.ink
            font.pixelSize: root.theme.textSmall
            wrapMode: Text.Wrap
        }
    }
}
