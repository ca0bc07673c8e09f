import QtQuick
import Turnpoint

// Feedback after an answer: "right", "not right", the message after a late answer or, if no answer is right,
// that the answer was noted. It shows one symbol and one word, and what the answer was worth if answers have points.
Column {
    id: root
    required property Theme theme
    required property Texts texts
    required property int verdict
    required property string message

    readonly property bool good: verdict === PageModel.Right
    readonly property bool bad: verdict === PageModel.Wrong
    readonly property bool plain: !good && !bad && message === ""
    readonly property color tint: good ? theme.right : bad ? theme.wrong : theme.ink

    spacing: 2 * theme.unit

    Rectangle {
        anchors.horizontalCenter: parent.horizontalCenter
        width: 15 * root.theme.unit
        height: width
        radius: root.bad ? Math.round(2.5 * root.theme.unit) : width / 2
        color: root.good || root.bad ? root.tint : "transparent"
        border { color: root.tint; width: root.theme.stroke }
        Glyph {
            anchors.centerIn: parent
            height: 0.6 * parent.height
            name: root.good ? "tick" : root.bad ? "cross" : root.plain ? "dots" : "clock"
            color: root.good || root.bad ? root.theme.actionText : root.tint
        }
    }
    PlainText {
        width: parent.width
        text: root.message !== "" ? root.message : root.good ? root.texts.right : root.bad ? root.texts.wrong
            : root.texts.noted
        color: root.tint
        font { pixelSize: root.theme.textTitle; weight: Font.DemiBold }
        horizontalAlignment: Text.AlignHCenter
        wrapMode: Text.Wrap
    }
}
