import QtQuick
import Turnpoint

// Draws a typical trial as a timeline: the pause before it, its intervals, and below them the time in which an
// answer counts.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property DesignController design
    readonly property var parts: design.timeline
    readonly property real end: parts.reduce((most, part) => Math.max(most, part.to), 0)

    height: parts.length > 0 ? 2 * bar + 3 * theme.textSmall : 0
    readonly property real bar: Math.max(Math.round(2.4 * theme.unit), 1.8 * theme.textSmall)
    LayoutMirroring.enabled: false
    LayoutMirroring.childrenInherit: true

    Repeater {
        model: root.parts
        Rectangle {
            id: part
            required property var modelData
            readonly property bool answer: modelData.kind === "answer"
            readonly property bool filled: answer || modelData.kind === "interval"
            x: modelData.from / root.end * root.width
            y: answer ? root.bar + Math.round(0.3 * root.theme.unit) : 0
            width: (modelData.to - modelData.from) / root.end * root.width
            height: root.bar
            radius: 0.5 * root.theme.radius
            color: modelData.kind === "interval" ? root.theme.action : answer ? root.theme.right : "transparent"
            border { color: root.theme.line; width: filled ? 0 : 1 }
            PlainText {
                anchors.fill: parent
                text: (part.answer ? root.design.label(["choices"], root.texts.language) + " " : "") + Number((part.modelData.to - part.modelData.from).toFixed(2)) + " s"
                color: part.filled ? root.theme.actionText : root.theme.ink
                font { pixelSize: root.theme.textSmall; weight: Font.DemiBold }
                horizontalAlignment: Text.AlignHCenter
                verticalAlignment: Text.AlignVCenter
                fontSizeMode: Text.HorizontalFit
                minimumPixelSize: 7
            }
        }
    }
    PlainText {
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom; bottomMargin: 0.6 * root.theme.textSmall }
        text: "0 … " + Number(root.end.toFixed(2)) + " s"
        color: root.theme.quiet
        font.pixelSize: root.theme.textSmall
        horizontalAlignment: Text.AlignRight
    }
}
