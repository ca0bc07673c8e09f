import QtQuick
import Turnpoint

// A question of a questionnaire, or the form of a consent: a text, which scrolls if it is long, and below it
// answers of equal size. A touch on an answer leads to the next question; Back is in the header.
Item {
    id: root
    required property Theme theme
    required property Texts texts
    required property SessionBridge bridge
    property bool armed: true
    readonly property PageModel page: bridge.page

    Flickable {
        id: scroll
        objectName: "questionText"
        anchors {
            left: parent.left; right: parent.right; top: parent.top
            bottom: answers.top; bottomMargin: root.theme.unit + (words.wordy && words.implicitHeight > room ? room % line : 0)
        }
        // a text that scrolls shows whole lines
        readonly property real room: answers.y - root.theme.unit
        readonly property real line: words.implicitHeight / Math.max(1, words.lineCount)
        contentHeight: Math.max(height, words.implicitHeight)
        clip: true
        boundsBehavior: Flickable.StopAtBounds
        // scroll to the top of each new question
        readonly property string text: root.page.text
        onTextChanged: contentY = 0
        PlainText {
            id: words
            width: scroll.width - 2 * root.theme.unit
            x: root.theme.unit
            height: scroll.contentHeight
            text: root.texts.phrased(root.page.text)
            color: root.theme.ink
            font { pixelSize: (wordy ? 1 : 1.15) * root.theme.textBody; weight: wordy ? Font.Normal : Font.Medium }
            readonly property bool wordy: root.page.text.length > 240
            lineHeight: wordy ? 1.15 : 1
            wrapMode: Text.Wrap
            horizontalAlignment: wordy ? Text.AlignLeft : Text.AlignHCenter
            verticalAlignment: wordy ? Text.AlignTop : Text.AlignVCenter
        }
    }
    ScrollCue { theme: root.theme; place: scroll }
    AnswerRow {
        id: answers
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        // A long text, such as the form of a consent, needs the room more than its answers, which nobody gives in a hurry.
        best: words.wordy && words.implicitHeight > 0.6 * root.height ? root.theme.targetLeast : root.theme.targetMin
        height: best < root.theme.targetMin ? leastHeight : Math.max(leastHeight, Math.min(Math.round(0.3 * parent.height), rows * 18 * root.theme.unit))
        most: Math.round(0.75 * parent.height)
        theme: root.theme
        answers: root.page.answers
        captions: root.page.captions
        pressed: field.pressed
    }
    TouchField {
        id: field
        objectName: "questionField"
        anchors { left: parent.left; right: parent.right; bottom: parent.bottom }
        height: answers.height
        bridge: root.bridge
        row: answers.buttons
        count: root.page.answers.length
        columns: answers.columns
        gap: answers.gap
        pixelsPerMm: root.theme.pixelsPerMm
        open: root.visible && root.armed && root.page.answersOpen
    }
}
